#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/questions/df.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

int run(const SweepFlags& flags) {
  const Case from = load_case(flags);
  const DfSection& section = need_df(from);
  need_memory_for(section, {!flags.json.empty(), !flags.csv.empty()});
  const auto points = section.points();
  Output output(flags);
  output.keep_data(from);
  output.keep_store(flags.store);

  Progress silent(true);  // the sweep shows its own
  const Asking asking = asking_of(flags, silent);
  const auto results = ask_df(from, section, asking, [&](const auto& task, const auto& columns, const auto& design) {
    return run_stored(task, columns, design, flags, from);
  });
  const Status ended = results.size() < points.size() ? ending_so_far() : Status::converged;
  output.text(first_line(flags, ended), df_document(from.title, points, results));
  Provenance made = provenance(flags, &from);
  made.isa = to_string(asking.isa);
  if (output.wants_json()) output.json(df_json(made, points, results));
  if (output.wants_csv()) output.csv(df_csv(points, results));
  output.finish();
  tell_how_to_resume(flags, ended);
  const bool answered = std::ranges::any_of(results, [](const auto& result) { return result.answered(); });
  return answered && ended != Status::interrupted ? exit_done : exit_no_answer;
}

void add_df(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SweepFlags>();
  CLI::App* command = add_command(program, action, "df", "Describing functions over amplitude x frequency x bias", true,
                                  flags, [flags] { return run(*flags); });
  add_sweep_flags(*command, *flags);
}

}  // namespace

Command df_command() {
  return {
      {"df",
       hunt_group,
       "Tabulates the describing function of the case's element over the amplitudes, frequencies and biases of [df], "
       "each value with an estimate of its error.",
       {{"limcycle df cases/df-lugre.toml --set df.frequency=[1.0] --csv df.csv", "one frequency, as a table"}}},
      add_df};
}

}  // namespace limcycle
