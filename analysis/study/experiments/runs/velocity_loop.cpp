#include "limcycle/analysis/study/experiments/runs/velocity_loop.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {

LoopShape loop_shape(const VelocityRun& run, double mean, double amplitude) {
  LoopShape shape;
  for (const double F : run.F)
    if (std::isfinite(F)) shape.peak = std::max(shape.peak, std::abs(F));
  constexpr int points = 200;
  constexpr double told_apart = 2e-4;  // error of the interpolation between samples
  int side = 0;
  for (int k = 1; k < points; ++k) {
    const double v = mean + amplitude * std::cos(3.14159265358979 * k / points);
    const double gap = run.force_at(v, true) - run.force_at(v, false);
    if (!std::isfinite(gap)) continue;
    shape.width = std::max(shape.width, std::abs(gap));
    const int now = std::abs(gap) < told_apart * shape.peak ? 0 : gap > 0.0 ? 1 : -1;
    if (now != 0 && side != 0 && now != side) ++shape.crossings;
    if (now != 0) side = now;
  }
  return shape;
}

double turning_distance(const VelocityRun& run) {
  // The run begins at a reversal.
  const std::size_t middle = run.v.size() / 4;
  if (run.F.empty() || run.F.front() * run.v[middle] > 0.0) return 0.0;
  for (std::size_t i = 1; i < run.F.size(); ++i) {
    const double a = run.F[i - 1], b = run.F[i];
    if (!std::isfinite(a) || !std::isfinite(b) || a * b > 0.0) continue;
    const double share = a == b ? 0.0 : a / (a - b);
    return std::abs(run.x[i - 1] + share * (run.x[i] - run.x[i - 1]) - run.x.front());
  }
  return NAN;
}

double largest_jump(const VelocityRun& run) {
  double largest = 0.0;
  for (std::size_t i = 1; i < run.F.size(); ++i) {
    const double step = std::abs(run.F[i] - run.F[i - 1]);
    if (std::isfinite(step)) largest = std::max(largest, step);
  }
  return largest;
}

}  // namespace limcycle
