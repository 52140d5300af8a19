#pragma once
#include <string>
#include <string_view>

namespace limcycle {

/// True if output to a file descriptor is coloured. `when`: "always", "never", or "auto": on a terminal, unless
/// NO_COLOR is set and not empty (no-color.org), TERM is dumb or not set, or mpirun started the program.
bool colours_wanted(std::string_view when, int descriptor);

/// Value of --color on a command line, read before it is parsed, so that errors of parsing are coloured too.
std::string_view colour_flag(int argc, char** argv);

/// A report for people with bold headings, faint rules and coloured verdicts: confirmed, holds, proved and a yes under
/// "stable" green; biased and undecided yellow; false, fails and a no under "stable" red. Without the escapes the text
/// is unchanged. Verdicts are coloured where they are a cell of a table, not within a sentence.
std::string coloured(std::string_view text);

/// An error message for stderr, with its "limcycle:" in red.
std::string coloured_complaint(std::string_view line);

}  // namespace limcycle
