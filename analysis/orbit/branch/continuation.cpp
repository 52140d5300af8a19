#include "limcycle/analysis/orbit/branch/continuation.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "limcycle/analysis/orbit/branch/branch_step.hpp"
#include "limcycle/analysis/orbit/branch/branch_walk.hpp"

namespace limcycle {
namespace {

/// The two walks as one branch, from the end of the first to the end of the second.
Branch joined(Branch down, Branch up) {
  Branch whole;
  const std::size_t n = down.points.size();
  whole.points.assign(std::make_move_iterator(down.points.rbegin()), std::make_move_iterator(down.points.rend()));
  std::ranges::reverse(down.events);
  for (auto& event : down.events) {
    event.point = n - 1 - event.point;
    whole.events.push_back(std::move(event));
  }
  // The start is in both.
  const std::size_t shift = n > 0 && !up.points.empty() ? n - 1 : n;
  for (std::size_t i = n > 0 ? 1 : 0; i < up.points.size(); ++i) whole.points.push_back(std::move(up.points[i]));
  for (auto& event : up.events) {
    event.point += shift;
    whole.events.push_back(std::move(event));
  }
  for (const Status status : {down.status, up.status})
    if (status != Status::converged && whole.status != Status::interrupted) whole.status = status;
  return whole;
}

}  // namespace

std::string_view to_string(BranchEvent::Type type) {
  switch (type) {
    case BranchEvent::Type::fold:
      return "fold";
    case BranchEvent::Type::stability:
      return "stability";
    default:
      return "end";
  }
}

Branch continue_cycle(const LoopFamily& family, const Cycle& start, double p0, const ContinuationOptions& options) {
  const ParameterScale scale(options.from, options.to);
  const double s0 = scale.s(p0);
  if (!(s0 >= 0.0 && s0 <= ParameterScale::length))
    throw std::invalid_argument("the start of a branch must lie in its range, got " + std::to_string(p0));
  // Tightened if the estimated errors require it; loose runs lose a cycle with stick.
  const double rtol = std::clamp(options.accuracy, 3e-13, 1e-7);
  BranchMap map(family, scale, rtol, options.stop);
  BranchSolver solver(map, options.accuracy);
  const auto first = solver.begin(start, s0);
  Branch whole;
  if (!first) {
    whole.status = map.stopped()                           ? Status::interrupted
                   : solver.failure() == Status::converged ? Status::stalled
                                                           : solver.failure();
    whole.why = "the start is not on a cycle of the loop that its return map can follow";
    return whole;
  }
  const BranchMap::Frame frame = map.frame();
  Branch parts[2];
  bool closed = false;
  for (const int upwards : {1, 0}) {
    if ((upwards ? !options.upwards : !options.downwards) || closed) continue;
    map.set_frame(frame);
    parts[upwards] = walk_branch(map, solver, options, *first, upwards ? 1.0 : -1.0, closed);
  }
  whole = joined(std::move(parts[0]), std::move(parts[1]));
  whole.maps = map.maps();
  return whole;
}

}  // namespace limcycle
