#include "limcycle/analysis/orbit/cycle/shooting.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/fixed_point.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/two_tolerances.hpp"

namespace limcycle {
namespace {

constexpr double tightest = 1e-13;

ShootingResult failed(Status status, const FixedPoint& point, std::string why) {
  ShootingResult result;
  result.status = status;
  result.maps = point.maps();
  result.steps = point.steps();
  result.why = std::move(why);
  return result;
}

/// Fills the cycle from the solved map; recorded anew if the map has taken fewer steps. False if that fails.
bool describe(const Loop& loop, const FixedPoint& point, double rtol, int resolution, Cycle& cycle) {
  cycle.period = point.period();
  cycle.residual = point.residual_size();
  cycle.half_wave_symmetric = point.reflection().has_value();
  cycle.start = point.state();
  const int parts = cycle.half_wave_symmetric ? 2 : 1;
  cycle.trace = point.trace();
  const double duration = cycle.period / parts;
  if (parts * std::ssize(cycle.trace.t) < resolution) {
    cycle.trace = {};
    if (record(loop, cycle.start, duration, rtol, resolution / parts, cycle.trace) != Status::converged) return false;
  }
  if (cycle.half_wave_symmetric) append_reflected(loop, point.reflection()->centre, cycle.trace);
  measure(loop, cycle);
  cycle.amplitude = point.amplitude();
  return true;
}

/// Multipliers at two tolerances, whose disagreement is their error, and the verdict they allow.
void judge(FixedPoint& point, ShootingResult& result, bool exact, double rtol) {
  Cycle& cycle = result.cycle;
  std::vector<std::complex<double>> rough;
  double trivial = 0.0;
  if (!exact) {
    if (!point.is_linear_at(10.0 * rtol) && point.linearise(10.0 * rtol) != Status::converged) return;
    rough = point.multipliers(trivial);
  }
  if (point.linearise(rtol) != Status::converged) return;
  cycle.multipliers = point.multipliers(result.trivial_error);
  cycle.remembered = point.remembered();
  result.multiplier_error = 1e-12 + result.trivial_error;
  if (!exact && rough.size() != cycle.multipliers.size()) return;  // the two disagree on the kept combinations
  for (std::size_t i = 0; i < rough.size(); ++i)
    result.multiplier_error = std::max(result.multiplier_error, std::abs(rough[i] - cycle.multipliers[i]));
  const double of_map = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers.front());
  cycle.multiplier_error = (point.reflection() ? 2.0 * of_map : 1.0) * result.multiplier_error;
  if (point.reflection())
    for (auto& value : cycle.multipliers) value *= value;
  const double largest = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers.front());
  if (result.trivial_error < 0.1 && std::abs(largest - 1.0) > 4.0 * result.multiplier_error)
    cycle.stable = largest < 1.0;
  else
    result.neutral = point.neutral();
}

/// Solves at rtol and, if an accuracy is wanted, with ever tighter tolerances until the estimate reaches it. On return
/// `rtol` is the last one, and `error` the estimate.
Status refine(FixedPoint& point, const ShootingOptions& options, double& rtol, double& error) {
  double tolerance = options.tolerance;
  while (true) {
    if (const Status status = point.solve(rtol, tolerance); status != Status::converged) return status;
    const double loose = loose_tolerance(rtol, loosest_shooting_rtol);
    double difference = 0.0;
    if (const Status status = point.compare(loose, difference); status != Status::converged) return status;
    error = std::max({stated_share(rtol, loose) * difference, point.residual_size(), rtol});
    if (options.accuracy == 0.0 || error <= options.accuracy || rtol <= tightest) return Status::converged;
    const double by = tightening(options.accuracy, error);
    rtol = std::max(by * rtol, tightest);
    tolerance *= by;
  }
}

/// True if y swings by more than roundings. A body that sticks returns to the section for any length of time.
bool moves(const Loop& loop, const Cycle& cycle) {
  const State typical = typical_sizes(loop);
  double size = 0.0;
  for (Eigen::Index i = 0; i < loop.C_y.size(); ++i)
    size = std::max(size, std::abs(loop.C_y(i)) * typical[static_cast<std::size_t>(i)]);
  for (const double y : cycle.trace.y) size = std::max(size, std::abs(y));
  return cycle.amplitude > 1e-13 * size;
}

}  // namespace

Section choose_section(const Loop& loop, const Trace& trace) {
  const auto [low, high] = extremes(trace);
  Section section{loop.C_y, 0.5 * (low + high) + 0.135 * (high - low), 1};
  double fastest = 0.0;
  for (std::size_t i = 0; i + 1 < trace.y.size(); ++i) {
    if ((trace.y[i] < section.level) == (trace.y[i + 1] < section.level)) continue;
    const double rate = 0.5 * (trace.rate[i] + trace.rate[i + 1]);
    if (std::abs(rate) > std::abs(fastest)) fastest = rate;
  }
  section.direction = fastest < 0.0 ? -1 : 1;
  return section;
}

int returns_of(const Section& section, const Trace& trace) {
  int count = 0;
  for (std::size_t i = 0; i + 1 < trace.y.size(); ++i) {
    const bool before = trace.y[i] < section.level, after = trace.y[i + 1] < section.level;
    if (before != after && before == (section.direction > 0)) ++count;
  }
  return std::max(count, 1);
}

ShootingResult shoot(const Loop& loop, const LoopState& guess, const Section& section, bool half,
                     const ShootingOptions& options) {
  const double coarse = std::clamp(loose_tolerance(options.rtol, loosest_shooting_rtol), 1e-7, loosest_shooting_rtol);
  const bool exact = choose_stepper(loop, options.rtol) == StepperKind::exact;
  std::optional<Reflection> reflection;
  const bool odd = options.returns % 2 != 0;  // an even number of half maps is a map of the whole period
  if (half && odd) reflection = symmetry(loop);
  ReturnMap::Options map{coarse, options.max_steps_per_map, options.stop};
  map.longest = options.longest_map;
  map.returns = options.returns;
  FixedPoint point(loop, {loop, section, reflection, map}, options);
  Status status = point.warm_up(guess);
  if (status != Status::converged) return failed(status, point, "the motion did not return to the section");
  if (!exact && coarse > options.rtol) status = point.solve(coarse, 30.0 * coarse, 3 * options.max_maps / 5);
  if (status != Status::converged) return failed(status, point, "no fixed point of the return map was reached");

  ShootingResult result;
  Cycle& cycle = result.cycle;
  double rtol = options.rtol;
  status = exact ? point.solve(rtol, 1e-13) : refine(point, options, rtol, cycle.error);
  if (exact) cycle.error = std::max(point.residual_size(), 1e-13);
  if (status != Status::converged) return failed(status, point, "the fixed point was lost at the tight tolerance");
  if (exact && !point.repeats_small_states())
    return failed(Status::no_cycle, point, "its smallest states do not repeat themselves");
  if (!describe(loop, point, rtol, options.resolution, cycle))
    return failed(Status::stalled, point, "the cycle could not be followed");
  if (!moves(loop, cycle)) return failed(Status::no_cycle, point, "the fixed point is an equilibrium, not a cycle");
  cycle.method = exact ? "exact" : "shooting";
  if (options.derivative_rtol > 0.0) {
    judge(point, result, exact, options.derivative_rtol);
    // A motion through a thin layer (bristles, a steep Stribeck curve) is followed better than its derivative.
    // Where that layer has an infinite slope no tolerance helps.
    constexpr double tight = 1e-10, tighter = 1e-12, rough = 2e-3;
    const auto is_rough = [&] { return !exact && result.multiplier_error > rough; };
    if (!exact && options.derivative_rtol > tight && (!cycle.stable || is_rough())) judge(point, result, exact, tight);
    if (is_rough() && !has_infinite_slope(loop)) judge(point, result, exact, tighter);
    if (result.trivial_error > lost_derivative) {
      cycle.multipliers.clear();
      cycle.multiplier_error = std::max(cycle.multiplier_error, result.trivial_error);
    }
  }
  result.status = Status::converged;
  result.maps = point.maps();
  result.steps = point.steps();
  return result;
}

}  // namespace limcycle
