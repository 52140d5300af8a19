#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Text made safe between tags or in a quoted attribute: & < > " ' escaped, control characters and bytes that are not
/// UTF-8 replaced.
std::string html_escaped(std::string_view text);

/// `<name>text</name>`, the text escaped.
std::string html_tag(const std::string& name, const std::string& text);

/// A table with its caption. Cells of a column "verdict" carry their text as a class too.
std::string html_table(const Table& table, const std::string& caption);

/// A picture (SVG text) of the program in a page: a figure with its caption, in a box that scrolls by itself and stays
/// light in a dark page. The rules of its style apply to this picture only. A caption that the picture itself shows is
/// not repeated. `csv`: its data, which the page then offers as a file (up to half a megabyte). Empty without a
/// picture.
std::string html_picture(const std::string& svg, const std::string& caption, const std::string& csv = "");

/// Heading (h2, or another level) and list; empty without notes.
std::string html_notes(const std::vector<std::string>& notes, int level = 2);

/// Contents of a page.
struct HtmlPage {
  const Provenance& provenance;
  std::string answer;                ///< at the top
  std::vector<std::string> worth{};  ///< sentences under it
  std::string body;                  ///< markup
  std::string command;               ///< that reproduces it: "predict"; its case and overrides are added
  std::string flags{};               ///< of that command, as typed; empty: those of the provenance
  std::string case_text;             ///< the case file as read; empty: left out
  std::string result{};              ///< JSON document for programs; empty: none
  std::vector<std::string> scripts{std::string(page_script())};  ///< the page's own last
};

/// A self-contained page that contains its case and its result for programs (case_in_page.hpp): it makes no network
/// requests (its own policy forbids them) and states its provenance.
std::string html_page(const HtmlPage& page);

}  // namespace limcycle
