#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/help/command_facts.hpp"

namespace limcycle {

/// `limcycle --help`: the commands grouped by question, the exit codes, where to continue. 80 columns.
std::string program_help(const std::vector<CommandFacts>& commands);

/// `limcycle COMMAND --help`: usage, purpose, options, examples. 80 columns.
std::string command_help(const CommandFacts& command);

}  // namespace limcycle
