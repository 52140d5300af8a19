#pragma once
#include <string>

#include "limcycle/analysis/status.hpp"
#include "limcycle/cli/command.hpp"

namespace limcycle {

/// One line on stderr, "limcycle: MESSAGE", unless --quiet. What a terminal would obey is shown as escapes.
void tell(const CommonFlags& flags, const std::string& message);

/// Where the work was interrupted: says by whom, and what became of it.
void tell_cut_short(const CommonFlags& flags, Status status,
                    const std::string& kept = "the results computed so far are written");

/// Where the work was interrupted: the first line of the text, and an empty one.
std::string first_line(const CommonFlags& flags, Status status);

/// The line of a text that names the page beside it: an empty line, then "report: FILE".
std::string page_line(const std::string& file);

}  // namespace limcycle
