#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/cli/help/description.hpp"
#include "limcycle/questions/asking/answer_of.hpp"
#include "limcycle/reports/provenance.hpp"

namespace CLI {
class App;
}

namespace limcycle {

/// Exit codes of the program.
enum ExitCode : int {
  exit_done = 0,       ///< whether or not a cycle exists
  exit_disagreed = 1,  ///< a claim or a required agreement failed
  exit_bad_input = 2,  ///< wrong usage or input (InputError, std::invalid_argument)
  exit_no_answer = 3   ///< no answer: undecided, interrupted, not written, or a defect of the program
};

/// Flags common to all subcommands.
struct CommonFlags {
  std::string case_file;
  std::vector<std::string> set;  ///< --set PATH=VALUE, in order
  std::string json, csv;         ///< file, "-" for stdout, empty: none
  std::string hdf5, tex;         ///< file, empty: none
  std::string output;            ///< -o: file for the output to stdout; empty: stdout
  std::uint64_t seed = 0;
  int threads = 1;
  std::string isa = "auto";
  std::string color = "auto";  ///< --color auto, always or never, for output to the terminal
  bool quiet = false;          ///< nothing on stderr except errors
  bool verbose = false;        ///< also details of the work, and on stderr its duration
  double time_limit = 0.0;     ///< --time-limit, s; 0: none
  bool has_tables = true;      ///< false: no --tex

  std::vector<std::string> given{};  ///< words of the command line that change its result: see Provenance::flags
};

/// The requested command; set while the command line is parsed, run afterwards. Returns the exit code.
using Action = std::function<int()>;

/// Declares subcommand `name` with the common flags; with `takes_case` also the positional CASE. Its own options are
/// added to the returned object. `run` becomes the action if the subcommand is chosen.
CLI::App* add_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                      bool takes_case, const std::shared_ptr<CommonFlags>& flags, Action run);

/// The same for a subcommand that has neither a case nor results: of the common flags only --output, --color, --quiet
/// and --verbose.
CLI::App* add_plain_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                            const std::shared_ptr<CommonFlags>& flags, Action run);

/// The case of the command line, read and validated. Throws InputError.
Case load_case(const CommonFlags& flags);

/// The instruction set named by --isa; "auto" is the widest that all ranks have. Throws std::invalid_argument if this
/// machine lacks it.
Isa instruction_set(const CommonFlags& flags);

/// Program (with the portable instruction set; commands whose kernels use another one set it), settings and input of a
/// result. `from`: the case, or null if the command has none.
Provenance provenance(const CommonFlags& flags, const Case* from = nullptr);

/// Error in the command line: `key` is the flag or word, with its value. Message: "KEY: RULE; SUGGESTION".
InputError refusal(const std::string& key, const std::string& rule, const std::string& suggestion = {});

/// A subcommand: its text for help and manual, and what declares it to the parser by one of the above.
struct Command {
  Description description;
  void (*add)(CLI::App& program, Action& action);
};

/// All subcommands, in the order in which a user needs them.
const std::vector<Command>& commands();

}  // namespace limcycle
