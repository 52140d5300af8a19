#pragma once
#include <optional>
#include <string>

#include "limcycle/cli/command.hpp"
#include "limcycle/reports/case_in_page.hpp"

namespace limcycle {

/// Declares --from PAGE.html of a command with a CASE, which is not needed then.
void add_from_flag(CLI::App& command, std::string& page);

/// A case, and the page that held it, if it came from one.
struct CaseWithPage {
  Case from;
  std::optional<CaseInPage> page;
  std::string result;  ///< JSON document of the page; empty: none
};

/// The case of the command line: that of CASE, or that in the page, under the name that it had there and with the
/// page's overrides before those of --set. Throws InputError if both or neither are given, or for a page that was
/// altered, holds no case or was written by a newer program.
CaseWithPage load_case_or_page(const CommonFlags& flags, const std::string& page);

/// Says on stderr, unless quiet, where the page was written by another version, or where the result made from it
/// (document of `predict`) is not the one that it states. With --set a difference is no news.
void compare_with_page(const CommonFlags& flags, const CaseWithPage& loaded, const std::string& document);

}  // namespace limcycle
