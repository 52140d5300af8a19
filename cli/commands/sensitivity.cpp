#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/analysis/study/sensitivity/local_sensitivity.hpp"
#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/commands/threshold.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/message.hpp"
#include "limcycle/cli/need_memory.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/cli/ranks/ranks.hpp"
#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/cli/units_of.hpp"
#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/number.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

constexpr double default_share = 0.2;  // of each number, if the case gives no spread
constexpr std::size_t loops_a_block = 256;

struct SensitivityFlags : SweepFlags {
  int samples = 0;       ///< --samples; 0: from the case
  int trajectories = 0;  ///< --trajectories; 0: a tenth of the samples, 10 to 100
  bool second_order = false;
  std::vector<double> factors{0.5, 2.0};  ///< --factors
  bool local_only = false;                ///< --local
  std::vector<std::string> thresholds;    ///< --threshold, repeatable
  std::string html;                       ///< --html
};

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
std::optional<Cycle> main_cycle(const Loop& loop, const Case& from, std::vector<std::string>& notes) {
  PredictOptions options = from.predict;
  options.methods = {false, false, false};
  options.nyquist = false;
  options.accuracy = std::min(from.predict.accuracy, 1e-9);
  options.stop = interrupted;
  const PredictReport found = predict(loop, options);
  const Cycle* best = largest_stable(found.cycles);
  if (best == nullptr) return std::nullopt;
  if (loop.delay > 0.0) notes.emplace_back("the delay: derivatives of a cycle are not computed for loops with a delay");
  return *best;
}

/// Each number times each factor, the others unchanged.
void change_each(const std::vector<LoopNumber>& numbers, const std::vector<double>& factors,
                 const PredictOptions& options, int threads, std::vector<ParameterChange>& changes) {
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
    looked_at[i] = interrupted() ? 0 : 1;
  };
  SweepOptions each;
  each.threads = threads;
  each.stop = interrupted;
  run_each(changes.size(), look, each);
  std::vector<ParameterChange> known;
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (looked_at[i] != 0) known.push_back(std::move(changes[i]));
  changes = std::move(known);
}

void look_nearby(const Case& from, const Loop& loop, const SensitivityFlags& flags, SensitivityReport& report) {
  const auto numbers = loop_numbers(from);
  if (report.cycle && loop.delay == 0.0) report.local = local_sensitivities(loop, *report.cycle, numbers, interrupted);
  report.predicted = predicted_sensitivities(loop, from.predict.search.value_or(default_search_box(loop)), numbers,
                                             report.notes, interrupted);
  for (const auto& number : threshold_numbers(from, flags.thresholds))
    if (!interrupted()) report.thresholds.push_back(threshold_of(from, loop, number));
  PredictOptions options = from.predict;
  options.methods = {false, false, false};
  options.accuracy = std::max(from.predict.accuracy, 1e-6);
  options.stop = interrupted;
  std::vector<double> factors = flags.factors;
  if (std::ranges::find(factors, 1.0) == factors.end()) factors.push_back(1.0);
  std::ranges::sort(factors);
  change_each(numbers, factors, options, flags.threads, report.one_at_a_time);
}

std::string design_text(const GlobalPlan& plan, const HuntingQuestion& question) {
  std::string text = fmt::format("sensitivity {}: {} trajectories, {} samples{}", to_string(question.isa),
                                 plan.morris().trajectories(), plan.sobol().samples(),
                                 plan.sobol().second_order() ? ", second order" : "");
  for (const auto& one : plan.spread().parameters)
    text += fmt::format("; {} {} {} {} {} {}", one.path, to_string(one.distribution), one.low, one.high, one.mean,
                        one.deviation);
  text += fmt::format("; starts {}; accuracy {}; rtol {}; seed {}", fmt::join(question.displacements, " "),
                      question.accuracy, question.rtol, plan.spread().seed);
  return text;
}

/// The loops of a plan, each predicted from the same starts.
SweptRows sweep_plan(const Case& from, const Loop& loop, const GlobalPlan& plan, const SensitivityFlags& flags) {
  HuntingQuestion question = hunting_question(loop);
  question.isa = instruction_set(flags);
  question.stop = interrupted;
  const std::vector<std::string> columns(std::begin(HuntingAnswer::names), std::end(HuntingAnswer::names));
  std::vector<std::string> paths;
  for (const auto& one : plan.spread().parameters) paths.push_back(one.path);
  const LoopVariation variation(from, "[sensitivity]", paths);
  SweepTask task{plan.size(), columns.size(), loops_a_block, {}};
  task.compute = [&](std::span<const std::size_t> points, std::span<double> rows) {
    std::vector<std::optional<Loop>> loops;
    for (const std::size_t point : points) loops.push_back(variation.loop(plan.values(point)));
    const auto answers = hunting_answers(loops, question);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const double numbers[] = {answers[i].hunts, answers[i].amplitude, answers[i].period};
      std::ranges::copy(numbers, rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    }
    return answers.size();
  };
  return run_stored(task, columns, design_text(plan, question), flags, from);
}

/// Values and answers at Sobol's points A and B.
std::vector<std::vector<double>> fair_sample(const GlobalPlan& plan,
                                             const std::vector<std::optional<HuntingAnswer>>& answers) {
  std::vector<std::vector<double>> sample;
  for (std::size_t k = 0; k < plan.sobol().samples(); ++k)
    for (const std::size_t row : {plan.sobol().row_a(k), plan.sobol().row_b(k)}) {
      const auto& answer = answers[plan.morris().rows() + row];
      if (!answer) continue;
      sample.push_back(plan.values(plan.morris().rows() + row));
      sample.back().insert(sample.back().end(), {answer->hunts, answer->amplitude, answer->period});
    }
  return sample;
}

/// Base samples of the Sobol study and trajectories of the Morris study.
std::pair<int, int> sizes_of(const SensitivityFlags& flags, const ParameterSpread& spread) {
  const int samples = flags.samples > 0 ? flags.samples : spread.samples;
  return {samples, flags.trajectories > 0 ? flags.trajectories : std::clamp(samples / 10, 10, 100)};
}

/// The plan, and the answer of each of its loops, are in memory at the same time.
void need_memory_for(const SensitivityFlags& flags, const ParameterSpread& spread) {
  const auto sizes = sizes_of(flags, spread);
  const double samples = sizes.first, trajectories = sizes.second;
  const auto parameters = static_cast<double>(spread.parameters.size());
  const double rows = samples * (2.0 + parameters * (flags.second_order ? 2.0 : 1.0));
  const double bytes_a_row = sizeof(std::optional<HuntingAnswer>) + sizeof(std::optional<double>) + 4.0 * 8.0;
  const double bytes_a_sample = 16.0 * parameters + 2.0 * (40.0 + 8.0 * (3.0 + parameters));
  need_memory("--samples", samples, bytes_a_sample + bytes_a_row * rows / samples, "fewer samples");
  need_memory("--trajectories", trajectories, (parameters + 1.0) * (bytes_a_row + 8.0), "fewer trajectories");
}

Status look_everywhere(const Case& from, const Loop& loop, const SensitivityFlags& flags, SensitivityReport& report) {
  const auto [samples, trajectories] = sizes_of(flags, report.spread);
  const GlobalPlan plan(report.spread, static_cast<std::size_t>(trajectories), static_cast<std::size_t>(samples),
                        flags.second_order);
  const SweptRows swept = sweep_plan(from, loop, plan, flags);
  std::vector<std::optional<HuntingAnswer>> answers(plan.size());
  for (std::size_t k = 0; k < plan.size(); ++k)
    if (swept.known[k]) answers[k] = {swept.rows[3 * k], swept.rows[3 * k + 1], swept.rows[3 * k + 2]};
  if (std::ranges::none_of(swept.known, [](bool known) { return known; })) return swept.status;
  report.global = global_sensitivity(plan, answers, hunting_question(loop).accuracy);
  report.sample = fair_sample(plan, answers);
  return swept.status;
}

std::string flags_text(const SensitivityFlags& flags) {
  std::string text;
  if (flags.samples > 0) text += fmt::format(" --samples {}", flags.samples);
  if (flags.trajectories > 0) text += fmt::format(" --trajectories {}", flags.trajectories);
  if (flags.second_order) text += " --second-order";
  if (flags.local_only) text += " --local";
  for (const auto& path : flags.thresholds) text += " --threshold " + path;
  if (flags.factors != std::vector{0.5, 2.0}) text += fmt::format(" --factors {}", fmt::join(flags.factors, ","));
  if (flags.seed != 0) text += fmt::format(" --seed {}", flags.seed);
  return text.empty() ? text : text.substr(1);
}

SensitivityReport study(const Case& from, const Loop& loop, const SensitivityFlags& flags, Status& status) {
  SensitivityReport report;
  report.spread_is_default = !from.sensitivity;
  report.spread = from.sensitivity ? *from.sensitivity : default_spread(from);
  if (flags.seed != 0) report.spread.seed = flags.seed;
  if (!flags.local_only) need_memory_for(flags, report.spread);
  catch_interrupts();
  if (rank() == 0) {  // the other ranks take part in the sweep only
    Progress progress(flags.quiet, flags.verbose);
    progress.show(0.0, "the cycle and its neighbourhood");
    report.cycle = main_cycle(loop, from, report.notes);
    look_nearby(from, loop, flags, report);
  }
  status = ending_so_far();
  if (flags.local_only || interrupted()) return report;
  if (report.spread_is_default)
    report.notes.emplace_back("the case has no [sensitivity] section: each of its numbers varies uniformly by +-20 %");
  if (!report.spread.parameters.empty()) status = look_everywhere(from, loop, flags, report);
  return report;
}

int run(SensitivityFlags flags) {
  if (flags.html.empty() && flags.output.ends_with(".html")) flags.html = std::exchange(flags.output, {});
  for (const double factor : flags.factors)
    if (!std::isfinite(factor) || factor == 0.0) throw std::invalid_argument("--factors must be finite and not 0");
  const Case from = load_case(flags);
  threshold_numbers(from, flags.thresholds);  // reports errors before anything is computed
  need_loop(from);
  const Units units = units_of(from);
  const Loop loop = build_loop(need_loop(from));
  Output output(flags, &from);
  output.keep("the store", flags.store);
  output.check_file("--html", flags.html);
  Status status = Status::converged;
  const SensitivityReport report = study(from, loop, flags, status);
  auto made = provenance(flags, &from);
  made.isa = to_string(instruction_set(flags));
  const SensitivityReport shown = in_units(report, units);
  std::string text = sensitivity_text(from.title, shown, units);
  if (!flags.html.empty()) {
    output.file(flags.html, sensitivity_page(shown, made, from.text, units, flags_text(flags)));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, status) + text);
  if (output.wants_json()) output.json(sensitivity_json(made, report, status));
  if (output.wants_csv()) output.csv(sensitivity_csv(report));
  output.finish();
  tell_how_to_resume(flags, status);
  return status == Status::interrupted ? exit_no_answer : exit_done;
}

}  // namespace

void add_sensitivity(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SensitivityFlags>();
  CLI::App* command =
      add_command(program, action, "sensitivity",
                  "Sensitivity of the cycle to every number, and share of loops that hunt over a spread", true, flags,
                  [flags] { return run(*flags); });
  command->add_option("--samples", flags->samples, "Base samples of the Sobol study (default: of the case, or 256)")
      ->type_name("N")
      ->check(whole_in(1, 1 << 24));
  command->add_option("--trajectories", flags->trajectories, "Trajectories of the Morris study")
      ->type_name("N")
      ->check(whole_in(1, 1 << 20));
  command->add_flag("--second-order", flags->second_order, "Indices of pairs too: twice as many loops");
  command->add_option("--factors", flags->factors, "Factors on each number, one at a time")
      ->type_name("X,...")
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag("--local", flags->local_only, "Derivatives and one at a time only");
  command->add_option("--threshold", flags->thresholds, "Threshold of hunting in this number; repeatable")
      ->type_name("PATH")
      ->allow_extra_args(false);
  add_sweep_flags(*command, *flags);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace limcycle
