#pragma once
#include <string>
#include <string_view>

namespace limcycle {

/// Whether what goes to a file descriptor gets colours. `when`: "always", "never", or "auto": on a terminal, unless
/// NO_COLOR is set and not empty (no-color.org), TERM is dumb or not set, or mpirun started the program.
bool colours_wanted(std::string_view when, int descriptor);

/// What --color says on a command line, known before it is parsed, so that also what is wrong with it has its colour.
std::string_view colour_flag(int argc, char** argv);

/// A report for people with its headings bold, its rules faint and its verdicts coloured: confirmed, holds, proved and
/// a yes under "stable" green; biased and undecided yellow; false, fails and a no under "stable" red. The characters
/// between the escapes are the text unchanged. Verdicts are coloured where they stand as a cell of a table, not within
/// a sentence.
std::string coloured(std::string_view text);

/// A complaint on stderr: its "limcycle:" in red.
std::string coloured_complaint(std::string_view line);

}  // namespace limcycle
