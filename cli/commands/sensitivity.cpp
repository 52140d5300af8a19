#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/ranks/ranks.hpp"
#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/sensitivity.hpp"
#include "limcycle/questions/threshold.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

struct SensitivityFlags : SweepFlags {
  SensitivityWishes wishes;
  std::string html;  ///< --html
};

SensitivityReport compute(const Case& from, SensitivityFlags& flags, Status& status) {
  std::optional<Progress> bar(std::in_place, flags.quiet || rank() > 0, flags.verbose);
  Asking asking = asking_of(flags, *bar);
  asking.progress = [&bar](double fraction, std::string_view what) {
    if (bar) bar->show(fraction, what);
  };
  need_memory_for(flags.wishes, spread_of(from, asking), "--");
  flags.wishes.nearby = rank() == 0;  // the other ranks take part in the sweep only
  const auto sweep = [&](const SweepTask& task, const auto& columns, const std::string& design) {
    bar.reset();  // the sweep has one of its own
    return run_stored(task, columns, design, flags, from);
  };
  return ask_sensitivity(from, flags.wishes, asking, sweep, status);
}

int run(SensitivityFlags flags) {
  take_page(flags, flags.html);
  for (const double factor : flags.wishes.factors)
    if (!std::isfinite(factor) || factor == 0.0) throw std::invalid_argument("--factors must be finite and not 0");
  const Case from = load_case(flags);
  threshold_numbers(from, "--threshold", flags.wishes.thresholds);  // reports errors before anything is computed
  need_loop(from);
  Output output(flags, &from);
  output.keep_store(flags.store);
  output.check_page("--html", flags.html);
  Status status = Status::converged;
  const SensitivityReport report = compute(from, flags, status);
  auto made = provenance(flags, &from);
  made.isa = to_string(instruction_set(flags));
  const Units units = units_of(from, largest_swing(report));
  const SensitivityReport shown = in_units(report, units);
  Document text = sensitivity_document(from.title, shown, units);
  if (!flags.html.empty()) {
    output.file(flags.html, sensitivity_page(shown, made, from.text, units, flags_of(flags.wishes, flags.seed)));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, status), text);
  if (output.wants_json()) output.json(sensitivity_json(made, report, status));
  if (output.wants_csv()) output.csv(sensitivity_csv(report));
  output.finish();
  tell_how_to_resume(flags, status);
  return status == Status::interrupted ? exit_no_answer : exit_done;
}

void add_sensitivity(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SensitivityFlags>();
  CLI::App* command =
      add_command(program, action, "sensitivity",
                  "Sensitivity of the cycle to every number, and share of loops that hunt over a spread", true, flags,
                  [flags] { return run(*flags); });
  command
      ->add_option("--samples", flags->wishes.samples, "Base samples of the Sobol study (default: of the case, or 256)")
      ->type_name("N")
      ->check(whole_in(1, 1 << 24));
  command->add_option("--trajectories", flags->wishes.trajectories, "Trajectories of the Morris study")
      ->type_name("N")
      ->check(whole_in(1, 1 << 20));
  command->add_flag("--second-order", flags->wishes.second_order, "Indices of pairs too: twice as many loops");
  command->add_option("--factors", flags->wishes.factors, "Factors on each number, one at a time")
      ->type_name("X,...")
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag("--local", flags->wishes.local_only, "Derivatives and one at a time only");
  command->add_option("--threshold", flags->wishes.thresholds, "Threshold of hunting in this number; repeatable")
      ->type_name("PATH")
      ->allow_extra_args(false);
  add_sweep_flags(*command, *flags);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command sensitivity_command() {
  return {
      {"sensitivity",
       change_group,
       "Computes the sensitivity of the period and amplitude of the cycle to every number: derivatives, changes one at "
       "a time, and, over the spread of [sensitivity], Morris and Sobol indices and the share of loops that hunt. "
       "Without that section every number varies uniformly by +-20 %.",
       {{"limcycle sensitivity cases/relay-third-order.toml --local", "derivatives and one at a time only"},
        {"limcycle sensitivity cases/relay-integrator.toml --samples 16 --trajectories 4",
         "a quick look at the rest"}}},
      add_sensitivity};
}

}  // namespace limcycle
