#include "limcycle/analysis/study/identify/intervals.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {

void add_numbers(const FitWithSlopes& at, bool profiled, IdentifiedLaw& into, std::optional<Fit>& better,
                 const std::function<bool()>& stop) {
  const ParameterSpace& space = at.misfit.space();
  const Eigen::VectorXd values = space.values(at.fit.u);
  into.numbers.clear();
  std::string unknown;
  for (std::size_t k = 0; k < space.numbers().size(); ++k) {
    NumberInterval interval;
    if (profiled && !(stop && stop())) interval = profile_interval(at, k, better, stop);
    if (!profiled || (stop && stop())) interval = linear_interval(at, k);
    if (!interval.complete) unknown += (unknown.empty() ? "" : ", ") + space.numbers()[k].name;
    into.numbers.push_back({space.numbers()[k].name, space.numbers()[k].unit, values(static_cast<Eigen::Index>(k)),
                            interval.low, interval.high, interval.linear_low, interval.linear_high,
                            interval.identifiable, space.numbers()[k].low, space.numbers()[k].high});
  }
  if (!unknown.empty())
    into.notes.push_back("no fit converged where an interval should end, so that this end is unknown: " + unknown);
  if (profiled && stop && stop())
    into.notes.emplace_back("its last intervals are linear ones, since the work was stopped");
}

void add_directions(const FitWithSlopes& at, IdentifiedLaw& into) {
  const ParameterSpace& space = at.misfit.space();
  const LinearCovariance& linear = at.linear;
  const Eigen::Index n = space.size();
  into.correlated.clear();
  into.undetermined.clear();
  into.correlations.setConstant(n, n, NAN);
  for (Eigen::Index i = 0; i < n; ++i) {
    into.correlated.push_back(space.numbers()[space.number_of(i)].name);
    for (Eigen::Index k = 0; k < n; ++k)
      if (std::isfinite(linear.deviation(i)) && std::isfinite(linear.deviation(k)))
        into.correlations(i, k) = linear.covariance(i, k) / (linear.deviation(i) * linear.deviation(k));
  }
  for (Eigen::Index j = 0; j < linear.singular_values.size(); ++j) {
    const double value = linear.singular_values(j);
    if (value > 1.0) continue;
    Undetermined one;
    one.deviation = value > 1e-8 * linear.singular_values(0) ? 1.0 / value : infinite;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (std::abs(linear.directions(k, j)) <= 0.2) continue;
      one.direction.emplace_back(into.correlated[static_cast<std::size_t>(k)], linear.directions(k, j));
      one.powers = one.powers && space.numbers()[space.number_of(k)].coordinate == Coordinate::log;
    }
    if (!one.direction.empty() && one.direction.front().second < 0.0)
      for (auto& part : one.direction) part.second = -part.second;
    into.undetermined.push_back(std::move(one));
  }
}

}  // namespace limcycle
