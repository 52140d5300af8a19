#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "limcycle/cases/loader/remedy_candidates.hpp"
#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/changed_case.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/remedy.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/remedy/remedy.hpp"

namespace limcycle {
namespace {

struct RemedyFlags : CommonFlags {
  std::string html;                  ///< --html
  std::string apply;                 ///< --apply NAME
  std::vector<std::string> only;     ///< --only NAME, repeatable; empty: all
  std::vector<std::string> weights;  ///< --weight COST=WEIGHT
  int samples = 32;                  ///< --samples
};

/// "noise_gain=2" as the index of the cost and its weight.
CostWeights weights_of(const std::vector<std::string>& written) {
  CostWeights weights{};
  for (const auto& one : written) {
    const auto equals = one.find('=');
    double& weight = weights[cost_named("--weight", one.substr(0, equals))];
    const auto value = equals == std::string::npos ? std::nullopt : finite_number(one.substr(equals + 1));
    if (!value || !(*value >= 0.0))
      throw refusal("--weight " + one, "must be COST=WEIGHT with a number of at least 0, such as noise_gain=2");
    weight = *value;
  }
  return weights;
}

/// The case file with the remedy of --apply.
std::string fixed_case(const Case& from, const RemedyReport& report, const std::string& name) {
  return changed_case(from, overrides_of_remedy(report, name), "limcycle remedy: " + name, name + ": ",
                      "the remedy is");
}

int exit_code(const RemedyReport& report) {
  return report.status == Status::interrupted || report.hunts == Hunts::undecided ? exit_no_answer : exit_done;
}

int run(RemedyFlags flags) {
  const std::string fixed = flags.apply.empty() ? "" : std::exchange(flags.output, {});
  if (!flags.apply.empty() && fixed.empty()) throw refusal("--apply " + flags.apply, "needs -o FILE for the case");
  take_page(flags, flags.html);
  const Case from = load_case(flags);
  need_loop(from);
  RemedyWishes wishes{flags.only, weights_of(flags.weights), static_cast<std::size_t>(flags.samples)};
  chosen_remedies(from, "--only", flags.only);  // reports errors before anything is computed
  if (!flags.apply.empty()) {
    chosen_remedies(from, "--apply", {flags.apply});
    if (std::ranges::find(wishes.only, flags.apply) == wishes.only.end()) {
      wishes.only.push_back(flags.apply);
      flags.given.insert(flags.given.end(), {"--only", flags.apply});  // what the page shows
    }
  }
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  output.check_case_file(fixed, from);

  RemedyReport report;
  {
    Progress progress(flags.quiet, flags.verbose);
    report = answer_of([&] { return ask_remedy(from, wishes, asking_of(flags, progress)); });
  }
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  Document text = remedy_document(from.title, report, units);
  if (!flags.html.empty()) {
    output.file(flags.html, remedy_page(report, made, from.text, units));
    text += page_line(flags.html);
  }
  std::string refused;
  if (!fixed.empty() && report.status == Status::interrupted) refused = not_written(fixed);
  if (!fixed.empty() && report.status != Status::interrupted) try {
      output.file(fixed, fixed_case(from, report, flags.apply));
      text += "\n" + fixed + " is written; confirm it: limcycle " +
              (flags.apply == "dither" ? "simulate " : "predict ") + fixed + "\n";
    } catch (const NoAnswer& none) {  // what was computed is shown nevertheless
      refused = none.what();
    }
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(remedy_json(made, report));
  if (output.wants_csv()) output.csv(remedy_csv(report));
  output.finish();
  tell_cut_short(flags, report.status);
  if (!refused.empty()) throw NoAnswer(refused);
  return exit_code(report);
}

void add_remedy(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<RemedyFlags>();
  CLI::App* command = add_command(program, action, "remedy", "Why the loop hunts, what ends it, and what that costs",
                                  true, flags, [flags] { return run(*flags); });
  command->add_option("--only", flags->only, "Try only this remedy; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--apply", flags->apply, "Try this remedy and write the case with it to the file of -o")
      ->type_name("NAME");
  command->add_option("--weight", flags->weights, "Sort by the weighted sum of costs; repeatable, such as noise_gain=2")
      ->type_name("COST=WEIGHT")
      ->allow_extra_args(false);
  command->add_option("--samples", flags->samples, "Samples of [sensitivity] for the robust share")
      ->type_name("N")
      ->check(whole_in(0, 100000))
      ->capture_default_str();
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command remedy_command() {
  return {
      {"remedy",
       change_group,
       "Finds why a loop hunts, by taking one feature away at a time, and tries the known remedies: for each the value "
       "nearest to the present at which no start hunts any more, confirmed by predictions on both sides, and what the "
       "loop then costs in error, speed, margins and noise. --apply writes the case with one of them.",
       {{"limcycle remedy cases/belt-squeal.toml --threads 2", "the cause, and all remedies"},
        {"limcycle remedy cases/over-compensated.toml --apply gain-kp -o fixed.toml", "the case with one remedy"}}},
      add_remedy};
}

}  // namespace limcycle
