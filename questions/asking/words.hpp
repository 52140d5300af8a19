#pragma once
#include <string>

#include "limcycle/analysis/status.hpp"
#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// What ended work early: "time limit of 3 s reached", or "interrupted" if `time_limit` (s) is 0.
std::string cause_in_words(double time_limit);

/// First line of the text of a result that `cause` ended early, and an empty one; empty for any other status.
std::string first_line(Status status, std::string cause);

/// Last lines of the text of a result: the data and fits on which a case with measured plants rests.
std::string basis_lines(const Case& from);

}  // namespace limcycle
