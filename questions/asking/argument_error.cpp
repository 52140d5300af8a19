#include "limcycle/questions/asking/argument_error.hpp"

#include <algorithm>

namespace limcycle {

InputError argument_error(const std::string& argument, const std::string& value, const std::string& rule,
                          const std::string& suggestion) {
  return InputError(
      {.file = {}, .line = 0, .override = {}, .key = argument, .value = value, .rule = rule, .suggestion = suggestion});
}

std::size_t position_named(const std::string& argument, const std::string& name, const std::vector<std::string>& known,
                           const std::string& rule) {
  const auto found = std::ranges::find(known, name);
  if (found == known.end()) throw argument_error(argument, name, rule, suggest(name, known));
  return static_cast<std::size_t>(found - known.begin());
}

}  // namespace limcycle
