#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/help/command_facts.hpp"

namespace limcycle {

// Manual pages in roff, with the macros of man(7); plain ASCII.

/// limcycle(1): the commands and the pages about them.
std::string program_page(const std::vector<CommandFacts>& commands, const std::string& version);

/// limcycle-COMMAND(1).
std::string command_page(const CommandFacts& command, const std::string& version);

/// limcycle-case(5): the sections and keys of a case file, from the parameter tables of the models and case_sections().
std::string case_page(const std::string& version);

}  // namespace limcycle
