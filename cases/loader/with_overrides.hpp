#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// The text of a case file with its overrides, and `more` of them ("PATH=VALUE"), written into it: a value that is
/// written is replaced in its place, a new key goes under the heading of its table, a new table to the end. Everything
/// else, comments included, stays. Each changed line ends in `remark`, as a comment. Empty if the text cannot be
/// changed like that (a value over several lines); the result has been read back, and its loop has the same numbers as
/// the case with these overrides.
std::optional<std::string> text_with_overrides(const Case& from, const std::vector<std::string>& more,
                                               const std::string& remark);

}  // namespace limcycle
