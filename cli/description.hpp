#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// A command line that works from the root of the repository, and what it is for.
struct Example {
  std::string_view line, what;
};

/// What help, manual page and documentation say of a subcommand beside its summary and its options.
struct Description {
  std::string_view name;
  std::string_view group;  ///< the question that it belongs to, a heading of the list of commands
  std::string_view text;   ///< paragraphs, one a line
  std::vector<Example> examples;
};

/// Of every subcommand, in the order in which a user needs them.
const std::vector<Description>& descriptions();

/// Of one. Throws std::logic_error for a name without one.
const Description& description_of(std::string_view name);

}  // namespace limcycle
