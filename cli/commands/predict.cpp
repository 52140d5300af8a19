#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/decided.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output/from_page.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/predict.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/figures/drawing/picture.hpp"
#include "limcycle/reports/html.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

struct PredictFlags : CommonFlags {
  std::string html;      ///< --html
  std::string pictures;  ///< --svg
  std::string from;      ///< --from
  bool require_agreement = false;
};

/// The ending of the -o file selects a page or a picture; the text then stays on stdout.
void sort_out(PredictFlags& flags) {
  take_page(flags, flags.html);
  take_picture(flags, flags.pictures);
}

int exit_code(const PredictReport& report, bool require_agreement) {
  const bool answered = report.status == Status::converged || report.status == Status::no_cycle;
  const bool by_user = report.status == Status::interrupted && !interrupted_by_time();
  if (report.status == Status::not_finite || by_user || !decided(report)) return exit_no_answer;
  if (!require_agreement) return exit_done;
  const auto any = [&](Verdict verdict) {
    return std::any_of(report.predictions.begin(), report.predictions.end(),
                       [&](const auto& one) { return one.verdict == verdict; });
  };
  // No method predicts a motion without a period, but perhaps the mean of one.
  const bool irregular =
      std::ranges::find(report.outcomes, Outcome::irregular, &OutcomeOfStart::outcome) != report.outcomes.end() &&
      std::ranges::none_of(report.predictions, [](const Prediction& one) { return one.motion.has_value(); });
  if (any(Verdict::wrong) || any(Verdict::biased) || !report.missed.empty() || irregular) return exit_disagreed;
  // An undecided verdict is no agreement.
  return any(Verdict::undecided) || !answered ? exit_no_answer : exit_done;
}

int run(PredictFlags flags) {
  sort_out(flags);
  const CaseWithPage loaded = load_case_or_page(flags, flags.from);
  const Case& from = loaded.from;
  need_loop(from);
  Output output(flags);
  output.keep_data(from);
  output.keep("the page to be made again", flags.from);
  output.check_page("--html", flags.html);
  output.check_picture("--svg", flags.pictures);

  PredictReport report;
  {
    Progress progress(flags.quiet, flags.verbose);
    const bool drawn = !flags.html.empty() || !flags.pictures.empty();
    report = answer_of([&] { return ask_predict(from, asking_of(flags, progress), drawn); });
  }
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  const PredictReport shown = in_units(report, units);
  Document text = predict_document(from.title, shown, units);
  if (flags.verbose) text += predict_efforts(shown, from.predict.methods, units);
  if (!flags.html.empty()) {
    output.file(flags.html, predict_page(shown, made, from.text, units));
    text += page_line(flags.html);
  }
  if (!flags.pictures.empty()) output.picture(flags.pictures, predict_picture(shown, units));
  output.text(first_line(flags, report.status), text);
  const std::string document = predict_json(made, report);
  if (output.wants_json()) output.json(document);
  if (output.wants_csv()) output.csv(predict_csv(report));
  output.finish();
  if (report.status != Status::interrupted) compare_with_page(flags, loaded, document);
  tell_cut_short(flags, report.status);
  return exit_code(report, flags.require_agreement);
}

void add_predict(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<PredictFlags>();
  flags->time_limit = 60.0;
  CLI::App* command = add_command(program, action, "predict",
                                  "Every limit cycle, predicted and checked in the time domain, with a verdict", true,
                                  flags, [flags] { return run(*flags); });
  add_from_flag(*command, flags->from);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
  command->add_option("--svg", flags->pictures, "Write a picture to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
  command->add_flag("--require-agreement", flags->require_agreement,
                    "Exit with 1 if a prediction is false or biased, or a limit cycle is missed");
}

}  // namespace

Command predict_command() {
  return {
      {"predict",
       hunt_group,
       "Searches for limit cycles by describing function, by the composite describing function (mass and friction as "
       "one element) and by harmonic balance. Simulates the loop from several states, verifies each cycle by shooting "
       "and determines its stability from its Floquet multipliers. Each prediction gets a verdict: confirmed (within 5 "
       "% of a cycle), biased, false or undecided; cycles that a method did not find are listed as missed.\n"
       "[search] sets the search box; [predict] sets the methods, the number of starts and the accuracy.",
       {{"limcycle predict cases/pid-lugre.toml", "the answer as text"},
        {"limcycle predict cases/pid-lugre.toml -o servo.html", "and as one page with figures"},
        {"limcycle predict cases/tutorial-servo.toml --set loop.friction.Fs=9.0 --verbose",
         "another break-away force, with the work of each method"},
        {"limcycle predict cases/relay-integrator.toml --require-agreement --json result.json",
         "for a script: exit code 1 if a method is wrong"}}},
      add_predict};
}

}  // namespace limcycle
