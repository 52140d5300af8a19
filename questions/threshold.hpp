#pragma once
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/sensitivity/local_sensitivity.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"

namespace limcycle {

/// The numbers that a user may vary: written or with a default, finite.
std::vector<CaseNumber> own_numbers(const Case& from);
/// The same as numbers of its loop.
std::vector<LoopNumber> loop_numbers(const Case& from);

/// The numbers at these paths. Throws InputError (of `argument`, such as "--threshold") if one does not exist or is
/// zero.
std::vector<CaseNumber> threshold_numbers(const Case& from, const std::string& argument,
                                          const std::vector<std::string>& paths);
/// Value of one number at which hunting begins or ends, on the nearer side, and its derivatives by the others.
ThresholdSensitivity threshold_of(const Case& from, const Loop& loop, const CaseNumber& number,
                                  const std::function<bool()>& stop);

}  // namespace limcycle
