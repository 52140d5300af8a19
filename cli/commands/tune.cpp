#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/changed_case.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/parameter_range.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/tune.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/tune/tune.hpp"

namespace limcycle {
namespace {

struct TuneFlags : CommonFlags {
  std::vector<std::string> vary;     ///< --vary NAME=LO:HI,...
  std::string until = "hunts=no";    ///< --until
  std::string minimise = "ms";       ///< --minimise
  std::vector<std::string> at_most;  ///< --at-most COST=VALUE
  double horizon = 0.0;              ///< --horizon; 0: not given
  double margin = 0.0;               ///< --margin, in per cent
  int samples = 64;                  ///< --samples
  bool apply = false;                ///< --apply
  std::string html, picture;         ///< --html, --svg
};

TuneCosts limits_of(const std::vector<std::string>& written) {
  TuneCosts limits{};
  for (const auto& one : written) {
    const auto equals = one.find('=');
    auto& limit = limits[static_cast<std::size_t>(tune_cost_named("--at-most", one.substr(0, equals)))];
    const auto value = equals == std::string::npos ? std::nullopt : finite_number(one.substr(equals + 1));
    if (!value || !(*value > 0.0))
      throw refusal("--at-most " + one, "must be COST=VALUE with a number above 0, such as ms=1.6");
    limit = *value;
  }
  return limits;
}

TuneWishes wishes_of(const TuneFlags& flags) {
  if (flags.until != "hunts=no")
    throw refusal("--until " + flags.until, "must be hunts=no: a loop that hunts is not tuned for anything else");
  TuneWishes wishes;
  wishes.names = {"--vary", "--minimise", "--at-most", "--horizon S"};
  for (const auto& text : flags.vary) {
    const ParameterRange range = parameter_range("--vary", text);
    wishes.vary.push_back({range.path, range.from, range.to});
  }
  wishes.minimised = tune_cost_named("--minimise", flags.minimise);
  wishes.limits = limits_of(flags.at_most);
  wishes.horizon = flags.horizon;
  wishes.margin = 0.01 * flags.margin;
  wishes.samples = static_cast<std::size_t>(flags.samples);
  return wishes;
}

/// The case file with the numbers that were found.
std::string tuned_case(const Case& from, const TuneReport& report) {
  return changed_case(from, overrides_of_tuning(report), "limcycle tune", "", "the numbers are");
}

int run(TuneFlags flags) {
  const std::string tuned = flags.apply ? std::exchange(flags.output, {}) : "";
  if (flags.apply && tuned.empty()) throw refusal("--apply", "needs -o FILE for the case");
  take_page(flags, flags.html);
  take_picture(flags, flags.picture);
  const Case from = load_case(flags);
  const TuneWishes wishes = wishes_of(flags);
  tune_numbers(from, wishes);  // reports errors before anything is computed
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  output.check_picture("--svg", flags.picture);
  output.check_case_file(tuned, from);

  TuneReport report;
  {
    Progress progress(flags.quiet, flags.verbose);
    report = answer_of([&] { return ask_tune(from, wishes, asking_of(flags, progress)); });
  }
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  Document text = tune_document(from.title, report, units);
  if (!flags.html.empty()) {
    output.file(flags.html, tune_page(report, made, from.text, units, flags_of(wishes, flags.seed)));
    text += page_line(flags.html);
  }
  if (!flags.picture.empty()) output.picture(flags.picture, tune_picture(report, units));
  std::string refused;
  if (!tuned.empty() && report.status == Status::interrupted) refused = not_written(tuned);
  if (!tuned.empty() && report.status != Status::interrupted) try {
      output.file(tuned, tuned_case(from, report));
      text += "\n" + tuned + " is written; confirm it: limcycle predict " + tuned + "\n";
    } catch (const NoAnswer& none) {  // what was computed is shown nevertheless
      refused = none.what();
    }
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(tune_json(made, report));
  if (output.wants_csv()) output.csv(tune_csv(report));
  output.finish();
  tell_cut_short(flags, report.status);
  if (!refused.empty()) throw NoAnswer(refused);
  return report.best && report.status != Status::interrupted ? exit_done : exit_no_answer;
}

void add_tune(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<TuneFlags>();
  CLI::App* command =
      add_command(program, action, "tune", "Numbers with the least cost for which the loop does not hunt", true, flags,
                  [flags] { return run(*flags); });
  command->add_option("--vary", flags->vary, "Numbers to choose, with their bounds; a list, such as kp=1:100,ki=0:10")
      ->type_name("NAME=LO:HI,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->required();
  command->add_option("--until", flags->until, "What must hold of every start")
      ->type_name("CONDITION")
      ->capture_default_str();
  command
      ->add_option("--minimise", flags->minimise,
                   "Cost to make least: ms, settling (s) or ise, the integral of the squared error")
      ->type_name("COST")
      ->capture_default_str();
  command->add_option("--at-most", flags->at_most, "Limit of a cost; repeatable, such as ms=1.6")
      ->type_name("COST=VALUE")
      ->allow_extra_args(false);
  command->add_option("--horizon", flags->horizon, "Time of the integral of ise; default: the duration of [simulate]")
      ->type_name("S")
      ->check(more_than_zero());
  command->add_option("--margin", flags->margin, "Per cent by which each number may change without hunting")
      ->type_name("X")
      ->check(number_in(0.0, 50.0))
      ->capture_default_str();
  command->add_option("--samples", flags->samples, "Points of the global search")
      ->type_name("N")
      ->check(whole_in(1, 100000))
      ->capture_default_str();
  command->add_flag("--apply", flags->apply, "Write the case with the numbers that were found to the file of -o");
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
  command->add_option("--svg", flags->picture, "Write the map of the search to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
}

}  // namespace

Command tune_command() {
  return {
      {"tune",
       change_group,
       "Chooses numbers within bounds so that the loop does not hunt and a cost is least: the peak sensitivity Ms of "
       "the "
       "linear loop, or the settling time or the integral of the squared error of the loop with its friction after a "
       "step. Points that fill the bounds are tried, then searches from the best ones that lie apart. States whether "
       "these agree, and what lies next to the result. A name such as kp stands for the only number with that name. "
       "--apply writes the case with the numbers that were found.",
       {{"limcycle tune cases/pid-lugre.toml --vary kp=1:20,ki=0:5 --minimise ms --threads 2",
         "gains that do not hunt"},
        {"limcycle tune cases/over-compensated.toml --vary kp=1:100 --minimise settling --samples 8 --apply -o "
         "tuned.toml",
         "the fastest, as a case"}}},
      add_tune};
}

}  // namespace limcycle
