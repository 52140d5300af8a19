#include "limcycle/analysis/study/tune/judged_points.hpp"

#include <algorithm>
#include <utility>

namespace limcycle {

void JudgedPoints::add(const TunePoint& point) {
  if (point.outcome != TuneOutcome::not_judged)
    points_.push_back({space_.place(point.values), point.outcome == TuneOutcome::feasible, point.hunting});
}

bool JudgedPoints::suggest_feasible(std::span<const double> values) const {
  const auto place = space_.place(values);
  const auto away = [&](const Judged& one) { return distance_between(one.place, place); };
  return points_.empty() || std::ranges::min_element(points_, {}, away)->feasible;
}

bool JudgedPoints::refuted_within(double distance, std::span<const double> values) const {
  const auto place = space_.place(values);
  return std::ranges::any_of(
      points_, [&](const Judged& one) { return !one.feasible && distance_between(one.place, place) < distance; });
}

std::vector<MotionState> JudgedPoints::hunting_near(std::span<const double> values) const {
  constexpr std::size_t most = 3;
  const auto place = space_.place(values);
  std::vector<std::pair<double, const MotionState*>> near;
  for (const Judged& one : points_)
    if (one.hunting) near.emplace_back(distance_between(one.place, place), &*one.hunting);
  std::ranges::stable_sort(near, {}, &std::pair<double, const MotionState*>::first);
  std::vector<MotionState> motions;
  for (std::size_t i = 0; i < std::min(most, near.size()); ++i) motions.push_back(*near[i].second);
  return motions;
}

}  // namespace limcycle
