#include "limcycle/cli/command.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <stdexcept>
#include <tuple>

#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/ranks/ranks.hpp"
#include "limcycle/cli/time_limit.hpp"
#include "limcycle/questions/asking/provenance_of.hpp"

namespace limcycle {

namespace {

constexpr auto* common = "Options of every command";

/// Flags of every subcommand, for any kind of output.
void add_terminal_flags(CLI::App& command, CommonFlags& flags) {
  command.add_option("-o,--output", flags.output, "Write the text to FILE instead of stdout")
      ->type_name("FILE")
      ->group(common);
  command.add_option("--color", flags.color, "Colours; auto: on a terminal, but not with NO_COLOR")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("WHEN")
      ->capture_default_str()
      ->group(common);
  command.add_option("--time-limit", flags.time_limit, "Stop after S seconds and keep the results; 0: no limit")
      ->type_name("S")
      ->check(number_in(0.0, 1e9))
      ->capture_default_str()
      ->group(common);
  command.add_flag("--quiet", flags.quiet, "No progress bar and no messages but errors")->group(common);
  command.add_flag("--verbose", flags.verbose, "Print the work done, and its time on stderr")->group(common);
}

void add_result_flags(CLI::App& command, CommonFlags& flags) {
  command.add_option("--set", flags.set, "Replace a value of the case: PATH=VALUE, VALUE in TOML syntax; repeatable")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->group(common);
  for (const auto& [name, into, what] : {std::tuple("--json", &flags.json, "Write the JSON document to FILE"),
                                         std::tuple("--csv", &flags.csv, "Write the CSV document to FILE")})
    command.add_option(name, *into, what + std::string(", or to stdout alone with -"))
        ->type_name("FILE|-")
        ->group(common);
  if (flags.has_tables)
    command.add_option("--tex", flags.tex, "Write the tables as LaTeX to FILE (so does -o FILE.tex)")
        ->type_name("FILE")
        ->group(common);
  command.add_option("--hdf5", flags.hdf5, "Write the JSON document as HDF5 to FILE (so does -o FILE.h5)")
      ->type_name("FILE")
      ->group(common);
}

void add_computing_flags(CLI::App& command, CommonFlags& flags) {
  command.add_option("--seed", flags.seed, "Seed of everything random")
      ->type_name("N")
      ->check(zero_or_more())
      ->capture_default_str()
      ->group(common);
  command.add_option("--threads", flags.threads, "Threads; 0: one a core; results do not depend on it")
      ->type_name("N")
      ->check(whole_in(0, 1024))
      ->capture_default_str()
      ->group(common);
  std::vector<std::string> sets{"auto"};
  for (const Isa isa : all_isas()) sets.emplace_back(to_string(isa));
  command.add_option("--isa", flags.isa, "Instruction set of the kernels; auto: the widest that this machine has")
      ->check(CLI::IsMember(sets))
      ->type_name("NAME")
      ->capture_default_str()
      ->group(common);
}

/// Runs a command and, with --verbose, reports time and memory.
int timed(const CommonFlags& flags, const Action& run) {
  check_some_command_writes(flags.output);
  const auto begin = std::chrono::steady_clock::now();
  const TimeLimit limit(rank() == 0 ? flags.time_limit : 0.0);  // rank 0 ends the others
  const int code = run();
  if (!flags.verbose || flags.quiet || rank() > 0) return code;
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  std::cerr << fmt::format("limcycle: {:8.3f} s  in all; {:.3f} s of processors, {:.0f} MB of memory\n", passed,
                           seconds(used.ru_utime) + seconds(used.ru_stime),
                           static_cast<double>(used.ru_maxrss) / 1024.0);
  return code;
}

/// The flags that were given, without those that say where and how results are shown, or how fast they come.
std::vector<std::string> given_flags(const CLI::App& command) {
  constexpr std::array without{"set",   "output", "json",    "csv",     "hdf5",      "tex",   "html",
                               "svg",   "fit",    "fitted",  "apply",   "from",      "store", "resume",
                               "color", "quiet",  "verbose", "threads", "time-limit"};
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string name = option->get_lnames().front();
    if (std::ranges::find(without, name) != without.end()) continue;
    const bool takes_value = option->get_items_expected_max() > 0;
    for (const std::string& value : option->results()) {
      words.push_back("--" + name);
      if (takes_value) words.push_back(value);
    }
  }
  return words;
}

CLI::App* add_named(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                    const std::shared_ptr<CommonFlags>& flags, Action run) {
  CLI::App* command = program.add_subcommand(name, summary);
  command->callback([&action, flags, command, run = std::move(run)] {
    flags->given = given_flags(*command);
    action = [flags, run] { return timed(*flags, run); };
  });
  return command;
}

}  // namespace

CLI::App* add_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                      bool takes_case, const std::shared_ptr<CommonFlags>& flags, Action run) {
  CLI::App* command = add_named(program, action, name, summary, flags, std::move(run));
  if (takes_case) command->add_option("CASE", flags->case_file, "Case file (TOML)")->required()->type_name("FILE");
  add_result_flags(*command, *flags);
  add_computing_flags(*command, *flags);
  add_terminal_flags(*command, *flags);
  return command;
}

CLI::App* add_plain_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                            const std::shared_ptr<CommonFlags>& flags, Action run) {
  CLI::App* command = add_named(program, action, name, summary, flags, std::move(run));
  add_terminal_flags(*command, *flags);
  return command;
}

Case load_case(const CommonFlags& flags) { return load_case(flags.case_file, flags.set); }

Isa instruction_set(const CommonFlags& flags) {
  const Isa isa = flags.isa == "auto" ? isa_of_ranks() : isa_named(flags.isa).value();
  if (!is_available(isa)) throw std::invalid_argument("--isa: this machine has no " + flags.isa);
  return isa;
}

Provenance provenance(const CommonFlags& flags, const Case* from) {
  instruction_set(flags);  // every command rejects one that this machine lacks
  Provenance made = provenance_of(flags.seed, flags.threads, from);
  made.time_is_over = interrupted_by_time();
  made.flags = flags.given;
  return made;
}

InputError refusal(const std::string& key, const std::string& rule, const std::string& suggestion) {
  return InputError(
      {.file = {}, .line = 0, .override = {}, .key = key, .value = {}, .rule = rule, .suggestion = suggestion});
}

}  // namespace limcycle
