#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/cli/units_of.hpp"
#include "limcycle/reports/adequate.hpp"

namespace limcycle {
namespace {

struct AdequateFlags : CommonFlags {
  std::string html;         ///< --html
  double tolerance = 0.05;  ///< --tolerance
  double spread = 0.1;      ///< --spread
};

/// The loop of a case with friction. Throws InputError where there is none.
const LoopParts& need_friction(const Case& from) {
  const LoopParts& parts = need_loop(from);
  if (parts.friction) return parts;
  throw InputError({.file = from.file,
                    .line = 0,
                    .override = {},
                    .key = "loop.friction",
                    .value = {},
                    .rule = "is missing: `adequate` asks which friction law is enough, so there is nothing to ask",
                    .suggestion = "`limcycle precision` compares methods on any loop"});
}

AdequateReport compute(const Case& from, const LoopParts& parts, const AdequateFlags& flags) {
  Progress progress(flags.quiet);
  AdequateOptions options;
  options.tolerance = flags.tolerance;
  options.spread = flags.spread;
  options.predict = from.predict;
  options.predict.starts = std::min(options.predict.starts, 2);
  options.predict.stop = interrupted;
  options.progress = [&](double fraction, std::string_view what) { progress.show(fraction, what); };
  catch_interrupts();
  return adequate(parts, options);
}

int run(AdequateFlags flags) {
  if (flags.html.empty() && flags.output.ends_with(".html")) flags.html = std::exchange(flags.output, {});
  const Case from = load_case(flags);
  const LoopParts& parts = need_friction(from);
  const Units units = units_of(parts);
  Output output(flags);
  output.check_file("--html", flags.html);
  const AdequateReport report = compute(from, parts, flags);
  const auto made = provenance(flags, &from);
  std::string text = adequate_text(from.title, report, units);
  if (!flags.html.empty()) {
    output.file(flags.html, adequate_page(report, made, from.text, units));
    text += "\nreport: " + flags.html + "\n";
  }
  output.text(text);
  if (output.wants_json()) output.json(adequate_json(made, report));
  if (output.wants_csv()) output.csv(adequate_csv(report));
  output.finish();
  if (report.status == Status::interrupted && !flags.quiet)
    std::cerr << "limcycle: interrupted; what was computed until then is written\n";
  return report.status == Status::undefined ? exit_no_answer : exit_done;
}

}  // namespace

void add_adequate(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<AdequateFlags>();
  CLI::App* command = add_command(program, action, "adequate", "The least law and the cheapest method that are enough",
                                  true, flags, [flags] { return run(*flags); });
  command->add_option("--tolerance", flags->tolerance, "On period and amplitude, relative")
      ->type_name("X")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  command->add_option("--spread", flags->spread, "By how much each number of the law may be off; 0: not at all")
      ->type_name("X")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace limcycle
