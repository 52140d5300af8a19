#include <CLI/CLI.hpp>
#include <iostream>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

int run(CommonFlags flags) {
  // The result of a run is its samples: -o is where they go, the summary stays on stdout.
  if (flags.csv.empty()) flags.csv = std::exchange(flags.output, {});
  const Case from = load_case(flags);
  SimulateOptions options = need_simulate(from);
  Output output(flags);

  Simulation result;
  {
    Progress progress(flags.quiet);
    options.stop = interrupted;
    options.progress = [&](double fraction) { progress.show(fraction, "simulation"); };
    catch_interrupts();
    result = simulate(build_loop(*from.loop), options);
  }
  std::string text = simulate_text(from.title, result);
  if (!output.wants_csv() && !output.wants_json()) text += "\nThe samples: --csv FILE, --csv - or -o FILE.\n";
  output.text(text);
  if (output.wants_json()) output.json(simulate_json(provenance(flags, &from), result));
  if (output.wants_csv()) output.csv(simulate_csv(result));
  output.finish();
  if (result.status == Status::converged) return exit_done;
  if (!flags.quiet) std::cerr << "limcycle: " << (result.why.empty() ? to_string(result.status) : result.why) << '\n';
  return result.status == Status::interrupted && !result.rows.empty() ? exit_done : exit_no_answer;
}

}  // namespace

void add_simulate(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CommonFlags>();
  add_command(program, action, "simulate", "Time-domain run from a given state, as CSV", true, flags,
              [flags] { return run(*flags); });
}

}  // namespace limcycle
