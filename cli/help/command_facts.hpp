#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/help/description.hpp"

namespace CLI {
class App;
}

namespace limcycle {

/// One option or argument of a command, in words.
struct OptionFacts {
  std::string name;                  ///< "--output", or "CASE" for an argument
  std::string letter;                ///< "-o", or empty
  std::string value;                 ///< "FILE"; empty: a switch
  std::string meaning;               ///< one sentence without full stop
  std::string rule;                  ///< valid values, "1 to 100"; empty: not stated
  std::string default_value;         ///< empty: none
  std::vector<std::string> choices;  ///< valid values or, for a free word, those to offer
  bool argument = false;             ///< positional, without a name
  bool required = false;
  bool common = false;  ///< every command has it
};

/// One command, for help, manual page and completion: facts from the parser and from its description.
struct CommandFacts {
  std::string name, summary;
  Description description;
  std::vector<OptionFacts> options;  ///< arguments first, then its own, then those of every command
};

/// All commands of the program, in the order of their descriptions.
std::vector<CommandFacts> facts_of(const CLI::App& program);

/// "limcycle predict CASE [OPTIONS]".
std::string usage(const CommandFacts& command);

/// "-o, --output FILE".
std::string spelling(const OptionFacts& option);

/// The meaning with valid values and the default; up to `most` choices are listed.
std::string full_meaning(const OptionFacts& option, std::size_t most);

/// Meanings of the exit codes, from code 0 on.
const std::vector<std::string>& exit_codes();

}  // namespace limcycle
