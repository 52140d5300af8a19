#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// A command line that works from the root of the repository, and its purpose.
struct Example {
  std::string_view line, what;
};

/// Groups of subcommands.
inline constexpr std::string_view begin_group = "Getting started";
inline constexpr std::string_view hunt_group = "Prediction and simulation";
inline constexpr std::string_view change_group = "Parameter studies";
inline constexpr std::string_view trust_group = "Choice of law and method";
inline constexpr std::string_view evidence_group = "Verification";
inline constexpr std::string_view install_group = "Installation";

/// Text on a subcommand for help, manual page and documentation, in addition to its summary and its options.
struct Description {
  std::string_view name;
  std::string_view group;  ///< the group of commands, a heading in their list
  std::string_view text;   ///< paragraphs, one a line
  std::vector<Example> examples;
};

}  // namespace limcycle
