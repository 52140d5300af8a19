#include "limcycle/cli/need_memory.hpp"

#include "limcycle/cli/command.hpp"
#include "limcycle/reports/memory.hpp"

namespace limcycle {

void need_memory(const std::string& key, double things, double bytes, const std::string& remedy) {
  if (const std::string lack = lack_of_memory(things * bytes); !lack.empty()) throw refusal(key, lack, remedy);
}

}  // namespace limcycle
