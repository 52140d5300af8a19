#include "limcycle/analysis/study/precision/cycle_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

struct Check {
  StepperKind stepper;
  double rtol;
};

/// Steppers that can check a result of this stepper, the best first.
std::vector<Check> checks_of(StepperKind made_by) {
  std::vector<Check> list;
  for (const auto stepper : {StepperKind::fehlberg78, StepperKind::rodas5p, StepperKind::dopri5})
    if (stepper != made_by) list.push_back({stepper, 1e-12});
  list.push_back({made_by, 1e-10});
  return list;
}

const Cycle* first_stable(const std::vector<Cycle>& cycles) {
  const auto found = std::ranges::find(cycles, std::optional<bool>(true), &Cycle::stable);
  return found == cycles.end() ? nullptr : &*found;
}

/// The cycles reached by simulations. If the first start reaches a stable one, the others are not needed: that cycle is
/// used.
PredictReport simulated(const Loop& loop, PredictOptions options) {
  const int starts = options.starts;
  options.starts = std::min(starts, 1);
  PredictReport report = predict(loop, options);
  const bool found = !report.outcomes.empty() && report.outcomes.front().cycle &&
                     report.cycles[*report.outcomes.front().cycle].stable == true;
  if (found || starts <= 1) return report;
  options.starts = starts;
  return predict(loop, options);
}

std::string outcomes_in_words(const PredictReport& report) {
  std::string text;
  for (const auto& one : report.outcomes)
    if (const std::string word(to_string(one.outcome)); text.find(word) == std::string::npos)
      text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "nothing was simulated" : "the simulations end in " + text;
}

}  // namespace

double relative_error(const IntegratorCheck& run, const Cycle& cycle) {
  return std::max(std::abs(run.period / cycle.period - 1.0), std::abs(run.amplitude / cycle.amplitude - 1.0));
}

void verify(const Loop& loop, CycleReference& reference, long max_steps, const std::function<bool()>& stop) {
  const StepperKind own = choose_stepper(loop, 3e-12);
  reference.made_by = "shooting at rtol 3e-12 (" + std::string(to_string(own)) + ")";
  for (const Check& check : checks_of(own)) {
    const IntegratorCheck run =
        check_integrator(loop, reference.cycle, reference.sizes, {check.stepper, check.rtol, 10, max_steps, stop});
    if (run.status != Status::converged || !run.periodic) continue;
    const double difference = relative_error(run, reference.cycle);
    if (!(difference < reference.agreement)) continue;
    reference.agreement = difference;
    reference.independent = check.stepper != own;
    reference.verified_by = "simulation of ten periods with " + std::string(to_string(check.stepper)) + " at rtol " +
                            short_number(check.rtol);
    if (reference.verified()) break;
  }
  reference.error = std::max({reference.agreement, reference.cycle.error, 1e-13});
}

std::optional<CycleReference> cycle_reference(const Loop& loop, const PredictOptions& options, long max_steps,
                                              std::string& why) {
  PredictOptions only_time = options;
  only_time.methods = {.describing_function = false, .composite = false, .harmonic_balance = false};
  only_time.accuracy = 1e-8;
  const PredictReport report = simulated(loop, only_time);
  const Cycle* cycle = first_stable(report.cycles);
  if (cycle == nullptr) {
    why = "no stable limit cycle was found: " + outcomes_in_words(report);
    return std::nullopt;
  }
  CycleReference reference{*cycle, sizes_on_cycle(loop, *cycle), {}, {}, false, infinite, infinite};
  verify(loop, reference, max_steps, options.stop);
  if (!reference.verified())
    why = reference.verified_by.empty()
              ? "no second method could follow the cycle"
              : "shooting and the " + reference.verified_by + " differ by " + short_number(reference.agreement);
  return reference;
}

}  // namespace limcycle
