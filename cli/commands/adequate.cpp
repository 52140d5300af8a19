#include <CLI/CLI.hpp>
#include <algorithm>
#include <span>

#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/largest_swing.hpp"

namespace limcycle {
namespace {

constexpr int starts_asked = 3;  ///< the largest displacement of interest, a tenth and a thousandth of it

struct AdequateFlags : CommonFlags {
  std::string html;         ///< --html
  double tolerance = 0.05;  ///< --tolerance
  double spread = 0.1;      ///< --spread
  bool own_spread = false;  ///< --spread was given, so that [sensitivity] is not used
};

/// The loop of a case with friction. Throws InputError if there is none.
const LoopParts& need_friction(const Case& from) {
  const LoopParts& parts = need_loop(from);
  if (parts.friction) return parts;
  throw InputError({.file = from.file,
                    .line = 0,
                    .override = {},
                    .key = "loop.friction",
                    .value = {},
                    .rule = parts.diagram
                                ? "is needed: `adequate` puts other laws in its place, and does not do so in a diagram"
                                : "is missing: `adequate` compares friction laws and needs one",
                    .suggestion = "`limcycle precision` compares methods on any loop"});
}

/// "friction.Fs = 1.4, controller.kd = 5"
std::string name_of(std::span<const std::pair<std::string, double>> values) {
  std::string name;
  for (const auto& [path, value] : values)
    name += (name.empty() ? "" : ", ") + path.substr(path.find('.') + 1) + " = " + with_digits(value, 4);
  return name;
}

/// The middle and some corners of the spread in [sensitivity]; `left_out`: those that are not valid cases.
void spread_of_case(const Case& from, AdequateOptions& options, std::vector<std::string>& left_out) {
  const auto points = corner_points(*from.sensitivity);
  options.spread_rule = "the middle and " + std::to_string(points.size() - 1) + " corners of [sensitivity]";
  options.spread = 0.0;
  std::vector<std::string> paths;
  for (const auto& parameter : from.sensitivity->parameters) paths.push_back(parameter.path);
  const LoopVariation variation(from, "[sensitivity]", paths);
  for (const auto& point : points) {
    std::vector<std::pair<std::string, double>> values;
    for (std::size_t i = 0; i < point.size(); ++i) values.emplace_back(from.sensitivity->parameters[i].path, point[i]);
    if (auto parts = variation.parts(point); parts && parts->friction)
      options.variations.push_back({name_of(values), std::move(*parts)});
    else
      left_out.push_back(name_of(values) + ": not a valid case, omitted");
  }
}

AdequateReport compute(const Case& from, const LoopParts& parts, const AdequateFlags& flags) {
  Progress progress(flags.quiet, flags.verbose);
  AdequateOptions options;
  options.tolerance = flags.tolerance;
  options.spread = flags.spread;
  options.threads = flags.threads;
  options.predict = from.predict;
  options.predict.starts = std::min(options.predict.starts, starts_asked);
  options.predict.stop = interrupted;
  options.progress = [&](double fraction, std::string_view what) { progress.show(fraction, what); };
  std::vector<std::string> left_out;
  if (from.sensitivity && !flags.own_spread) spread_of_case(from, options, left_out);
  catch_interrupts();
  AdequateReport report = answer_of([&] { return adequate(parts, options); });
  report.notes.insert(report.notes.end(), left_out.begin(), left_out.end());
  return report;
}

int run(AdequateFlags flags) {
  take_page(flags, flags.html);
  const Case from = load_case(flags);
  const LoopParts& parts = need_friction(from);
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  const AdequateReport report = compute(from, parts, flags);
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  const AdequateReport shown = in_units(report, units);
  Document text = adequate_document(from.title, shown, units);
  if (!flags.html.empty()) {
    output.file(flags.html, adequate_page(shown, made, from.text, units));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(adequate_json(made, report));
  if (output.wants_csv()) output.csv(adequate_csv(report));
  output.finish();
  tell_cut_short(flags, report.status);
  return report.status == Status::undefined || report.status == Status::interrupted ? exit_no_answer : exit_done;
}

void add_adequate(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<AdequateFlags>();
  flags->threads = 0;  // laws are compared in parallel; the results do not depend on it
  CLI::App* command =
      add_command(program, action, "adequate", "The simplest law and the cheapest method that are adequate", true,
                  flags, [flags] { return run(*flags); });
  command->add_option("--tolerance", flags->tolerance, "On period and amplitude, relative")
      ->type_name("X")
      ->check(number_in(1e-6, 1.0))
      ->capture_default_str();
  command
      ->add_option_function<double>(
          "--spread",
          [flags](double share) {
            flags->spread = share;
            flags->own_spread = true;
          },
          "Spread of each number of the law, in place of the case's [sensitivity] [0.1 without one]; 0: none")
      ->type_name("X")
      ->check(number_in(0.0, 0.9));
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command adequate_command() {
  return {{"adequate",
           trust_group,
           "Replaces the friction law by simpler ones fitted to it, and each method by cheaper ones, and prints the "
           "simplest law and the cheapest method whose answer stays within a tolerance.",
           {{"limcycle adequate cases/belt-coulomb.toml --spread 0 --tolerance 0.05", "for these numbers exactly"}}},
          add_adequate};
}

}  // namespace limcycle
