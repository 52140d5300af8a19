#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "limcycle/analysis/study/remedy/remedy.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// What is wanted of remedies.
struct RemedyWishes {
  std::vector<std::string> only;  ///< names; empty: all
  CostWeights weights{};          ///< as of RemedyOptions
  std::size_t samples = 32;       ///< of the case's [sensitivity], for the robust share
};

/// The remedies of these names, or all. Throws InputError (of `argument`) for an unknown name.
std::vector<RemedyCandidate> chosen_remedies(const Case& from, const std::string& argument,
                                             const std::vector<std::string>& names);

/// The index in cost_names of a cost. Throws InputError (of `argument`) for an unknown name.
std::size_t cost_named(const std::string& argument, const std::string& name);

/// What gives the case this remedy: "PATH=VALUE", as for `--set`. Throws NoAnswer if it was not tried, or does not end
/// the hunting.
std::vector<std::string> overrides_of_remedy(const RemedyReport& report, const std::string& name);

/// Why the loop hunts, and what ends it. Throws InputError without a loop, std::invalid_argument if the numbers are
/// valid but too extreme for a method.
RemedyReport ask_remedy(const Case& from, const RemedyWishes& wishes, const Asking& asking);

}  // namespace limcycle
