#include <CLI/CLI.hpp>
#include <sstream>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/margin.hpp"
#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/largest_swing.hpp"

namespace limcycle {
namespace {

struct MarginFlags : CommonFlags {
  std::string html;                     ///< --html
  double factor = 10.0;                 ///< --factor
  std::vector<std::string> parameters;  ///< --parameter PATH, repeatable; empty: all
  std::vector<std::string> toward;      ///< --toward NAME=VALUE,..., repeatable
};

int exit_code(const MarginReport& report) {
  const bool nothing = report.parameters.empty() && !report.balance;
  return !report.refused.empty() || report.status == Status::interrupted ||
                 (nothing && report.status != Status::converged)
             ? exit_no_answer
             : exit_done;
}

std::vector<Toward> directions(const std::vector<std::string>& written) {
  std::vector<Toward> all;
  for (const auto& text : written) {
    Toward& one = all.emplace_back();
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
      const auto equals = part.find('=');
      const auto value = equals == std::string::npos ? std::nullopt : finite_number(part.substr(equals + 1));
      if (!value) throw refusal("--toward " + text, "must be NAME=VALUE,... with numbers, such as kd=10,ki=2");
      one.emplace_back(part.substr(0, equals), *value);
    }
    if (one.empty()) throw refusal("--toward " + text, "must be NAME=VALUE,..., such as kd=10,ki=2");
  }
  return all;
}

int run(MarginFlags flags) {
  take_page(flags, flags.html);
  const Case from = load_case(flags);
  need_loop(from);
  const MarginWishes wishes{flags.parameters, directions(flags.toward), flags.factor, {"--parameter", "--toward"}};
  std::vector<std::string> notes;
  margin_parameters(from, wishes, notes);  // reports errors before anything is computed
  Output output(flags, &from);
  output.check_page("--html", flags.html);

  MarginReport report;
  {
    Progress progress(flags.quiet, flags.verbose);
    report = answer_of([&] { return ask_margin(from, wishes, asking_of(flags, progress)); });
  }
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  const MarginReport shown = in_units(report, units);
  Document text = margin_document(from.title, shown, units);
  if (!flags.html.empty()) {
    output.file(flags.html, margin_page(shown, made, from.text, units));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(margin_json(made, report));
  if (output.wants_csv()) output.csv(margin_csv(report));
  output.finish();
  tell_cut_short(flags, report.status);
  return exit_code(report);
}

void add_margin(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<MarginFlags>();
  CLI::App* command =
      add_command(program, action, "margin", "Distance of each parameter from the onset or end of hunting", true, flags,
                  [flags] { return run(*flags); });
  command->add_option("--factor", flags->factor, "Largest factor, up and down")
      ->type_name("X")
      ->check(number_in(1.01, 1000.0))
      ->capture_default_str();
  command->add_option("--parameter", flags->parameters, "Only this parameter; repeatable")
      ->type_name("PATH")
      ->allow_extra_args(false);
  command->add_option("--toward", flags->toward, "These numbers together, from their own values (1) to those (2)")
      ->type_name("NAME=VALUE,...")
      ->allow_extra_args(false);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command margin_command() {
  return {
      {"margin",
       change_group,
       "Varies each number of the case separately, up and down by a factor, until hunting begins or ends, and prints "
       "the margin; with --toward several numbers together. Where a cycle ends at a fold, the fold itself is located.",
       {{"limcycle margin cases/relay-third-order.toml", "every number that is not 0"},
        {"limcycle margin cases/tutorial-servo.toml --parameter loop.friction.Fs --factor 3", "one number only"},
        {"limcycle margin cases/tutorial-servo.toml --toward kd=300,kp=4000", "how far on the way to other gains"}}},
      add_margin};
}

}  // namespace limcycle
