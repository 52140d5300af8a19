#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/remedy/remedy.hpp"
#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// Every remedy against hunting that literature and practice know, as a variation of this case: those that a case file
/// can hold vary one number, the others have a reason why they do not apply. Each keeps its own copy of the case.
/// Throws InputError without a loop.
std::vector<RemedyCandidate> remedy_candidates(const Case& from);

/// What gives a case this remedy: "PATH=VALUE", as for `--set`.
std::vector<std::string> remedy_overrides(const RemedyCandidate& candidate, double value);

/// Samples of the case's [sensitivity], random but the same for one seed, each with the remedy; a parameter that is the
/// remedy's own number is not varied. Empty without that section.
SampledParts sampled_parts(const Case& from, std::uint64_t seed);

}  // namespace limcycle
