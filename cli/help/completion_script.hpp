#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/help/command_facts.hpp"

namespace limcycle {

// Scripts that complete commands, options, the values of options and files, one for each shell.

std::string bash_completion(const std::vector<CommandFacts>& commands);
std::string zsh_completion(const std::vector<CommandFacts>& commands);
std::string fish_completion(const std::vector<CommandFacts>& commands);

}  // namespace limcycle
