#pragma once
#include <map>
#include <optional>

#include "limcycle/analysis/orbit/settle/watch/stillness_watch.hpp"

namespace limcycle {

/// Watches an ideal relay (no hysteresis) whose output acts on its input only through the second derivative: no sliding
/// mode of order one exists, and the motion reaches the switching surface through ever faster switching.
///
/// With x the relay's input, x = 0 the surface and w the output, in fixed modes of all other elements
///   x'' = p x + q x' + (the other states) + b w,   b = C A B < 0,  q = C A^2 B/(C A B).
/// A swing to one side of the surface that begins with x' = v under the deceleration D returns with v + 2 q v^2/(3 D)
/// after 2 v/D, so that swings grow or decay as exp(q t/3) while they become shorter in proportion: for q < 0 there are
/// infinitely many before the rest at their end. Meanwhile the other states follow the sliding mode of order two: the
/// mean output w holds x = x' = 0. Once the swings are short against every time constant, the motion has come to rest
/// if q < 0 and that sliding mode settles with its w within the relay's jump all along (see linear_motion), at a state
/// that solves A X + B w + E ext = 0. Compare Johansson, Rantzer and Astrom, Fast switches in relay feedback systems,
/// Automatica 35 (1999).
class SwitchingWatch {
 public:
  /// The loop must outlive the watch. For piecewise affine loops only; has no effect for others.
  SwitchingWatch(const Loop& loop, LoopSizes scale);

  /// A step that ended at x with a switch of element i; the field is in the modes after it.
  std::optional<Stillness> switched(const LoopField& field, const State& x, double t, std::size_t i);

 private:
  struct Swings {
    double last = -infinite;                                       ///< time of the last switch, s
    double lengths[4] = {infinite, infinite, infinite, infinite};  ///< of the last swings, s
    double tried = infinite;                                       ///< longest of those at the last try
  };

  const Loop& loop_;
  LoopSizes scale_;
  bool applies_ = false;
  double fastest_ = 0.0;  ///< pole of the linear part, 1/s
  std::map<std::size_t, Swings> swings_;
};

}  // namespace limcycle
