#pragma once
#include <optional>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {

/// Watches a body that stays on its bristles while a sampled controller winds up: it creeps with every sample, so that
/// none of them may be leapt over, and may do so for more samples than can be followed. Seen as such is a friction
/// force that has grown at the same rate, to 1 %, in two windows of 20,000 switches of clocks each.
class WindUpWatch {
 public:
  explicit WindUpWatch(const Loop& loop);

  /// After a switch of a clock: the time at which the force reaches its typical size, at the rate that it has, s; empty
  /// unless the body winds up.
  std::optional<double> read(double t, const LoopField& field);
  /// The element on whose bristles the body stays.
  std::size_t rubs() const { return *rubs_; }

 private:
  static constexpr long window = 20'000;

  std::optional<std::size_t> rubs_;  ///< the element that rubs last
  double size_ = 0.0;                ///< of its force
  long readings_ = 0;
  std::optional<double> before_, slope_;  ///< the force at the end of the last window, and its rate in it
  double since_ = 0.0;
};

}  // namespace limcycle
