#include <CLI/CLI.hpp>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/parameter_range.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/continue.hpp"
#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/largest_swing.hpp"

namespace limcycle {
namespace {

struct ContinueFlags : CommonFlags {
  std::string parameter;  ///< --parameter PATH=FROM:TO
  std::string html;       ///< --html
  std::string picture;    ///< --svg
};

int exit_code(const FollowReport& found) {
  const bool answered = found.status == Status::converged || found.status == Status::no_cycle;
  return found.status == Status::interrupted || (found.branches.empty() && !answered) ? exit_no_answer : exit_done;
}

int run(ContinueFlags flags) {
  take_page(flags, flags.html);
  take_picture(flags, flags.picture);
  const ParameterRange range = parameter_range("--parameter", flags.parameter);
  const Case from = load_case(flags);
  need_loop(from);
  const CaseNumber number = number_at(from, "--parameter", range.path);
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  output.check_picture("--svg", flags.picture);

  ContinueReport report{range.path, number.unit, {}};
  {
    Progress progress(flags.quiet, flags.verbose);
    report.found = ask_continue(from, number, range.from, range.to, asking_of(flags, progress));
  }
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  const ContinueReport shown = in_units(report, units);
  Document text = continue_document(from.title, shown, units);
  if (!flags.html.empty()) {
    output.file(flags.html, continue_page(shown, made, from.text, units));
    text += page_line(flags.html);
  }
  if (!flags.picture.empty()) output.picture(flags.picture, continue_picture(shown, units));
  output.text(first_line(flags, report.found.status), text);
  if (output.wants_json()) output.json(continue_json(made, report));
  if (output.wants_csv()) output.csv(continue_csv(report));
  output.finish();
  tell_cut_short(flags, report.found.status);
  return exit_code(report.found);
}

void add_continue(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<ContinueFlags>();
  CLI::App* command = add_command(program, action, "continue",
                                  "Follow the limit cycles over a parameter: folds, changes of stability, ends", true,
                                  flags, [flags] { return run(*flags); });
  command->add_option("--parameter", flags->parameter, "Parameter and its range, such as loop.controller.kd=1:50")
      ->type_name("PATH=FROM:TO")
      ->required();
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
  command
      ->add_option("--svg", flags->picture, "Write the bifurcation diagram to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
}

}  // namespace

Command continue_command() {
  return {
      {"continue",
       change_group,
       "Follows the limit cycles, stable and unstable, over a range of one number, around folds and to their ends. It "
       "prints the folds, the changes of stability and the ends, each with an error.",
       {{"limcycle continue cases/relay-third-order.toml --parameter loop.element.dead_zone=0.05:0.1",
         "to the fold at which the oscillation ends"}}},
      add_continue};
}

}  // namespace limcycle
