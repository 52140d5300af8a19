#pragma once
#include "limcycle/analysis/study/continuation/follow.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// The limit cycles over one number from `low` to `high`, which may be the larger one. `number`: as of number_at().
FollowReport ask_continue(const Case& from, const CaseNumber& number, double low, double high, const Asking& asking);

}  // namespace limcycle
