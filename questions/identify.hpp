#pragma once
#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// The laws of [identify], fitted to its records. Throws InputError if the case has no such section, or a file
/// or a record cannot be used.
/// With `plan` also what one more record would tell.
IdentifyReport ask_identify(const Case& from, bool plan, const Asking& asking);

/// Text of the case with the fitted law, checked as it would be read from `file`. Throws NoAnswer if no law was chosen,
/// or its numbers make no valid case there.
std::string fitted_text(const Case& from, const IdentifyReport& report, const std::string& file);

}  // namespace limcycle
