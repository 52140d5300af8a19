#include "limcycle/reports/store/status.hpp"

#include <CLI/CLI.hpp>
#include <chrono>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/output.hpp"

namespace limcycle {
namespace {

int show_status(const CommonFlags& flags, const std::string& file) {
  if (!flags.set.empty())
    throw InputError({.file = {},
                      .line = 0,
                      .override = {},
                      .key = "--set",
                      .value = {},
                      .rule = "cannot change what a store holds",
                      .suggestion = {}});
  if (file.empty()) throw refusal("STORE", "needs the name of a file, got none");
  const StoredSweep sweep = read_store(file);
  const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  Output output(flags);
  output.keep_store(file);
  output.text(status_text(file, sweep, now));
  if (output.wants_json()) output.json(status_json(provenance(flags), file, sweep));
  if (output.wants_csv()) output.csv(status_csv(sweep));
  output.finish();
  return exit_done;
}

void add_status(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CommonFlags>();
  flags->has_tables = false;
  const auto file = std::make_shared<std::string>();
  auto* command =
      add_command(program, action, "status", "Progress and results so far of a sweep with a store, also while it runs",
                  false, flags, [flags, file] { return show_status(*flags, *file); });
  command->add_option("STORE", *file, "The store (--store of the sweep)")->required()->type_name("FILE");
}

}  // namespace

Command status_command() {
  return {{"status",
           change_group,
           "Prints the progress, the speed and the results so far of a sweep with --store, also while it runs.",
           {{"limcycle status plane.db", "of the store that `map` or `sensitivity` wrote"}}},
          add_status};
}

}  // namespace limcycle
