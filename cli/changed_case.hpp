#pragma once
#include <string>
#include <vector>

#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// The text of a case file with numbers that a command found; see text_with_overrides(). Where it cannot be changed
/// throws NoAnswer, which says so between `who` and `what`, and has the flags that do the same.
std::string changed_case(const Case& from, const std::vector<std::string>& overrides, const std::string& remark,
                         const std::string& who, const std::string& what);

/// Why there is no such case after an interrupted search, as a sentence.
std::string not_written(const std::string& file);

}  // namespace limcycle
