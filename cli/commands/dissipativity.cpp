#include <CLI/CLI.hpp>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/parameter_range.hpp"
#include "limcycle/questions/dissipativity.hpp"
#include "limcycle/reports/dissipativity/dissipativity.hpp"

namespace limcycle {
namespace {

struct DissipativityFlags : CommonFlags {
  std::string html;       ///< --html
  std::string parameter;  ///< --parameter PATH=FROM:TO
  double speed = 0.0;     ///< --speed; 0: from the case
  double top_speed = 0.0;
};

DissipativityWishes wishes_of(const DissipativityFlags& flags) {
  DissipativityWishes wishes{flags.speed, flags.top_speed, {}, 0.0, 0.0, "--parameter"};
  if (!flags.parameter.empty()) {
    const ParameterRange range = parameter_range("--parameter", flags.parameter);
    wishes.path = range.path;
    wishes.from = range.from;
    wishes.to = range.to;
  }
  return wishes;
}

int run(DissipativityFlags flags) {
  take_page(flags, flags.html);
  const Case from = load_case(flags);
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  const DissipativityWishes wishes = wishes_of(flags);
  DissipativityReport report;
  {
    Progress progress(flags.quiet, flags.verbose);
    report = answer_of([&] { return ask_dissipativity(from, wishes, asking_of(flags, progress)); });
  }
  const auto made = provenance(flags, &from);
  Document text = dissipativity_document(from.title, report);
  if (!flags.html.empty()) {
    output.file(flags.html, dissipativity_page(report, made, from.text, flags_of(wishes)));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(dissipativity_json(made, report));
  if (output.wants_csv()) output.csv(dissipativity_csv(report));
  output.finish();
  tell_cut_short(flags, report.status);
  if (report.agrees == false) {
    tell(flags, "a cycle was found although energy excludes it: please report this");
    return exit_disagreed;
  }
  return report.status == Status::interrupted ? exit_no_answer : exit_done;
}

void add_dissipativity(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<DissipativityFlags>();
  CLI::App* command = add_command(program, action, "dissipativity",
                                  "Boundedness, passivity and storage of a law, with a counter-example where it fails",
                                  true, flags, [flags] { return run(*flags); });
  command->add_option("--speed", flags->speed, "Speed up to which the force is bounded, m/s (default: of the case, 1)")
      ->type_name("V")
      ->check(more_than_zero());
  command->add_option("--top-speed", flags->top_speed, "Largest speed of the motions that may take energy out, m/s")
      ->type_name("V")
      ->check(more_than_zero());
  command->add_option("--parameter", flags->parameter, "Find the values of this number at which passivity changes")
      ->type_name("PATH=FROM:TO");
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command dissipativity_command() {
  return {{"dissipativity",
           trust_group,
           "Determines for the law (not the loop) whether its state and force stay bounded, whether it is passive, how "
           "much energy can be extracted, and the least viscous friction that makes it passive. For a law that is not "
           "passive it gives a counter-example: a motion that extracts energy.",
           {{"limcycle dissipativity cases/pid-lugre.toml", "of the friction of this case"}}},
          add_dissipativity};
}

}  // namespace limcycle
