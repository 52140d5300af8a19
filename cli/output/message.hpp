#pragma once
#include <string>

#include "limcycle/analysis/status.hpp"
#include "limcycle/cli/command.hpp"

namespace limcycle {

/// One line on stderr, "limcycle: MESSAGE", unless --quiet. Terminal controls are shown as escapes.
void tell(const CommonFlags& flags, const std::string& message);

/// If the work was interrupted: reports the cause, and what was kept of the results.
void tell_cut_short(const CommonFlags& flags, Status status,
                    const std::string& kept = "the results computed so far are written");

/// If the work was interrupted: the first line of the text, and an empty one.
std::string first_line(const CommonFlags& flags, Status status);

/// The line of a text that names the page written with it: an empty line, then "report: FILE".
std::string page_line(const std::string& file);

}  // namespace limcycle
