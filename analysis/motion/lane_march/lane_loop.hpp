#pragma once
#include <optional>
#include <tuple>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/analysis/motion/lane_march/lane_march.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Properties that loops must share to be marched side by side.
struct LaneShape {
  enum class Law { usual_lugre, lugre, dahl };
  Law law = Law::lugre;
  int states = 0;  ///< linear ones
  int curve = 0;
  double delta = 2.0;
  bool fading = false;  ///< damping that depends on the speed

  friend bool operator<(const LaneShape& a, const LaneShape& b) {
    return std::tie(a.law, a.states, a.curve, a.delta, a.fading) <
           std::tie(b.law, b.states, b.curve, b.delta, b.fading);
  }
};

/// The shape of a loop that can be marched in lanes; empty for all others.
std::optional<LaneShape> lane_shape(const Loop& loop);

/// The kernel for it.
LaneKernel kernel_for(const LaneKernels& kernels, const LaneShape& shape);

/// Unit of the law's velocity and state in lanes: vs, or 1 if the law has none.
double lane_unit(const Loop& loop);

/// Writes the numbers of a loop and its start into one lane; `rows` begins at that lane.
void write_lane(const Loop& loop, const ErrorWeights& weights, const State& start, double* rows, int lanes);

/// State of the loop in a lane, or its rates (`row` being LaneRows::state() or rate()).
void read_lane(const Loop& loop, const double* rows, int lanes, int row, State& out);

}  // namespace limcycle
