#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/command_facts.hpp"

namespace limcycle {

/// `limcycle --help`: the commands by the question that they answer, the exit codes, where to go next. 80 columns.
std::string program_help(const std::vector<CommandFacts>& commands);

/// `limcycle COMMAND --help`: usage, what it is for, its options, examples. 80 columns.
std::string command_help(const CommandFacts& command);

}  // namespace limcycle
