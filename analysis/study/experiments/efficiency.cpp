#include <ctime>

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"

namespace limcycle {
namespace {

constexpr double wanted = 1e-5;  // relative error at which the laws are compared
constexpr double duration = 12.0;
constexpr std::array tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
constexpr double reference_tolerance = 1e-10;

/// A force that makes the mass stick, slip and stick again: a zig-zag of 1 N/s to 2 N either way. It stops the mass
/// where the force is far below stiction: a stop close to stiction would test if the mass is caught, not the cost of a
/// law.
Signal reversing_force() {
  Signal zigzag;
  zigzag.kind = Signal::Kind::zigzag;
  zigzag.value = 2.0;
  zigzag.rate = 1.0;
  return zigzag;
}

/// CPU time of this thread, so that other load of the machine is not counted.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Timed {
  ForcedRun run;
  double seconds = 0.0;
};

Timed timed(const Element& law, double rtol, const std::function<bool()>& stop) {
  ForcedOptions options;
  options.duration = duration;
  options.rtol = rtol;
  options.stop = stop;
  for (int k = 1; k < static_cast<int>(duration); ++k) options.samples.push_back(k);
  const double begin = processor_seconds();
  Timed result{run_forced(law, reversing_force(), options), 0.0};
  result.seconds = processor_seconds() - begin;
  return result;
}

/// Largest difference of displacement at whole seconds, relative to the largest displacement.
double error_of(const ForcedRun& run, const ForcedRun& reference) {
  double worst = 0.0, size = 0.0;
  for (int k = 1; k <= static_cast<int>(duration); ++k) {
    const double here = run.displacement(k), there = reference.displacement(k);
    worst = std::max(worst, std::abs(here - there));
    size = std::max(size, std::abs(there));
  }
  return size > 0.0 ? worst / size : NAN;
}

/// Cost at the wanted error, between the runs on both sides of it on logarithmic scales; NaN if none is as accurate.
double cost_at(const std::vector<double>& errors, const std::vector<double>& costs) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!(errors[i] <= wanted)) continue;
    if (i == 0 || !(errors[i - 1] > wanted) || errors[i] <= 0.0) return costs[i];
    const double share = std::log(errors[i - 1] / wanted) / std::log(errors[i - 1] / errors[i]);
    return costs[i - 1] * std::pow(costs[i] / costs[i - 1], share);
  }
  return NAN;
}

LawPart cost_of_law(const LawSetting& setting) {
  const Element law = make_law(setting);
  const Timed reference = timed(law, reference_tolerance, setting.stop);
  LawPart part;
  part.status = reference.run.status;
  if (reference.run.status != Status::converged) {
    part.finding = "the reference run ended early";
    return part;
  }
  std::vector<double> errors, steps, milliseconds;
  for (const double rtol : tolerances) {
    const Timed now = timed(law, rtol, setting.stop);
    if (now.run.status != Status::converged) continue;
    errors.push_back(error_of(now.run, reference.run));
    steps.push_back(static_cast<double>(now.run.steps));
    milliseconds.push_back(1e3 * now.seconds);
    part.rows.push_back({"", "rtol " + quantity(rtol, "", 1), {errors.back(), steps.back(), milliseconds.back()}});
  }
  part.add(0, {"", errors, steps});
  const double at_steps = cost_at(errors, steps), at_time = cost_at(errors, milliseconds);
  part.rows.push_back({"", "at 1e-5", {wanted, at_steps, at_time}});
  part.finding = std::isfinite(at_steps) ? quantity(at_steps, "steps") + ", " + quantity(at_time, "ms", 2) +
                                               " for a relative error of 1e-5 in displacement"
                                         : "no tolerance tried reaches a relative error of 1e-5";
  return part;
}

}  // namespace

Experiment efficiency_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "efficiency";
  e.title = "What each law costs at equal accuracy";
  e.document =
      "thesis, chapter 4 (\"greater representation of friction ... at the expense of ... simulation efficiency\")";
  e.input =
      "a mass of 1 kg under a zig-zag force of 1 N/s between 2 and -2 N for 12 s: it sticks and slips. Tolerances 1e-3 "
      "to 1e-8, each run against "
      "one at 1e-10 of the same law; steps and processor time where the displacement is right to 1e-5";
  e.quantities = {{"error", "error", ""}, {"steps", "steps", ""}, {"time", "time", "ms"}};
  e.figures = {{"steps-error", "Steps over relative error", "error", "", "steps", "", true}};
  run_by_law(e, options, cost_of_law);
  ExperimentClaim claim{"laws that show more of friction than LuGre cost more: simulation efficiency",
                        "thesis, section 4.1", ClaimOutcome::not_tested, ""};
  const double plain = e.value("lugre", "time", "at 1e-5");
  int dearer = 0, richer = 0;
  for (const char* law : {"elasto-plastic", "gms", "xiong", "non-drift"}) {
    const double cost = e.value(law, "time", "at 1e-5");
    if (!std::isfinite(cost) || !std::isfinite(plain)) continue;
    ++richer;
    if (cost > plain) ++dearer;
    claim.measure += std::string(", ") + law + " " + quantity(cost, "ms", 2);
  }
  if (richer > 0) {
    claim.outcome = dearer == richer ? ClaimOutcome::confirmed
                    : dearer > 0     ? ClaimOutcome::depends
                                     : ClaimOutcome::not_confirmed;
    claim.measure = "lugre " + quantity(plain, "ms", 2) + claim.measure;
  }
  e.claims.push_back(std::move(claim));
  return e;
}

}  // namespace limcycle
