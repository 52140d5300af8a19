#include "limcycle/questions/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/analysis/study/sensitivity/local_sensitivity.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/questions/asking/need_memory.hpp"
#include "limcycle/questions/threshold.hpp"

namespace limcycle {
namespace {

constexpr double default_share = 0.2;  // of each number, if the case gives no spread
constexpr std::size_t loops_a_block = 256;

ParameterSpread default_spread(const Case& from) {
  ParameterSpread spread;
  for (const auto& number : own_numbers(from)) {
    if (number.value == 0.0) continue;
    SpreadParameter one;
    one.path = number.path;
    one.value = one.mean = number.value;
    one.low = number.value - default_share * std::abs(number.value);
    one.high = number.value + default_share * std::abs(number.value);
    spread.parameters.push_back(std::move(one));
  }
  return spread;
}

/// The stable cycle with the largest amplitude, solved to a tight tolerance.
std::optional<Cycle> main_cycle(const Loop& loop, const Case& from, std::vector<std::string>& notes,
                                const Asking& asking) {
  PredictOptions options = from.predict;
  options.methods = {false, false, false};
  options.accuracy = std::min(from.predict.accuracy, 1e-9);
  options.stop = asking.stop;
  const PredictReport found = predict(loop, options);
  const Cycle* best = largest_stable(found.cycles);
  if (best == nullptr) return std::nullopt;
  if (loop.delay > 0.0) notes.emplace_back("the delay: derivatives of a cycle are not computed for loops with a delay");
  return *best;
}

/// Each number times each factor, the others unchanged.
void change_each(const std::vector<LoopNumber>& numbers, const std::vector<double>& factors,
                 const PredictOptions& options, const Asking& asking, std::vector<ParameterChange>& changes) {
  std::vector<const LoopNumber*> changed;
  for (const auto& number : numbers) {
    if (number.value == 0.0) continue;  // any factor leaves it 0
    for (const double factor : factors) {
      changes.push_back({number.path, number.unit, factor, factor * number.value, {}});
      changed.push_back(&number);
    }
  }
  std::vector<char> looked_at(changes.size(), 0);
  const auto look = [&](std::size_t i) {
    if (const auto loop = changed[i]->loop_at(changes[i].value)) changes[i].found = map_point(*loop, options);
    looked_at[i] = asking.stopped() ? 0 : 1;
  };
  SweepOptions each;
  each.threads = asking.threads;
  each.stop = asking.stop;
  run_each(changes.size(), look, each);
  std::vector<ParameterChange> known;
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (looked_at[i] != 0) known.push_back(std::move(changes[i]));
  changes = std::move(known);
}

void look_nearby(const Case& from, const Loop& loop, const SensitivityWishes& wishes, const Asking& asking,
                 SensitivityReport& report) {
  const auto numbers = loop_numbers(from);
  if (report.cycle && loop.delay == 0.0) report.local = local_sensitivities(loop, *report.cycle, numbers, asking.stop);
  report.predicted = predicted_sensitivities(loop, from.predict.search.value_or(default_search_box(loop)), numbers,
                                             report.notes, asking.stop);
  for (const auto& number : threshold_numbers(from, "thresholds", wishes.thresholds))
    if (!asking.stopped()) report.thresholds.push_back(threshold_of(from, loop, number, asking.stop));
  PredictOptions options = from.predict;
  options.methods = {false, false, false};
  options.accuracy = std::max(from.predict.accuracy, 1e-6);
  options.stop = asking.stop;
  std::vector<double> factors = wishes.factors;
  if (std::ranges::find(factors, 1.0) == factors.end()) factors.push_back(1.0);
  std::ranges::sort(factors);
  change_each(numbers, factors, options, asking, report.one_at_a_time);
}

std::string design_text(const GlobalPlan& plan, const EnsembleQuestion& question) {
  std::string text = fmt::format("sensitivity {}: {} trajectories, {} samples{}", to_string(question.isa),
                                 plan.morris().trajectories(), plan.sobol().samples(),
                                 plan.sobol().second_order() ? ", second order" : "");
  for (const auto& one : plan.spread().parameters)
    text += fmt::format("; {} {} {} {} {} {}", one.path, to_string(one.distribution), one.low, one.high, one.mean,
                        one.deviation);
  for (const auto& pair : plan.spread().correlations)
    text += fmt::format("; correlation {} {} {}", pair.one, pair.other, pair.value);
  text += fmt::format("; starts {}; accuracy {}; rtol {}; seed {}", fmt::join(question.displacements, " "),
                      question.accuracy, question.rtol, plan.spread().seed);
  return text;
}

LoopVariation variation_of(const Case& from, const GlobalPlan& plan) {
  std::vector<std::string> paths;
  for (const auto& one : plan.spread().parameters) paths.push_back(one.path);
  return {from, "[sensitivity]", paths};
}

/// The loops of a plan, each predicted from the same starts.
SweptRows sweep_plan(const Case& from, const Loop& loop, const GlobalPlan& plan, const Asking& asking,
                     const SweepRunner& sweep) {
  EnsembleQuestion question = ensemble_question(loop);
  question.isa = asking.isa;
  question.stop = asking.stop;
  const std::vector<std::string> columns(std::begin(EnsembleOutcome::names), std::end(EnsembleOutcome::names));
  const LoopVariation variation = variation_of(from, plan);
  SweepTask task{plan.size(), columns.size(), loops_a_block, {}};
  task.compute = [&](std::span<const std::size_t> points, std::span<double> rows) {
    std::vector<std::optional<Loop>> loops;
    for (const std::size_t point : points) loops.push_back(variation.loop(plan.values(point)));
    const auto answers = ensemble_outcomes(loops, question);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const double numbers[] = {answers[i].hunts, answers[i].amplitude, answers[i].period};
      std::ranges::copy(numbers, rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    }
    return answers.size();
  };
  return sweep(task, columns, design_text(plan, question));
}

/// Values and answers at Sobol's points A and B.
std::vector<std::vector<double>> fair_sample(const GlobalPlan& plan,
                                             const std::vector<std::optional<EnsembleOutcome>>& answers) {
  std::vector<std::vector<double>> sample;
  for (std::size_t k = 0; k < plan.fair_rows(); ++k) {
    const std::size_t row = plan.fair_row(k);
    const auto& answer = answers[row];
    if (!answer) continue;
    sample.push_back(plan.values(row));
    sample.back().insert(sample.back().end(), {answer->hunts, answer->amplitude, answer->period});
  }
  return sample;
}

Status look_everywhere(const Case& from, const Loop& loop, const SensitivityWishes& wishes, const Asking& asking,
                       const SweepRunner& sweep, SensitivityReport& report) {
  const auto [samples, trajectories] = sizes_of(wishes, report.spread);
  const GlobalPlan plan(report.spread, static_cast<std::size_t>(trajectories), static_cast<std::size_t>(samples),
                        wishes.second_order);
  const SweptRows swept = sweep_plan(from, loop, plan, asking, sweep);
  std::vector<std::optional<EnsembleOutcome>> answers(plan.size());
  for (std::size_t k = 0; k < plan.size(); ++k)
    if (swept.known[k]) answers[k] = {swept.rows[3 * k], swept.rows[3 * k + 1], swept.rows[3 * k + 2]};
  if (std::ranges::none_of(swept.known, [](bool known) { return known; })) return swept.status;
  const LoopVariation variation = variation_of(from, plan);
  report.global = global_sensitivity(plan, answers, ensemble_question(loop).accuracy,
                                     [&](std::size_t row) { return variation.loop(plan.values(row)).has_value(); });
  report.sample = fair_sample(plan, answers);
  return swept.status;
}

}  // namespace

std::pair<int, int> sizes_of(const SensitivityWishes& wishes, const ParameterSpread& spread) {
  const int samples = wishes.samples > 0 ? wishes.samples : spread.samples;
  return {samples, wishes.trajectories > 0 ? wishes.trajectories : std::clamp(samples / 10, 10, 100)};
}

ParameterSpread spread_of(const Case& from, const Asking& asking) {
  ParameterSpread spread = from.sensitivity ? *from.sensitivity : default_spread(from);
  if (asking.seed != 0) spread.seed = asking.seed;
  return spread;
}

void need_memory_for(const SensitivityWishes& wishes, const ParameterSpread& spread, const std::string& dashes) {
  if (wishes.local_only) return;
  const auto sizes = sizes_of(wishes, spread);
  const double samples = sizes.first, trajectories = sizes.second;
  const auto parameters = static_cast<double>(spread.parameters.size());
  const double rows = samples * (2.0 + parameters * (wishes.second_order ? 2.0 : 1.0));
  // The plan, and the answer of each of its loops, are in memory at the same time.
  const double bytes_a_row = sizeof(std::optional<EnsembleOutcome>) + sizeof(std::optional<double>) + 4.0 * 8.0;
  const double bytes_a_sample = 16.0 * parameters + 2.0 * (40.0 + 8.0 * (3.0 + parameters));
  need_memory(dashes + "samples", samples, bytes_a_sample + bytes_a_row * rows / samples, "fewer samples");
  need_memory(dashes + "trajectories", trajectories, (parameters + 1.0) * (bytes_a_row + 8.0), "fewer trajectories");
}

std::string flags_of(const SensitivityWishes& wishes, std::uint64_t seed) {
  std::string text;
  if (wishes.samples > 0) text += fmt::format(" --samples {}", wishes.samples);
  if (wishes.trajectories > 0) text += fmt::format(" --trajectories {}", wishes.trajectories);
  if (wishes.second_order) text += " --second-order";
  if (wishes.local_only) text += " --local";
  for (const auto& path : wishes.thresholds) text += " --threshold " + path;
  if (wishes.factors != SensitivityWishes{}.factors)
    text += fmt::format(" --factors {}", fmt::join(wishes.factors, ","));
  if (seed != 0) text += fmt::format(" --seed {}", seed);
  return text.empty() ? text : text.substr(1);
}

SensitivityReport ask_sensitivity(const Case& from, const SensitivityWishes& wishes, const Asking& asking,
                                  const SweepRunner& sweep, Status& status) {
  const Loop loop = build_loop(need_loop(from));
  SensitivityReport report;
  report.spread_is_default = !from.sensitivity;
  report.spread = spread_of(from, asking);
  if (wishes.nearby) {
    asking.report(0.0, "the cycle and its neighbourhood");
    report.cycle = main_cycle(loop, from, report.notes, asking);
    look_nearby(from, loop, wishes, asking, report);
  }
  status = asking.ending();
  if (wishes.local_only || asking.stopped()) return report;
  if (report.spread_is_default)
    report.notes.emplace_back("the case has no [sensitivity] section: each of its numbers varies uniformly by +-20 %");
  if (!report.spread.correlations.empty())
    report.notes.emplace_back(
        "the numbers of the spread are correlated: Morris's effects and Sobol's shares of the variance, which are "
        "those "
        "of independent numbers, are not computed");
  if (!report.spread.parameters.empty()) status = look_everywhere(from, loop, wishes, asking, sweep, report);
  return report;
}

}  // namespace limcycle
