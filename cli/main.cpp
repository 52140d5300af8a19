#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>

#include "build_info.hpp"
#include "limcycle/cases/loader/text/input_error.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/help/help.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/colour.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/ranks/rank_job.hpp"
#include "limcycle/cli/ranks/rank_sweep.hpp"
#include "limcycle/cli/ranks/ranks.hpp"
#include "limcycle/reports/store/store.hpp"

namespace limcycle {
namespace {

std::string version_text() {
  return std::string("limcycle ") + build_info::version + " (" + build_info::commit + ", " + build_info::compiler +
         ", " + build_info::build_type + (built_for_ranks() ? ", MPI" : "") + ")";
}

/// Checks the word in the place of the command, which the parser would take for something else.
void check_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2) throw refusal({}, "a command is needed", "'limcycle --help' lists them");
  const std::string word = argv[1];
  if (word.starts_with('-')) return;
  std::vector<std::string> names;
  for (const auto* command : program.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::find(names, word) == names.end())
    throw refusal({}, "unknown command '" + word + "'", suggest(word, names));
}

/// Error for an argument unknown to the parser: a misspelt option or a second case.
InputError unexpected(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  const std::string command = chosen.empty() ? "" : chosen.front()->get_name() + ": ";
  const auto left = program.remaining(true);
  const std::string word = left.empty() ? std::string() : left.front();
  if (!word.starts_with('-') || chosen.empty()) return refusal({}, command + "unexpected argument '" + word + "'");
  std::vector<std::string> names;
  for (const auto* option : chosen.front()->get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return refusal({}, command + "unknown option '" + word + "'", suggest(word.substr(0, word.find('=')), names));
}

/// Prints to stdout, which may be a full disk or a closed pipe.
void print(std::string_view text) {
  errno = 0;
  if (!(std::cout << text << std::flush))
    throw OutputError(std::string("cannot write to stdout") +
                      (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

/// Prints the help of the chosen command, or of the program.
void help(const CLI::App& program, std::string_view colour) {
  const auto chosen = program.get_subcommands();
  std::string text;
  for (const auto& command : facts_of(program))
    if (!chosen.empty() && command.name == chosen.front()->get_name()) text = command_help(command);
  if (text.empty()) text = program_help(facts_of(program));
  print(colours_wanted(colour, STDOUT_FILENO) ? coloured(text) : text);
}

/// True if the command is one that several ranks share. All others run on rank 0 alone.
bool sweeps(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return !chosen.empty() && chosen.front()->get_option_no_throw("--store") != nullptr;
}

int run(int argc, char** argv) {
  CLI::App program{"Limit cycles of feedback loops with friction: predicted, and checked in the time domain",
                   "limcycle"};
  Action action;
  program.set_version_flag("--version", version_text(), "Print the version and exit");
  program.require_subcommand(1);
  for (const Command& command : commands()) command.add(program, action);
  for (auto* command : program.get_subcommands({})) {
    command->set_version_flag("--version", version_text(), "Print the version and exit");
    check_option_values(*command);
  }
  try {
    check_command(program, argc, argv);
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    help(program, colour_flag(argc, argv));
    return exit_done;
  } catch (const CLI::CallForVersion&) {
    print(version_text() + "\n");
    return exit_done;
  } catch (const CLI::ExtrasError&) {
    throw unexpected(program);
  } catch (const CLI::ParseError& error) {
    const auto chosen = program.get_subcommands();
    throw refusal({}, (chosen.empty() ? "" : chosen.front()->get_name() + ": ") + error.what());
  }
  return rank() == 0 || sweeps(program) ? action() : exit_done;
}

/// Joins the ranks and runs the part of this one.
Ending outcome(int argc, char** argv) {
  try {
    join_ranks();
    if (rank() > 0) {
      // Rank 0 alone writes to stdout, and a signal reaches all ranks.
      if (std::freopen("/dev/null", "w", stdout) == nullptr) throw std::runtime_error("cannot open /dev/null");
      catch_interrupts();
    }
    return {run(argc, argv), {}};
  } catch (const ShareDone&) {
    return {exit_done, {}};
  } catch (const InputError& error) {
    return {exit_bad_input, error.what()};
  } catch (const std::invalid_argument& error) {
    return {exit_bad_input, error.what()};
  } catch (const NoAnswer& error) {
    return {exit_no_answer, error.what()};
  } catch (const std::bad_alloc&) {
    return {exit_no_answer, "out of memory"};
  } catch (const StoreError& error) {
    return {error.kind() == StoreError::Kind::refused ? exit_bad_input : exit_no_answer, error.what()};
  } catch (const OutputError& error) {
    return {exit_no_answer, error.what()};
  } catch (const RankFailure& error) {
    return {error.code(), error.what()};
  } catch (const std::exception& error) {
    return {exit_no_answer, std::string("internal error: ") + error.what()};
  }
}

/// Terminate handler: some libraries allocate memory even to release some, and terminate when there is none left.
[[noreturn]] void end_without_memory() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    std::fputs("limcycle: out of memory\n", stderr);
    std::_Exit(exit_no_answer);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "limcycle: internal error: %s\n", error.what());
  } catch (...) {
    std::fputs("limcycle: internal error\n", stderr);
  }
  std::abort();
}

void complain(const Ending& ending, std::string_view colour) {
  if (rank() != 0 || ending.message.empty()) return;
  const std::string line = "limcycle: " + one_line(ending.message, 2000) + "\n";
  std::cerr << (colours_wanted(colour, STDERR_FILENO) ? coloured_complaint(line) : line) << std::flush;
}

}  // namespace
}  // namespace limcycle

int main(int argc, char** argv) {
  using namespace limcycle;
  std::set_terminate(end_without_memory);
  try {
    const Ending ending = outcome(argc, argv);
    complain(ending, colour_flag(argc, argv));
    const Ending of_others = end_ranks(ending);
    if (ending.message.empty()) complain(of_others, colour_flag(argc, argv));
    if (rank() > 0) return rank_count() > 1 ? exit_done : ending.code;
    return ending.code != exit_done ? ending.code : of_others.code;
  } catch (const std::exception& error) {  // this ending cannot be reported any more
    std::fprintf(stderr, "limcycle: internal error: %s\n", error.what());
    abort_ranks(exit_no_answer);
  }
}
