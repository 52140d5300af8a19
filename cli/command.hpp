#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/cases/case.hpp"
#include "limcycle/reports/provenance.hpp"

namespace CLI {
class App;
}

namespace limcycle {

/// How the program ends.
enum ExitCode : int {
  exit_done = 0,       ///< whether or not a cycle exists
  exit_disagreed = 1,  ///< a claim or a required agreement failed
  exit_bad_input = 2,  ///< wrong usage or input (InputError, std::invalid_argument)
  exit_no_answer = 3   ///< not answered: undecided, cut short, not written, or a defect of the program
};

/// What every subcommand understands.
struct CommonFlags {
  std::string case_file;
  std::vector<std::string> set;  ///< --set PATH=VALUE, in order
  std::string json, csv;         ///< file, "-" for stdout, empty: not wanted
  std::string output;            ///< -o: file for what would go to stdout; empty: stdout
  std::uint64_t seed = 0;
  int threads = 1;
  std::string isa = "auto";
  std::string color = "auto";  ///< --color auto, always or never, of what goes to the terminal
  bool quiet = false;          ///< nothing on stderr but errors
  bool verbose = false;        ///< also what was done, and on stderr how long it took
  double time_limit = 0.0;     ///< --time-limit, s; 0: none
};

/// What the command line asked for; set while it is parsed, run afterwards. The result is the exit code.
using Action = std::function<int()>;

/// Declares subcommand `name` with the common flags; with `takes_case` also the positional CASE. Options of its own are
/// added to what is returned. `run` becomes the action when the subcommand is chosen. What help and manual page say of
/// it at length stands in descriptions.cpp.
CLI::App* add_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                      bool takes_case, const std::shared_ptr<CommonFlags>& flags, Action run);

/// The same for a subcommand that has neither a case nor results: of the common flags only --output, --color, --quiet
/// and --verbose.
CLI::App* add_plain_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                            const std::shared_ptr<CommonFlags>& flags, Action run);

/// The case of the command line, read and validated. Throws InputError.
Case load_case(const CommonFlags& flags);

/// The instruction set that --isa names; "auto" is the widest that all ranks have. Throws std::invalid_argument if this
/// machine lacks it.
Isa instruction_set(const CommonFlags& flags);

/// Who made a result (with the portable instruction set: a command whose kernels use another says so), with which
/// settings, from what. `from`: the case, or null if the command has none.
Provenance provenance(const CommonFlags& flags, const Case* from = nullptr);

/// What is wrong with the command line: `key` is the flag or word, with its value. Message: "KEY: RULE; SUGGESTION".
InputError refusal(const std::string& key, const std::string& rule, const std::string& suggestion = {});

// Subcommands, one file each. A new one is its file, a line here and a line in the list in main.cpp.
void add_adequate(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_claims(CLI::App& program, Action& action);
void add_completion(CLI::App& program, Action& action);
void add_continue(CLI::App& program, Action& action);
void add_dissipativity(CLI::App& program, Action& action);
void add_df(CLI::App& program, Action& action);
void add_experiment(CLI::App& program, Action& action);
void add_laws(CLI::App& program, Action& action);
void add_map(CLI::App& program, Action& action);
void add_manual(CLI::App& program, Action& action);
void add_margin(CLI::App& program, Action& action);
void add_new(CLI::App& program, Action& action);
void add_precision(CLI::App& program, Action& action);
void add_predict(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_sensitivity(CLI::App& program, Action& action);
void add_simulate(CLI::App& program, Action& action);
void add_status(CLI::App& program, Action& action);

}  // namespace limcycle
