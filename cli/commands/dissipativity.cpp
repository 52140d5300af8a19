#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/message.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/parameter_range.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/reports/dissipativity/dissipativity.hpp"

namespace limcycle {
namespace {

struct DissipativityFlags : CommonFlags {
  std::string html;       ///< --html
  std::string parameter;  ///< --parameter PATH=FROM:TO
  double speed = 0.0;     ///< --speed; 0: from the case
  double top_speed = 0.0;
};

/// The number of the element that a flag names, checked against the element.
PassivityRange range_of(const Case& from, const DissipativityFlags& flags) {
  const ParameterRange range = parameter_range("--parameter", flags.parameter);
  const std::string path = !from.loop ? from.element_path : subject_of(*from.loop).path;
  const auto refuse = [&](const std::string& rule) {
    return InputError({.file = {},
                       .line = 0,
                       .override = {},
                       .key = "--parameter " + flags.parameter,
                       .value = {},
                       .rule = rule,
                       .suggestion = {}});
  };
  if (!range.path.starts_with(path + ".")) throw refuse("must be a number of the element examined, " + path + ".KEY");
  if (!(range.from < range.to)) throw refuse("FROM must be less than TO");
  const std::string key = range.path.substr(path.size() + 1);
  try {
    family_of(df_element(from), key);
  } catch (const std::invalid_argument& no_such_number) {
    throw refuse(no_such_number.what());
  }
  return {key, range.from, range.to};
}

DissipativityReport compute(const Case& from, const DissipativityFlags& flags) {
  DissipativityOptions options;
  options.speed = flags.speed > 0.0 ? flags.speed : from.dissipativity.speed;
  options.passivity.top_speed = flags.top_speed > 0.0 ? flags.top_speed : from.dissipativity.top_speed;
  options.passivity.seed = flags.seed;
  options.predict = from.predict;
  if (!flags.parameter.empty()) options.range = range_of(from, flags);
  Progress progress(flags.quiet, flags.verbose);
  options.passivity.stop = interrupted;
  options.passivity.progress = [&](double fraction, std::string_view what) { progress.show(fraction, what); };
  catch_interrupts();
  if (!from.loop) return dissipativity(*from.element, from.element_path, options);
  const Subject subject = subject_of(*from.loop);
  if (subject.element == nullptr || subject.path == "loop.error")
    throw InputError(
        {.file = from.file,
         .line = 0,
         .override = {},
         .key = from.loop->diagram ? "diagram" : "loop.friction",
         .value = {},
         .rule = from.loop->diagram
                     ? "has several friction laws or elements: this command examines one"
                     : "is required by this command: the loop holds neither friction nor a forward element",
         .suggestion = {}});
  return dissipativity(*from.loop, options);
}

int run(DissipativityFlags flags) {
  if (flags.html.empty() && flags.output.ends_with(".html")) flags.html = std::exchange(flags.output, {});
  const Case from = load_case(flags);
  Output output(flags, &from);
  output.check_file("--html", flags.html);
  const DissipativityReport report = answer_of([&] { return compute(from, flags); });
  const auto made = provenance(flags, &from);
  std::string text = dissipativity_text(from.title, report);
  if (!flags.html.empty()) {
    std::string again = flags.parameter.empty() ? "" : "--parameter " + flags.parameter;
    if (flags.speed > 0.0) again += fmt::format(" --speed {}", flags.speed);
    if (flags.top_speed > 0.0) again += fmt::format(" --top-speed {}", flags.top_speed);
    output.file(flags.html, dissipativity_page(report, made, from.text, again));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, report.status) + text);
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

}  // namespace

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

}  // namespace limcycle
