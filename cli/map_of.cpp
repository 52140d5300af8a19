#include "limcycle/cli/map_of.hpp"

#include "limcycle/cli/parameter_range.hpp"
#include "limcycle/questions/map.hpp"

namespace limcycle {

MapReport map_of(const Case& from, const std::string& x, const std::string& y, const Methods& methods) {
  return map_over(from, map_axis("--x", x), map_axis("--y", y), methods, "--");
}

}  // namespace limcycle
