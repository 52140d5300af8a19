#pragma once
#include <functional>
#include <optional>

#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/analysis/study/identify/profile.hpp"

namespace limcycle {

/// Gives the law its numbers with 95 % intervals, by profile likelihood or (all, or those that a stop leaves) linear
/// ones, and notes on profiles that did not converge. `better`: see profile_interval().
void add_numbers(const FitWithSlopes& at, bool profiled, IdentifiedLaw& into, std::optional<Fit>& better,
                 const std::function<bool()>& stop);

/// Correlations, and the directions along which the standard deviation exceeds a factor of e (or a typical size).
void add_directions(const FitWithSlopes& at, IdentifiedLaw& into);

}  // namespace limcycle
