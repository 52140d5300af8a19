#include <CLI/CLI.hpp>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/identify.hpp"
#include "limcycle/reports/identify/identify.hpp"

namespace limcycle {
namespace {

struct IdentifyFlags : CommonFlags {
  bool plan = false;    ///< --plan
  std::string fitted;   ///< --fitted
  std::string picture;  ///< --svg
};

/// What the fitted case does not hold, and what it holds although it is not known.
void tell_of_fitted(const IdentifyFlags& flags, const Case& from, const IdentifiedLaw& law) {
  std::string left_out, open;
  for (const auto& one : from.overrides)
    if (!one.starts_with("identify.")) left_out += (left_out.empty() ? "" : ", ") + one;
  for (const auto& one : law.numbers)
    if (!one.identifiable) open += (open.empty() ? "" : ", ") + one.name;
  if (!left_out.empty()) tell(flags, "--set " + left_out + " is not in " + flags.fitted);
  if (!open.empty()) tell(flags, flags.fitted + " has values that the records do not determine: " + open);
}

int run(IdentifyFlags flags) {
  if (flags.fitted.empty() && flags.output.ends_with(".toml")) flags.fitted = std::exchange(flags.output, {});
  take_picture(flags, flags.picture);
  const Case from = load_case(flags);
  Output output(flags, &from);
  output.check_file("--fitted", flags.fitted);
  output.check_picture("--svg", flags.picture);
  if (from.identify)
    for (const auto& record : from.identify->records) output.keep("a record", record.path);

  IdentifyReport report;
  {
    Progress progress(flags.quiet, flags.verbose);
    report = ask_identify(from, flags.plan, asking_of(flags, progress));
  }
  const auto made = provenance(flags, &from);
  std::string fitted, no_fitted;
  try {
    if (!flags.fitted.empty()) fitted = fitted_text(from, report, flags.fitted == "-" ? from.file : flags.fitted);
  } catch (const NoAnswer& reason) {
    no_fitted = reason.what();
  }
  Document text = identify_document(from.title, report);
  if (!fitted.empty()) text += "\nThe case with the fitted law: " + flags.fitted + "\n";
  output.text(first_line(flags, report.status), text);
  if (output.wants_json()) output.json(identify_json(made, report));
  if (output.wants_csv()) output.csv(identify_csv(report));
  if (!flags.picture.empty()) output.picture(flags.picture, identify_picture(report));
  if (!fitted.empty()) output.file(flags.fitted, fitted);
  output.finish();
  tell_cut_short(flags, report.status);
  if (!no_fitted.empty()) throw NoAnswer(no_fitted);
  if (!fitted.empty()) tell_of_fitted(flags, from, report.laws[*report.chosen]);
  return report.chosen && report.status == Status::converged ? exit_done : exit_no_answer;
}

void add_identify(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<IdentifyFlags>();
  CLI::App* command = add_command(program, action, "identify", "Fit friction laws to measured records", true, flags,
                                  [flags] { return run(*flags); });
  command->add_option("--fitted", flags->fitted, "Write the case with the fitted law to FILE (so does -o FILE.toml)")
      ->type_name("FILE");
  command->add_flag("--plan", flags->plan, "Also print how far one more record of each kind would narrow each number");
  command
      ->add_option("--svg", flags->picture,
                   "Write measured and fitted forces to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
}

}  // namespace

Command identify_command() {
  return {
      {"identify",
       trust_group,
       "Fits the friction laws of [identify] to measured records: force against steady velocity, sliding with a "
       "varying "
       "velocity, small motions before sliding, break-away, or the free motion of the case's plant. It prints each "
       "number with its 95 % interval, names those "
       "that the records do not determine, and chooses the simplest law that the records support. -o FILE.toml writes "
       "the case with the fitted law, for `predict`, `sensitivity` and `report`; -o FILE.svg draws measured and fitted "
       "forces. --plan shows which further record would narrow which number most.",
       {{"limcycle identify cases/records/servo.toml -o fitted.toml",
         "fit three laws, and write the case with the best"},
        {"limcycle identify cases/records/carriage.toml", "the friction force was not measured, only the motion"},
        {"limcycle identify cases/records/servo.toml -o fit.svg", "measured and fitted forces as a picture"},
        {"limcycle identify cases/records/servo.toml --plan", "and what should be measured next"}}},
      add_identify};
}

}  // namespace limcycle
