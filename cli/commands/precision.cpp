#include <CLI/CLI.hpp>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/precision_of.hpp"
#include "limcycle/models/friction/own_law.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/precision/atlas.hpp"
#include "limcycle/reports/precision/precision.hpp"

namespace limcycle {
namespace {

struct PrecisionFlags : CommonFlags {
  std::string html;           ///< --html
  std::string picture;        ///< --svg, of the atlas
  bool stability = false;     ///< --stability
  bool families = false;      ///< --families
  bool no_stiffness = false;  ///< --no-stiffness
};

/// A cycle without a verified reference, or no chart at all, is no answer. A loop that rests has no cycle to measure.
int exit_code(const PrecisionReport& report) {
  const auto answered = [](const auto& chart) { return chart && chart->answered; };
  if (report.status == Status::interrupted) return exit_no_answer;
  if (report.cycle && !answered(report.cycle_chart)) return exit_no_answer;
  return answered(report.cycle_chart) || answered(report.df_chart) ? exit_done : exit_no_answer;
}

PrecisionReport compute(const Case& from, const PrecisionFlags& flags) {
  Progress progress(flags.quiet, flags.verbose);
  PrecisionOptions options;
  options.cycle.predict = from.predict;
  options.cycle.predict.stop = options.work.stop = interrupted;
  options.stiffness = !flags.no_stiffness;
  options.threads = flags.threads;
  options.progress = [&](double fraction, std::string_view what) { progress.show(fraction, what); };
  catch_interrupts();
  return precision_of(from, options);
}

StepperAtlas compute_atlas(const Case& from, const PrecisionFlags& flags) {
  if (!from.loop || !from.loop->friction)
    throw std::invalid_argument("loop.friction: precision --stability needs a loop with [loop.friction]" +
                                std::string(from.loop && from.loop->diagram ? ", not a diagram" : ""));
  Progress progress(flags.quiet, flags.verbose);
  AtlasOptions options;
  options.predict = from.predict;
  options.threads = flags.threads;
  options.stop = interrupted;
  options.progress = [&](double fraction, std::string_view what) { progress.show(fraction, what); };
  catch_interrupts();
  return stepper_atlas(flags.families ? law_families(*from.loop) : own_law(*from.loop), options);
}

/// Chart of the failures of steppers, instead of their speed.
int run_atlas(const Case& from, const PrecisionFlags& flags) {
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  output.check_picture("--svg", flags.picture);
  const StepperAtlas atlas = compute_atlas(from, flags);
  const auto made = provenance(flags, &from);
  if (!flags.html.empty()) output.file(flags.html, atlas_page(atlas, made, from.text));
  if (!flags.picture.empty()) output.picture(flags.picture, atlas_picture(atlas));
  output.text(first_line(flags, atlas.status), atlas_document(from.title, atlas));
  if (output.wants_json()) output.json(atlas_json(made, atlas));
  if (output.wants_csv()) output.csv(atlas_csv(atlas));
  output.finish();
  tell_cut_short(flags, atlas.status);
  return atlas.points.empty() || atlas.status == Status::interrupted ? exit_no_answer : exit_done;
}

int run(PrecisionFlags flags) {
  take_picture(flags, flags.picture);
  flags.stability = flags.stability || flags.families;
  if (!flags.picture.empty() && !flags.stability)
    throw std::invalid_argument("--svg: precision has a picture with --stability only");
  take_page(flags, flags.html);
  const Case from = load_case(flags);
  if (flags.stability) return run_atlas(from, flags);
  Output output(flags, &from);
  output.check_page("--html", flags.html);
  const PrecisionReport report = compute(from, flags);
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  const PrecisionReport shown = in_units(report, units);
  Document text = precision_document(from.title, shown, units);
  if (!flags.html.empty()) {
    output.file(flags.html, precision_page(shown, made, from.text, units));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(precision_json(made, report));
  if (output.wants_csv()) output.csv(precision_csv(report));
  output.finish();
  tell_cut_short(flags, report.status);
  return exit_code(report);
}

void add_precision(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<PrecisionFlags>();
  flags->threads = 0;  // methods run in parallel; only their CPU times depend on it
  CLI::App* command = add_command(program, action, "precision", "Accuracy and cost of every method", true, flags,
                                  [flags] { return run(*flags); });
  command->add_flag("--no-stiffness", flags->no_stiffness, "Leave out the runs over the stiffness of the bristles");
  command->add_flag("--stability", flags->stability,
                    "Instead: where steppers fail, over stiffness and tolerance, for the case's law");
  command->add_flag("--families", flags->families, "The same for families of laws in its place");
  command->add_option("--svg", flags->picture, "Write the map of --stability to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command precision_command() {
  return {
      {"precision",
       trust_group,
       "Measures the accuracy and cost of every method on this case, against a verified reference. With --stability it "
       "shows instead where time steppers fail, over stiffness and tolerance.",
       {{"limcycle precision cases/relay-integrator.toml --no-stiffness", "methods for the cycle and its element"}}},
      add_precision};
}

}  // namespace limcycle
