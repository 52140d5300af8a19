#pragma once
#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"

namespace limcycle {

/// Shape of a loop of force over velocity.
struct LoopShape {
  double width = 0.0;  ///< largest |F accelerating - F decelerating| at one velocity, N
  double peak = 0.0;   ///< largest |F|, N
  int crossings = 0;   ///< number of crossings of the two branches between the ends of the loop
};
LoopShape loop_shape(const VelocityRun& run, double mean, double amplitude);

/// Displacement from the first reversal of the velocity until the force changes sign, m; 0 if it jumps.
double turning_distance(const VelocityRun& run);

/// Largest change of the force between neighbouring samples, N.
double largest_jump(const VelocityRun& run);

/// Loops of a velocity that alternates about zero, at the pendulum paper's frequencies: quantities lag, width, peak,
/// crossings.
LawPart alternating_loops(const LawSetting& setting);

}  // namespace limcycle
