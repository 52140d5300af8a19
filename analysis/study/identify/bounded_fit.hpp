#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/study/identify/fit.hpp"

namespace limcycle {

/// Least squares within the bounds of the space, from `from.u` on the bounds `from.held`, by active sets: a fit that
/// leaves the bounds is made again on those that it broke, and a bound whose multiplier points inwards is released as
/// long as that lowers the sum. First over `active`, then over what the entries depend on; `fixed`, if not negative,
/// keeps its value. Status: that of fit(), or stalled if the bounds do not settle; not_finite if `fixed` leaves no law.
Fit fit_within(const Misfit& misfit, const Fit& from, const std::vector<Eigen::Index>& active, int most_iterations,
               const std::function<bool()>& stop, Eigen::Index fixed = -1);

/// Coordinates that the bounds in `held` leave free: those of `active` (without `fixed`), tied ones in one group. Puts
/// u on these bounds.
Groups groups_on(const ParameterSpace& space, const std::vector<std::size_t>& held,
                 const std::vector<Eigen::Index>& active, Eigen::VectorXd& u, Eigen::Index fixed = -1);

/// The point with the bounds that it breaks, and those in `held`, put on.
Eigen::VectorXd put_within(const ParameterSpace& space, Eigen::VectorXd u, std::vector<std::size_t> held = {});

/// The coordinates that change an entry of the records in use, at u; the others would wander in a fit. All if the law
/// has no answer there.
std::vector<Eigen::Index> felt_coordinates(const Misfit& misfit, const Eigen::VectorXd& u);

}  // namespace limcycle
