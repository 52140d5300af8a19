#include "limcycle/questions/asking/need_memory.hpp"

#include "limcycle/cases/loader/text/input_error.hpp"
#include "limcycle/reports/memory.hpp"

namespace limcycle {

void need_memory(const std::string& key, double things, double bytes, const std::string& remedy) {
  if (const std::string lack = lack_of_memory(things * bytes); !lack.empty())
    throw InputError(
        {.file = {}, .line = 0, .override = {}, .key = key, .value = {}, .rule = lack, .suggestion = remedy});
}

}  // namespace limcycle
