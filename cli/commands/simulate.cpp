#include <CLI/CLI.hpp>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/message.hpp"
#include "limcycle/cli/need_memory.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/cli/units_of.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

struct SimulateFlags : CommonFlags {
  bool no_check = false;  ///< --no-check
  bool no_audit = false;  ///< --no-audit
};

/// The run, its energy balance, and its comparison with a second run at other tolerances, if wanted and time allowed.
struct Answered {
  Simulation run;
  std::optional<Agreement> second;
  std::optional<EnergyBalance> energy;
};

/// The samples, and documents of them, are in memory at the same time.
void need_memory_for(const Case& from, const SimulateFlags& flags) {
  const SimulateOptions& options = need_simulate(from);
  if (options.sample == 0.0) return;
  const double numbers = 2.0 + static_cast<double>(build_loop(*from.loop).states());
  const double bytes_a_number = 8.0 + (flags.json.empty() ? 0.0 : 150.0) + (flags.csv.empty() ? 0.0 : 12.0);
  need_memory("simulate.sample", options.duration / options.sample, 40.0 + numbers * bytes_a_number, "fewer samples");
}

Answered compute(const Case& from, const SimulateFlags& flags) {
  Progress progress(flags.quiet, flags.verbose);
  const Loop loop = build_loop(*from.loop);
  SimulateOptions options = need_simulate(from);
  const double share = flags.no_check ? 1.0 : 0.4;
  options.stop = interrupted;
  options.progress = [&](double fraction) { progress.show(share * fraction, "simulation"); };
  catch_interrupts();
  std::optional<EnergyAudit> audit;
  if (!flags.no_audit && has_energy(*from.loop)) {
    audit.emplace(*from.loop, loop, options.rtol);
    options.watch = [&](LoopField& field, March& march, const std::vector<Mode>& modes) {
      audit->step(field, march, modes);
    };
  }
  Answered result{simulate(loop, options), {}, {}};
  if (audit) result.energy = audit->balance();
  options.watch = {};
  if (flags.no_check || result.run.status != Status::converged) return result;
  options.progress = [&](double fraction) { progress.show(share + (1.0 - share) * fraction, "at other tolerances"); };
  const Agreement second = agreement(loop, options, result.run);
  if (second.status != Status::interrupted) result.second = second;
  return result;
}

int run(SimulateFlags flags) {
  // The result of a run is its samples: -o is their file, and the summary stays on stdout.
  if (flags.csv.empty()) flags.csv = std::exchange(flags.output, {});
  const Case from = load_case(flags);
  need_memory_for(from, flags);
  Output output(flags, &from);
  const auto [result, second, energy] = compute(from, flags);
  const Units units = units_of(from);
  std::string text = simulate_text(from.title, in_units(result, units), second, energy, units);
  if (!output.wants_csv() && !output.wants_json()) text += "\nThe samples: --csv FILE, --csv - or -o FILE.\n";
  output.text(first_line(flags, result.status) + text);
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

}  // namespace

void add_simulate(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SimulateFlags>();
  CLI::App* command = add_command(program, action, "simulate", "Time-domain run from a given state, as CSV", true,
                                  flags, [flags] { return run(*flags); });
  command->add_flag("--no-check", flags->no_check, "Do not check the run by a second one at tighter tolerances");
  command->add_flag("--no-audit", flags->no_audit, "Do not compute the energy balance");
}

}  // namespace limcycle
