#pragma once
#include <optional>
#include <string>

#include "limcycle/cli/command.hpp"
#include "limcycle/reports/page/case_in_page.hpp"

namespace limcycle {

/// Declares --from PAGE.html for a command with a CASE, which is then optional.
void add_from_flag(CLI::App& command, std::string& page);

/// A case, and the page that held it, if it came from one.
struct CaseWithPage {
  Case from;
  std::optional<CaseInPage> page;
  std::string result;  ///< JSON document of the page; empty: none
};

/// The case of the command line: CASE, or the one in the page, under its name there and with the page's overrides
/// before those of --set. Throws InputError if both or neither are given, or for a page that was altered, holds no case
/// or was written by a newer program.
CaseWithPage load_case_or_page(const CommonFlags& flags, const std::string& page);

/// Reports on stderr, unless quiet, if the page was written by another version, or if the new result (document of
/// `predict`) differs from the one that it holds. With --set a difference is expected and not reported.
void compare_with_page(const CommonFlags& flags, const CaseWithPage& loaded, const std::string& document);

}  // namespace limcycle
