#include <CLI/CLI.hpp>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/simulate.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

struct SimulateFlags : CommonFlags {
  bool no_check = false;  ///< --no-check
  bool no_audit = false;  ///< --no-audit
};

SimulateAnswer compute(const Case& from, const SimulateFlags& flags) {
  Progress progress(flags.quiet, flags.verbose);
  return ask_simulate(from, !flags.no_check, !flags.no_audit, asking_of(flags, progress));
}

int run(SimulateFlags flags) {
  // The result of a run is its samples: -o is their file, and the summary stays on stdout.
  if (flags.csv.empty()) flags.csv = std::exchange(flags.output, {});
  const Case from = load_case(flags);
  need_memory_for(from, {!flags.json.empty(), !flags.csv.empty()});
  Output output(flags, &from);
  const auto [result, second, energy] = compute(from, flags);
  const Units units = units_of(from, largest_swing(result));
  Document text = simulate_document(from.title, in_units(result, units), second, energy, units);
  if (!output.wants_csv() && !output.wants_json()) text += "\nThe samples: --csv FILE, --csv - or -o FILE.\n";
  output.text(first_line(flags, result.status), text);
  if (output.wants_json()) output.json(simulate_json(provenance(flags, &from), result, second, energy));
  if (output.wants_csv()) output.csv(simulate_csv(result));
  output.finish();
  if (second && !second->agrees) tell(flags, agreement_in_words(*second));
  for (const auto& note : result.notes) tell(flags, note);
  if (energy && !energy->balanced()) tell(flags, energy_in_words(*energy));
  if (result.status == Status::converged) return exit_done;
  if (result.status == Status::interrupted)
    tell_cut_short(flags, result.status);
  else
    tell(flags, result.why.empty() ? std::string(to_string(result.status)) : result.why);
  return exit_no_answer;
}

void add_simulate(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SimulateFlags>();
  CLI::App* command = add_command(program, action, "simulate", "Time-domain run from a given state, as CSV", true,
                                  flags, [flags] { return run(*flags); });
  command->add_flag("--no-check", flags->no_check, "Do not check the run by a second one at tighter tolerances");
  command->add_flag("--no-audit", flags->no_audit, "Do not compute the energy balance");
}

}  // namespace

Command simulate_command() {
  return {
      {"simulate",
       hunt_group,
       "Integrates the loop in time from the state and with the signals of [simulate], checks the run by a second one "
       "at other tolerances, and computes the energy balance. The samples go to the file of --csv (or -o), the summary "
       "to stdout.",
       {{"limcycle simulate cases/pid-lugre.toml -o run.csv", "time, state, input and force as columns"}}},
      add_simulate};
}

}  // namespace limcycle
