/// @file
/// State between the two ends of a step.
#pragma once

#include <array>
#include <cstddef>

#include "limcycle/analysis/motion/state.hpp"

namespace limcycle {

/// The interpolant of one step, of order 4, as a copy, so that a later try or repeat of the step does not change it.
/// Cost of a component: 5 multiplications. It reproduces both ends of the step exactly.
///
/// Between them it is less accurate than they are for stiff components (measured 1e-7 at tolerance 1e-8 on a forced
/// problem with lambda = -1e6, whose ends are accurate to 5e-9): to land on an event, find it here and repeat the step
/// to it.
class DenseSegment {
 public:
  /// Start and end of the step (end < start if time ran backwards).
  double start() const { return start_; }
  double end() const { return end_; }

  /// State at time t, for t in the step (up to rounding). Throws std::invalid_argument outside it, where an interpolant
  /// is worthless.
  void at(double t, State& x) const;
  /// The same for one component; component < size of the state.
  double at(double t, std::size_t component) const;

 private:
  friend class Rodas5p;

  double fraction(double t) const;
  double value(double theta, std::size_t i) const {
    const double bend = bend_[0][i] + theta * (bend_[1][i] + theta * bend_[2][i]);
    return (1 - theta) * first_[i] + theta * (last_[i] + (1 - theta) * bend);
  }

  double start_ = 0;
  double end_ = 0;
  State first_;
  State last_;
  std::array<State, 3> bend_;
};

}  // namespace limcycle
