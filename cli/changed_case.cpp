#include "limcycle/cli/changed_case.hpp"

#include "limcycle/cases/loader/with_overrides.hpp"
#include "limcycle/questions/asking/answer_of.hpp"

namespace limcycle {

std::string changed_case(const Case& from, const std::vector<std::string>& overrides, const std::string& remark,
                         const std::string& who, const std::string& what) {
  auto text = text_with_overrides(from, overrides, remark);
  if (text) return *std::move(text);
  std::string flags;
  for (const auto& one : overrides) flags += " --set '" + one + "'";
  throw NoAnswer(who + "this file cannot be changed in its place; " + what + flags);
}

std::string not_written(const std::string& file) {
  return file + " is not written: the search was stopped before it was complete";
}

}  // namespace limcycle
