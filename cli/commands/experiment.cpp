#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/reports/experiments/experiment.hpp"

namespace limcycle {
namespace {

struct ExperimentFlags : CommonFlags {
  std::string name;               ///< NAME; empty: list them
  std::vector<std::string> laws;  ///< --law KIND, repeatable; empty: all
  std::string html;               ///< --html
  std::string pictures;           ///< --svg
};

/// The experiments of that name: one, or all.
std::vector<ExperimentEntry> chosen(const std::string& name) {
  if (name == "all") return experiments();
  std::vector<std::string> names{"all"};
  for (const auto& entry : experiments()) {
    if (entry.name == name) return {entry};
    names.emplace_back(entry.name);
  }
  throw refusal("experiment", "unknown experiment '" + name + "'", suggest(name, names));
}

/// The settings of those kinds, or with those labels.
std::vector<LawSetting> laws_of(const std::vector<std::string>& wanted) {
  if (wanted.empty()) return law_settings();
  std::vector<LawSetting> laws;
  for (const auto& word : wanted) {
    std::vector<std::string> names;
    bool found = false;
    for (const auto& setting : law_settings()) {
      if (!is_friction_kind(setting.kind)) continue;
      names.push_back(setting.label);
      if (setting.kind != word && setting.label != word) continue;
      found = true;
      if (std::ranges::find(laws, setting.label, &LawSetting::label) == laws.end()) laws.push_back(setting);
    }
    if (!found) throw refusal("--law", "unknown friction law '" + word + "'", suggest(word, names));
  }
  return laws;
}

int list(const ExperimentFlags& flags) {
  Output output(flags);
  output.refuse_tables();
  output.text(experiment_list(experiments()));
  if (output.wants_json()) output.json(experiment_list_json(provenance(flags), experiments()));
  if (output.wants_csv()) output.csv(experiment_csv({}));
  output.finish();
  return exit_done;
}

std::vector<Experiment> run_all(const std::vector<ExperimentEntry>& entries, const ExperimentFlags& flags) {
  Progress progress(flags.quiet, flags.verbose);
  ExperimentOptions options;
  options.laws = laws_of(flags.laws);
  options.threads = flags.threads;
  options.stop = interrupted;
  catch_interrupts();
  std::vector<Experiment> results;
  for (std::size_t i = 0; i < entries.size() && !interrupted(); ++i) {
    options.progress = [&, i](double share, std::string_view what) {
      progress.show((static_cast<double>(i) + share) / static_cast<double>(entries.size()), what);
    };
    results.push_back(entries[i].run(options));
  }
  return results;
}

/// Status of the command; a signal after the last experiment has no effect.
Status ending(const std::vector<Experiment>& results, std::size_t wanted) {
  const bool all = results.size() == wanted &&
                   std::ranges::none_of(results, [](const auto& one) { return one.status == Status::interrupted; });
  return all ? Status::converged : ending_so_far();
}

int run(ExperimentFlags flags) {
  if (!flags.set.empty()) throw refusal("--set", "experiments have no case; --law chooses laws");
  if (flags.name.empty()) return list(flags);
  take_page(flags, flags.html);
  take_picture(flags, flags.pictures);
  const auto entries = chosen(flags.name);
  laws_of(flags.laws);
  Output output(flags);
  output.check_page("--html", flags.html);
  output.check_picture("--svg", flags.pictures);
  const auto results = run_all(entries, flags);
  const Status ended = ending(results, entries.size());
  const auto made = provenance(flags);
  Document text = experiment_document(results);
  if (!flags.html.empty() && !results.empty()) {
    std::string words;
    for (const auto& law : flags.laws) words += (words.empty() ? "--law " : " --law ") + law;
    output.file(flags.html, experiment_page(results, made, words));
    text += page_line(flags.html);
  }
  if (!flags.pictures.empty()) output.picture(flags.pictures, experiment_picture(results));
  output.text(first_line(flags, ended), text);
  if (output.wants_json()) output.json(experiment_json(made, results, ended));
  if (output.wants_csv()) output.csv(experiment_csv(results));
  output.finish();
  tell_cut_short(flags, ended);
  return results.empty() || ended == Status::interrupted ? exit_no_answer : exit_done;
}

void add_experiment(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<ExperimentFlags>();
  flags->threads = 0;  // laws run in parallel; the results do not depend on it
  CLI::App* command =
      add_command(program, action, "experiment", "The experiments of the source documents, all laws side by side",
                  false, flags, [flags] { return run(*flags); });
  command->add_option("NAME", flags->name, "One of them, or all; without it they are listed")->type_name("NAME");
  command->add_option("--law", flags->laws, "Only this law; repeatable")->type_name("KIND")->allow_extra_args(false);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
  command->add_option("--svg", flags->pictures, "Write the figures to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
}

}  // namespace

Command experiment_command() {
  return {
      {"experiment",
       evidence_group,
       "Runs the experiments of the source documents for all friction laws side by side. Without NAME it lists them; "
       "`all` runs all of them.",
       {{"limcycle experiment", "the list"},
        {"limcycle experiment pre-sliding --law lugre --law dahl -o loops.svg", "one, for two laws, as a picture"}}},
      add_experiment};
}

}  // namespace limcycle
