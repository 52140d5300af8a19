#include "limcycle/analysis/study/precision/cycle_methods.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

constexpr double steady = 0.02;  ///< a larger spread of the periods means that they do not repeat

Attempt attempt_of(const IntegratorCheck& run, const CycleReference& reference, long max_steps) {
  Attempt attempt;
  attempt.status = run.status;
  attempt.gave_up = run.gave_up;
  attempt.evaluations = run.steps;
  attempt.measuring = run.measuring;
  if (run.gave_up) attempt.why = "gave up after " + std::to_string(run.steps) + " steps";
  if (run.gave_up && run.steps < max_steps)
    attempt.why += ", since the whole run takes more than " + std::to_string(max_steps);
  if (run.status != Status::converged) return attempt;
  attempt.answered = true;
  attempt.state_error = run.state_error;
  if (!run.periodic) {
    attempt.of_another_kind = true;
    attempt.why = "the motion leaves the cycle and does not come back";
    return attempt;
  }
  attempt.error = relative_error(run, reference.cycle);
  attempt.of_another_kind = run.spread > steady || attempt.error > 1.0;
  if (run.spread > steady)
    attempt.why = "irregular: successive periods differ by " + short_number(100.0 * run.spread) + " %";
  else if (attempt.error > right_within)
    attempt.why =
        "settles on a period of " + short_number(run.period) + " s and an amplitude of " + short_number(run.amplitude);
  return attempt;
}

Attempt compare_shot(const ShootingResult& shot, const CycleReference& reference) {
  Attempt attempt;
  attempt.status = shot.status;
  attempt.evaluations = shot.maps;
  attempt.why = shot.why;
  attempt.answered = shot.status == Status::converged;
  if (!attempt.answered) return attempt;
  const Cycle &a = shot.cycle, &b = reference.cycle;
  attempt.error = std::max(std::abs(a.period / b.period - 1.0), std::abs(a.amplitude / b.amplitude - 1.0));
  attempt.of_another_kind = attempt.error > 1.0;
  return attempt;
}

/// The point of the cycle with its linear states moved away from the rest point by 1 %.
LoopState beside(const Loop& loop, const Cycle& cycle) {
  LoopState state = cycle.start;
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    double& x = state.x[static_cast<std::size_t>(i)];
    x = rest(i) + 1.01 * (x - rest(i));
  }
  return state;
}

/// True if the cycle closes after half a period, by a reflection. Its trace covers a whole one.
bool closes_by_half(const Loop& loop, const Cycle& cycle) {
  return cycle.half_wave_symmetric && symmetry(loop).has_value();
}

/// The harmonics of the cycle if it has one element, otherwise the first one.
HarmonicGuess guess_of(const Loop& loop, const Cycle& cycle, int orders) {
  HarmonicGuess guess{cycle.frequency(), {}, {}, {}};
  if (loop.elements.size() == 1) {
    guess.inputs.push_back(input_harmonics(cycle, std::min(9, orders)));
    return guess;
  }
  guess.first = Eigen::VectorXcd::Zero(std::ssize(loop.elements));
  guess.first(guess.first.size() - 1) = input_harmonics(cycle, 1)(1);
  return guess;
}

/// Rating of a balance with `wanted` harmonics. One solved with fewer of them is no answer.
Attempt compare_balance(const HarmonicBalance& found, int wanted, const CycleReference& reference, bool out_of_budget) {
  Attempt attempt;
  attempt.status = found.status;
  attempt.evaluations = found.evaluations;
  attempt.answered = found.harmonics == wanted && found.residual < 1e-6 && found.first_harmonic > 0.0;
  if (!attempt.answered) {
    attempt.gave_up = out_of_budget;
    attempt.why = out_of_budget         ? "gave up after " + std::to_string(found.evaluations) + " evaluations"
                  : found.harmonics > 0 ? "no balance; the last one found has H = " + std::to_string(found.harmonics)
                                        : found.why;
    return attempt;
  }
  const Cycle& cycle = reference.cycle;
  attempt.error =
      std::max(std::abs(found.frequency / cycle.frequency() - 1.0), std::abs(found.amplitude / cycle.amplitude - 1.0));
  attempt.of_another_kind = attempt.error > 1.0;
  if (attempt.error > right_within)
    attempt.why = "harmonics above " + std::to_string(found.harmonics) + " are left out";
  return attempt;
}

/// Against the nearest of some first-harmonic predictions.
Attempt compare_roots(const std::vector<std::pair<double, double>>& roots, Status status, long evaluations,
                      const CycleReference& reference) {
  Attempt attempt;
  attempt.status = status;
  attempt.evaluations = evaluations;
  if (status == Status::interrupted) return attempt;
  attempt.answered = status == Status::converged || status == Status::no_cycle || !roots.empty();
  for (const auto& [amplitude, frequency] : roots) {
    Prediction p;
    p.amplitude = amplitude;
    p.frequency = frequency;
    if (!nearest({reference.cycle}, p)) continue;
    const double error = std::max(std::abs(frequency / reference.cycle.frequency() - 1.0),
                                  std::abs(amplitude / reference.cycle.first_harmonic - 1.0));
    if (!(error >= attempt.error)) attempt.error = error;
  }
  if (std::isnan(attempt.error)) {
    attempt.of_another_kind = attempt.answered;
    attempt.why = !attempt.answered ? "the search ended with status " + std::string(to_string(status))
                  : roots.empty()   ? "predicts no cycle"
                                    : "predicts no cycle near this one";
  } else if (attempt.error > right_within) {
    attempt.why = "one harmonic is not enough here: no setting changes this error";
  }
  return attempt;
}

WorkMethod describing_function_method(const Loop& loop, const CycleReference& reference,
                                      const CycleMethodsOptions& options) {
  const SearchBox box = options.predict.search.value_or(default_search_box(loop));
  return {"describing-function",
          "roots",
          {"one harmonic"},
          [&loop, &reference, box, stop = options.predict.stop](std::size_t) {
            const FirstHarmonicBalance balance(loop);
            const DfRoots found = find_df_roots(loop, balance, box, stop);
            std::vector<std::pair<double, double>> roots;
            for (const Root& root : found.roots)
              roots.emplace_back(balance.output_amplitude(root.amplitude, root.frequency), root.frequency);
            return compare_roots(roots, found.status, std::ssize(roots), reference);
          }};
}

WorkMethod composite_method(const Loop& loop, const CycleReference& reference, const CycleMethodsOptions& options) {
  const SearchBox box = options.predict.search.value_or(default_search_box(loop));
  return {"composite-describing-function",
          "evaluations",
          {"one harmonic"},
          [&loop, &reference, box, stop = options.predict.stop](std::size_t) {
            CompositeBalance balance(loop);
            CompositeSearchOptions search;
            search.frequency_min = box.frequency_min;
            search.frequency_max = box.frequency_max;
            search.stop = stop;
            const CompositeSearch found = balance.find(search);
            std::vector<std::pair<double, double>> roots;
            for (const auto& root : found.roots) roots.emplace_back(root.amplitude, root.frequency);
            return compare_roots(roots, found.status, found.evaluations, reference);
          }};
}

}  // namespace

std::vector<std::string> tolerance_settings(const std::vector<double>& tolerances) {
  std::vector<std::string> list;
  for (const double rtol : tolerances) {
    char text[32];
    std::snprintf(text, sizeof text, "rtol %.0e", rtol);
    list.emplace_back(text);
  }
  return list;
}

std::vector<WorkMethod> stepper_methods(const Loop& loop, const CycleReference& reference,
                                        const CycleMethodsOptions& options) {
  std::vector<WorkMethod> list;
  const bool affine = choose_stepper(loop, 1e-7) == StepperKind::exact;
  for (const auto kind : {StepperKind::exact, StepperKind::rodas5p, StepperKind::dopri5, StepperKind::fehlberg78,
                          StepperKind::cash_karp54}) {
    if (kind == StepperKind::exact && !affine) continue;
    const bool exact = kind == StepperKind::exact;  // has no tolerance
    const auto tolerances = exact ? std::vector<double>{1e-12} : options.tolerances;
    list.push_back({std::string(to_string(kind)), "steps",
                    exact ? std::vector<std::string>{"no tolerance"} : tolerance_settings(tolerances),
                    [&loop, &reference, kind, tolerances, options](std::size_t i) {
                      return attempt_of(check_integrator(loop, reference.cycle, reference.sizes,
                                                         {kind, tolerances[i], options.periods, options.max_steps,
                                                          options.predict.stop}),
                                        reference, options.max_steps);
                    }});
  }
  return list;
}

WorkMethod shooting_method(const Loop& loop, const CycleReference& reference, const CycleMethodsOptions& options) {
  std::vector<double> tolerances;
  std::ranges::copy_if(options.tolerances, std::back_inserter(tolerances), [](double rtol) { return rtol <= 1e-5; });
  return {"shooting", "maps", tolerance_settings(tolerances),
          [&loop, &reference, tolerances, stop = options.predict.stop](std::size_t i) {
            const Cycle& cycle = reference.cycle;
            ShootingOptions shooting;
            shooting.rtol = tolerances[i];
            shooting.tolerance = 30.0 * tolerances[i];
            shooting.stop = stop;
            const Section section = choose_section(loop, cycle.trace);
            shooting.returns = returns_of(section, cycle.trace);
            shooting.longest_map = 10.0 * cycle.period;
            return compare_shot(shoot(loop, beside(loop, cycle), section, closes_by_half(loop, cycle), shooting),
                                reference);
          }};
}

WorkMethod balance_method(const Loop& loop, const CycleReference& reference, const CycleMethodsOptions& options) {
  static constexpr int orders[] = {1, 3, 5, 9, 15, 25, 45, 75};
  std::vector<std::string> settings;
  for (const int H : orders) settings.push_back("H = " + std::to_string(H));
  return {"harmonic-balance", "evaluations", settings, [&loop, &reference, options](std::size_t i) {
            HarmonicBalanceOptions balance;
            balance.max_harmonics = orders[i];
            balance.tail = 1e-14;  // all harmonics are wanted
            balance.max_evaluations = options.max_evaluations;
            balance.stop = options.predict.stop;
            balance.half_wave_symmetric = closes_by_half(loop, reference.cycle);
            const HarmonicBalance found = harmonic_balance(loop, guess_of(loop, reference.cycle, orders[i]), balance);
            return compare_balance(found, orders[i], reference, found.evaluations >= options.max_evaluations);
          }};
}

std::vector<WorkMethod> first_harmonic_methods(const Loop& loop, const CycleReference& reference,
                                               const CycleMethodsOptions& options) {
  std::vector<WorkMethod> list;
  if (!FirstHarmonicBalance::not_applicable(loop)) list.push_back(describing_function_method(loop, reference, options));
  if (loop.delay == 0.0 && !CompositeBalance::not_applicable(loop))
    list.push_back(composite_method(loop, reference, options));
  return list;
}

}  // namespace limcycle
