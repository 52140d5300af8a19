#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// A command line that works from the root of the repository, and its purpose.
struct Example {
  std::string_view line, what;
};

/// Text on a subcommand for help, manual page and documentation, in addition to its summary and its options.
struct Description {
  std::string_view name;
  std::string_view group;  ///< the group of commands, a heading in their list
  std::string_view text;   ///< paragraphs, one a line
  std::vector<Example> examples;
};

/// Descriptions of all subcommands, in the order in which a user needs them.
const std::vector<Description>& descriptions();

/// Description of one subcommand. Throws std::logic_error for an unknown name.
const Description& description_of(std::string_view name);

}  // namespace limcycle
