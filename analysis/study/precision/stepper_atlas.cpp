#include "limcycle/analysis/study/precision/stepper_atlas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/precision/cycle_reference.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {
namespace {

constexpr double irregular = 0.02;      ///< a larger spread of the intervals means no period
constexpr double peak_needed = 0.9;     ///< share of the true peak of the force that a run must reach
constexpr double flips_allowed = 20.0;  ///< times the true number of reversals
constexpr int rest_samples = 60;

/// The reference of one loop, and the watch of its runs.
struct Truth {
  const AtlasLoop* of = nullptr;
  AtlasReference reference;
  LoopState start;
  InstrumentedRunOptions watch;
  InstrumentedRun motion;  ///< of the best run
  std::size_t returns = 1;
};

std::vector<StepperKind> steppers_for(const Loop& loop) {
  std::vector<StepperKind> kinds{StepperKind::rodas5p, StepperKind::dopri5, StepperKind::fehlberg78,
                                 StepperKind::cash_karp54};
  if (AffineFlow::applies(loop)) kinds.insert(kinds.begin(), StepperKind::exact);
  return kinds;
}

std::vector<MarchMethod> methods_for(const Loop& loop, const AtlasOptions& options) {
  std::vector<MarchMethod> methods;
  for (const StepperKind kind : steppers_for(loop))
    for (const double rtol : options.tolerances) methods.push_back({kind, rtol});
  for (const StepperKind kind : {StepperKind::rodas5p, StepperKind::fehlberg78})
    for (const double rtol : options.tolerances) methods.push_back({kind, rtol, true});
  for (const FixedMethod kind : {FixedMethod::euler, FixedMethod::rk4, FixedMethod::semi_implicit})
    for (const double h : options.steps) methods.push_back({kind, h});
  if (!options.steppers.empty())
    std::erase_if(methods, [&](const MarchMethod& method) {
      return std::ranges::find(options.steppers, method.name()) == options.steppers.end();
    });
  return methods;
}

struct Period {
  double mean = not_known, spread = infinite;
};

/// Period from all intervals but the first: that one is incomplete or begins on the reference.
Period period_of(const std::vector<double>& crossings, std::size_t returns) {
  if (crossings.size() < returns + 2) return {};
  double least = infinite, most = 0.0, sum = 0.0;
  const std::size_t count = crossings.size() - returns;
  for (std::size_t i = 1; i < count; ++i) {
    const double interval = crossings[i + returns] - crossings[i];
    least = std::min(least, interval);
    most = std::max(most, interval);
    sum += interval;
  }
  const double mean = sum / static_cast<double>(count - 1);
  return {mean, (most - least) / mean};
}

RunClass by_error(double error) {
  return error <= atlas_right ? RunClass::right : error <= atlas_rough ? RunClass::rough : RunClass::wrong_motion;
}

bool flips(const InstrumentedRun& run, const Truth& truth) {
  return static_cast<double>(run.reversals) > flips_allowed * static_cast<double>(truth.motion.reversals + 4);
}

void judge_hunting(AtlasPoint& point, const InstrumentedRun& run, const Truth& truth) {
  const double T = truth.reference.period;
  const Period period = period_of(run.crossings, truth.returns);
  point.error = std::abs(period.mean / T - 1.0);
  const double late = run.crossings.empty() ? 0.0 : run.crossings.back();
  const bool ends = late < truth.watch.duration - 2.5 * T;
  if (!ends && std::isfinite(point.error) && period.spread <= irregular) {
    point.kind = by_error(point.error);
    if (point.kind == RunClass::rough || point.kind == RunClass::right) {
      if (point.kind == RunClass::rough) point.why = "period " + short_number(period.mean);
      return;
    }
  }
  if (run.peak < peak_needed * truth.motion.peak) {
    point.kind = RunClass::misses_event;
    point.why = "largest force seen " + short_number(run.peak) + " of " + short_number(truth.motion.peak);
  } else if (flips(run, truth)) {
    point.kind = RunClass::chatters;
    point.why = std::to_string(run.reversals) + " reversals for " + std::to_string(truth.motion.reversals);
  } else if (ends && run.swing < 0.05 * truth.motion.swing) {
    point.kind = RunClass::stops;
    point.why = "rests after t = " + short_number(late) + " s";
  } else if (ends || !(period.spread <= irregular)) {
    point.kind = RunClass::creeps;
    point.why = std::isfinite(period.spread) ? "periods differ by " + short_number(100.0 * period.spread, 3) + " %"
                                             : "it does not come back";
  } else {
    point.kind = RunClass::wrong_motion;
    point.why = "period " + short_number(period.mean);
  }
}

double motion_error(const InstrumentedRun& run, const InstrumentedRun& truth) {
  const auto [low, high] = std::ranges::minmax(truth.y);
  double error = run.y.size() == truth.y.size() ? 0.0 : infinite;
  for (std::size_t i = 0; i < std::min(run.y.size(), truth.y.size()); ++i)
    error = std::max(error, std::abs(run.y[i] - truth.y[i]) / (high - low));
  return error;
}

void judge_rest(AtlasPoint& point, const InstrumentedRun& run, const Truth& truth) {
  point.error = motion_error(run, truth.motion);
  point.kind = by_error(point.error);
  if (point.kind == RunClass::right) return;
  point.why = "y is off by " + short_number(100.0 * point.error, 3) + " %";
  if (point.kind == RunClass::rough) return;
  const auto [low, high] = std::ranges::minmax(truth.motion.y);
  if (flips(run, truth))
    point.kind = RunClass::chatters;
  else if (run.swing < truth.motion.swing + 0.02 * (high - low))
    point.kind = RunClass::creeps;  // it also rests, elsewhere or later
}

AtlasPoint point_of(const Truth& truth, const MarchMethod& method, const InstrumentedRun& run) {
  AtlasPoint point{
      truth.of->law, truth.of->stiffness, method.name(), method.setting, method.fixed(), {}, not_known, run.steps, {}};
  if (run.gave_up) {
    point.kind = RunClass::too_slow;
    point.why = "given up after " + std::to_string(run.steps) + " steps";
  } else if (run.status == Status::chattering) {
    point.kind = RunClass::chatters;
    point.why = "switches accumulate";
  } else if (run.status != Status::converged) {
    point.kind = RunClass::diverges;
    point.why = "ended with status " + std::string(to_string(run.status));
  } else if (truth.reference.hunts) {
    judge_hunting(point, run, truth);
  } else {
    judge_rest(point, run, truth);
  }
  if (!std::isfinite(point.error)) point.error = not_known;
  return point;
}

bool stopped(const AtlasOptions& options) { return options.stop && options.stop(); }

/// A loop that hunts, if that can be verified.
bool find_cycle(Truth& truth, const AtlasOptions& options) {
  PredictOptions predict = options.predict;
  predict.stop = options.stop;
  std::string why;
  const auto cycle = cycle_reference(truth.of->loop, predict, options.check_steps, why);
  truth.reference.words = why;
  if (!cycle) return false;
  truth.reference.hunts = true;
  truth.reference.period = cycle->cycle.period;
  truth.reference.agreement = cycle->agreement;
  truth.reference.verified = cycle->verified();
  if (!cycle->verified()) return true;
  truth.reference.words = "period " + short_number(cycle->cycle.period, 8) + " s, confirmed to " +
                          short_number(cycle->agreement, 2) + " by " + cycle->verified_by;
  truth.start = cycle->cycle.start;
  truth.watch.section = choose_section(truth.of->loop, cycle->cycle.trace);
  truth.returns = static_cast<std::size_t>(returns_of(truth.watch.section, cycle->cycle.trace));
  truth.watch.duration = (options.periods + 0.5) * cycle->cycle.period;
  truth.watch.last = cycle->cycle.period;
  return true;
}

/// A loop that comes to rest: ten periods of its slowest pole, from a displaced y.
void watch_rest(Truth& truth, const AtlasOptions& options) {
  const Loop& loop = truth.of->loop;
  const auto moduli = pole_moduli(loop);
  truth.watch.duration = 20.0 * std::numbers::pi / (moduli.empty() ? 1.0 : moduli.front());
  truth.watch.last = 0.2 * truth.watch.duration;
  for (int i = 1; i <= rest_samples; ++i) truth.watch.samples.push_back(truth.watch.duration * i / rest_samples);
  const State typical = typical_sizes(loop);
  double size = 0.0;
  for (Eigen::Index i = 0; i < loop.states(); ++i)
    size = std::max(size, std::abs(loop.C_y(i)) * typical[static_cast<std::size_t>(i)]);
  truth.start = displaced(loop, size);
  truth.watch.section = {loop.C_y, infinite, 1};  // never crossed
  InstrumentedRunOptions patient = truth.watch;
  patient.evaluations = 20.0 * static_cast<double>(options.check_steps);
  truth.motion = instrumented_run(loop, truth.start, {StepperKind::rodas5p, 1e-11}, patient);
  for (const auto& check : {MarchMethod{StepperKind::fehlberg78, 1e-11}, MarchMethod{StepperKind::rodas5p, 1e-9}}) {
    const InstrumentedRun second = instrumented_run(loop, truth.start, check, patient);
    if (second.status != Status::converged || truth.motion.status != Status::converged) continue;
    truth.reference.agreement = motion_error(second, truth.motion);
    truth.reference.words = "comes to rest; the motion is confirmed to " + short_number(truth.reference.agreement, 2) +
                            " by " + check.name() + " at rtol " + short_number(check.setting);
    truth.reference.verified = truth.reference.agreement < 1e-4;
    if (truth.reference.verified) return;
  }
}

Truth truth_of(const AtlasLoop& loop, const AtlasOptions& options) {
  Truth truth;
  truth.of = &loop;
  truth.reference = {loop.law, loop.stiffness, false, false, not_known, not_known, {}};
  truth.watch.evaluations = options.evaluations;
  truth.watch.stop = options.stop;
  if (find_cycle(truth, options)) {
    InstrumentedRunOptions patient = truth.watch;
    patient.evaluations = 20.0 * static_cast<double>(options.check_steps);
    if (truth.reference.verified)
      truth.motion = instrumented_run(loop.loop, truth.start, {choose_stepper(loop.loop, 1e-10), 1e-10}, patient);
    truth.reference.verified = truth.reference.verified && truth.motion.status == Status::converged;
  } else if (!stopped(options)) {
    watch_rest(truth, options);
  }
  return truth;
}

/// Work of several threads; each result is stored at the place of its task, so that the order is always the same.
void share(std::size_t count, const AtlasOptions& options, double from, double to, std::string_view what,
           const std::function<void(std::size_t)>& work) {
  run_each(count, work, part_of_work(options.threads, options.stop, options.progress, from, to, std::string(what)));
}

}  // namespace

std::string_view to_string(RunClass kind) {
  switch (kind) {
    case RunClass::right:
      return "right";
    case RunClass::rough:
      return "rough";
    case RunClass::creeps:
      return "creeps";
    case RunClass::wrong_motion:
      return "wrong motion";
    case RunClass::stops:
      return "stops";
    case RunClass::chatters:
      return "chatters";
    case RunClass::misses_event:
      return "misses event";
    case RunClass::diverges:
      return "diverges";
    default:
      return "too slow";
  }
}

StepperAtlas stepper_atlas(const std::vector<AtlasLoop>& loops, const AtlasOptions& options) {
  StepperAtlas atlas;
  std::vector<Truth> truths(loops.size());
  share(loops.size(), options, 0.0, 0.3, "references", [&](std::size_t i) { truths[i] = truth_of(loops[i], options); });
  struct Task {
    const Truth* truth;
    MarchMethod method;
  };
  std::vector<Task> tasks;
  for (const Truth& truth : truths) {
    if (truth.of == nullptr) continue;
    atlas.references.push_back(truth.reference);
    if (!truth.reference.verified) continue;
    for (const auto& method : methods_for(truth.of->loop, options)) tasks.push_back({&truth, method});
  }
  std::vector<std::optional<AtlasPoint>> found(tasks.size());
  share(tasks.size(), options, 0.3, 1.0, "steppers", [&](std::size_t i) {
    const auto& [truth, method] = tasks[i];
    const InstrumentedRun run = instrumented_run(truth->of->loop, truth->start, method, truth->watch);
    if (run.status != Status::interrupted) found[i] = point_of(*truth, method, run);
  });
  for (auto& point : found)
    if (point) atlas.points.push_back(std::move(*point));
  if (stopped(options)) atlas.status = Status::interrupted;
  return atlas;
}

double loosest_right(const StepperAtlas& atlas, const std::string& stepper, double stiffness) {
  double loosest = not_known, failing = 0.0;
  for (const auto& point : atlas.points) {
    if (point.stepper != stepper || point.stiffness > stiffness) continue;
    if (point.kind != RunClass::right && point.kind != RunClass::too_slow)
      failing = failing == 0.0 ? point.setting : std::min(failing, point.setting);
  }
  for (const auto& point : atlas.points)
    if (point.stepper == stepper && !(point.stiffness > stiffness) && point.kind == RunClass::right &&
        (failing == 0.0 || point.setting < failing) && !(point.setting <= loosest))
      loosest = point.setting;
  return loosest;
}

}  // namespace limcycle
