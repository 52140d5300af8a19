#include "limcycle/analysis/study/experiments/runs/breakaway.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

/// Value at the share `s` of the interval between samples i-1 and i.
double between(const std::vector<double>& values, std::size_t i, double s) {
  return values[i - 1] + s * (values[i] - values[i - 1]);
}

/// First sample at or after `from` where F is at most `level`, and the share of the interval from the sample before.
struct Crossing {
  std::size_t index;
  double share;
};
Crossing falls_to(const ForcedRun& run, std::size_t from, double level) {
  std::size_t i = from;
  while (i < run.F.size() && run.F[i] > level) ++i;
  if (i >= run.F.size() || i == 0) return {run.F.size(), 0.0};
  const double drop = run.F[i - 1] - run.F[i];
  return {i, drop > 0.0 ? std::clamp((run.F[i - 1] - level) / drop, 0.0, 1.0) : 0.0};
}

void measure_fall(BreakAway& result, std::size_t peak) {
  const ForcedRun& run = result.run;
  const double last = *std::min_element(run.F.begin() + static_cast<std::ptrdiff_t>(peak), run.F.end());
  const double drop = result.peak - last;
  if (!(drop > 0.02 * result.peak)) return;
  const Crossing high = falls_to(run, peak, last + 0.75 * drop), low = falls_to(run, peak, last + 0.25 * drop);
  if (high.index >= run.F.size() || low.index >= run.F.size()) return;
  const double dx = between(run.x, low.index, low.share) - between(run.x, high.index, high.share);
  result.fall_time = between(run.t, low.index, low.share) - between(run.t, high.index, high.share);
  result.slope = dx > 0.0 ? 0.5 * drop / dx : infinite;
}

}  // namespace

BreakAway break_away(const LawSetting& setting, double rate, double gross, double rtol) {
  Signal ramp;
  ramp.kind = Signal::Kind::ramp;
  ramp.rate = rate;
  ForcedOptions options;
  options.duration = 6.0 / rate;
  options.rtol = rtol;
  options.longest_step = 0.01 / rate;
  options.until_displacement = 5.0 * gross;
  options.stop = setting.stop;
  BreakAway result;
  result.run = run_forced(make_law(setting), ramp, options);
  const ForcedRun& run = result.run;
  if (run.status != Status::converged) return result;
  std::size_t end = 0;
  while (end < run.x.size() && run.x[end] < gross) ++end;
  if (end == 0 || end >= run.x.size()) return result;
  result.applied = rate * run.time_of(gross);
  const Peak peak = peak_of(run.t, run.F, end);
  result.peak = peak.value;
  // A force that only approaches its largest value has no distinct peak: it counts as reached at 99.9 %.
  std::size_t top = peak.index;
  if (run.F[end] > (1.0 - 1e-4) * peak.value)
    for (top = 0; run.F[top] < 0.999 * peak.value;) ++top;
  result.displacement = run.x[top];
  result.velocity = run.v[top];
  const double tenth = 0.1 * peak.value / rate;
  const double x = run.displacement(tenth);
  result.stiffness = x > 1e-14 ? rate * tenth / x : infinite;
  measure_fall(result, peak.index);
  return result;
}

}  // namespace limcycle
