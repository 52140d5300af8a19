#include "limcycle/reports/page/html_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/page/case_in_page.hpp"
#include "limcycle/reports/page/page.hpp"

namespace limcycle {
namespace {

/// Length of the UTF-8 sequence at the front, 0 if it is not one (RFC 3629).
std::size_t sequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead < 0xE0) return follows(1) ? 2 : 0;
  if (lead >= 0xE0 && lead < 0xF0) {
    const bool valid = (lead != 0xE0 || byte(1) >= 0xA0) && (lead != 0xED || byte(1) < 0xA0);
    return valid && follows(1) && follows(2) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead < 0xF5) {
    const bool valid = (lead != 0xF0 || byte(1) >= 0x90) && (lead != 0xF4 || byte(1) < 0x90);
    return valid && follows(1) && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

/// A word of a shell command, quoted if necessary.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string origin(const HtmlPage& page) {
  const Provenance& from = page.provenance;
  std::string command = "limcycle " + page.command;
  if (!from.file.empty()) command += " " + shell_word(from.file);
  if (!page.flags.empty()) command += " " + page.flags;
  if (page.flags.empty())
    for (const auto& word : from.flags) command += " " + shell_word(word);
  for (const auto& override : from.overrides) command += " --set " + shell_word(override);
  const auto entry = [](const std::string& name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_escaped(value));
  };
  std::string out = "<h2 id=\"origin\">Provenance</h2>\n";
  // A case that was made in Python is in no file that a command could read; these two need none.
  if (!from.file.empty() || page.command.starts_with("experiment ") || page.command == "claims")
    out += "<p>To reproduce it:</p>\n" + html_tag("pre", command);
  if (!page.case_text.empty())
    out += "<p>The same prediction from this page alone, which holds the case:</p>\n" +
           html_tag("pre", "limcycle predict --from PAGE.html");
  out += "<dl>\n";
  out += entry("program",
               fmt::format("limcycle {} ({})", from.version, from.commit.empty() ? "commit unknown" : from.commit));
  out += entry("built with", fmt::format("{}, {}", from.compiler, from.build_type));
  out += entry("run with", fmt::format("seed {}, {} thread{}, instruction set {}", from.seed, from.threads,
                                       from.threads == 1 ? "" : "s", from.isa));
  if (!from.file.empty()) out += entry("case file", from.file) + entry("its SHA-256", from.sha256);
  for (const MeasuredPlantAt& plant : from.measured)
    out += entry("measured plant", basis_in_words(plant)) +
           (plant.response->data().sha256.empty() ? "" : entry("SHA-256 of its data", plant.response->data().sha256));
  for (const CurveFile& curve : from.curves)
    out += entry("friction curve", fmt::format("{}: {} points of {}", curve.path, curve.points, curve.file)) +
           entry("SHA-256 of its data", curve.sha256);
  for (const MatrixFile& one : from.matrices)
    out += entry("matrices", fmt::format("{}: {} of {}", one.path, fmt::join(one.variables, ", "), one.file)) +
           entry("SHA-256 of its data", one.sha256);
  out += "</dl>\n";
  if (page.case_text.empty()) return out;
  return out + "<details open><summary>Case file</summary>\n<pre>" + html_escaped(page.case_text) +
         "</pre></details>\n";
}

/// Each selector of the rules in `style` with the class `owner` in front. Our pictures have simple rules only: no @, no
/// comments.
std::string scoped(std::string_view style, const std::string& owner) {
  std::string out;
  while (!style.empty()) {
    const auto open = style.find('{'), close = style.find('}');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) break;
    std::string_view selectors = style.substr(0, open);
    for (bool first = true; !selectors.empty(); first = false) {
      const auto comma = std::min(selectors.find(','), selectors.size());
      out += (first ? "." : ",.") + owner + " " + std::string(selectors.substr(0, comma));
      selectors.remove_prefix(std::min(comma + 1, selectors.size()));
    }
    out += style.substr(open, close + 1 - open);
    style.remove_prefix(close + 1);
  }
  return out;
}

/// A style element applies to the whole page, so that each of several pictures gets a class for its own style.
std::string with_own_style(const std::string& svg) {
  constexpr std::string_view begin = "<style>", end = "</style>", tag = "<svg ";
  const auto from = svg.find(begin), to = svg.find(end);
  if (!svg.starts_with(tag) || from == std::string::npos || to == std::string::npos) return svg;
  const std::string_view style = std::string_view(svg).substr(from + begin.size(), to - from - begin.size());
  const std::string owner = fmt::format("picture-{:x}", std::hash<std::string_view>{}(style)&0xFFFFFFFFu);
  return fmt::format("{}class=\"{}\" {}{}{}", tag, owner,
                     std::string_view(svg).substr(tag.size(), from + begin.size() - tag.size()), scoped(style, owner),
                     std::string_view(svg).substr(to));
}

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = sequence(text);
    const char c = text[0];
    if (length == 0)
      out += "\xEF\xBF\xBD";  // U+FFFD
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7F)
      out += ' ';
    else
      out += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string html_tag(const std::string& name, const std::string& text) {
  return fmt::format("<{0}>{1}</{0}>\n", name, html_escaped(text));
}

std::string html_table(const Table& table, const std::string& caption) {
  std::string out = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"{0}\"><table><caption><span>{0}</span></caption>\n<thead><tr>",
      html_escaped(caption));
  for (const auto& column : table.columns) {
    const std::string heading =
        column.unit.empty() ? column.heading : fmt::format("{} ({})", column.heading, column.unit);
    out += fmt::format("<th scope=\"col\"{}>{}</th>", column.align == Align::left ? " class=\"left\"" : "",
                       html_escaped(heading));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::string kind = table.columns[i].align == Align::left ? "left" : "";
      if (table.columns[i].heading == "verdict") kind += " " + row[i];
      if (row[i].size() > 32) kind = "wide";
      out += fmt::format("<td{}>{}</td>", kind.empty() ? "" : " class=\"" + html_escaped(kind) + "\"",
                         html_escaped(row[i]));
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string html_picture(const std::string& svg, const std::string& caption, const std::string& csv) {
  constexpr std::size_t most_rows = 500'000;  // bytes
  if (svg.empty()) return "";
  std::string out = "<figure>\n<div class=\"picture scroll\" tabindex=\"0\" role=\"group\" aria-label=\"" +
                    html_escaped("Picture: " + caption) + "\">\n" + with_own_style(svg) + "</div>\n";
  if (svg.find(">" + html_escaped(caption) + "</text>") == std::string::npos)
    out += "<figcaption>" + html_escaped(caption) + "</figcaption>\n";
  if (!csv.empty() && csv.size() <= most_rows)
    out += R"(<script type="application/json" class="rows">)" + figure_data(json_text(csv)) + "</script>\n";
  return out + "</figure>\n";
}

std::string html_notes(const std::vector<std::string>& notes, int level) {
  if (notes.empty()) return "";
  std::string out = html_tag("h" + std::to_string(level), "Notes") + "<ul>\n";
  for (const auto& note : notes) out += html_tag("li", note);
  return out + "</ul>\n";
}

std::string html_page(const HtmlPage& page) {
  const std::string title = page.provenance.title;
  const std::string policy = "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; " +
      policy + "\">\n<link rel=\"icon\" href=\"data:,\">\n";
  out += R"(<meta name="generator" content="limcycle )" + html_escaped(page.provenance.version) + "\">\n";
  out += html_tag("title", title + " - limcycle") + "<style>" + std::string(page_style()) + "</style>\n</head>\n";
  out += "<body>\n<a class=\"skip\" href=\"#results\">Skip to the results</a>\n<header>\n" + html_tag("h1", title);
  out += "<p class=\"answer\"><strong>" + html_escaped(page.answer) + "</strong></p>\n";
  for (const auto& sentence : page.worth) out += "<p class=\"worth\">" + html_escaped(sentence) + "</p>\n";
  out += "</header>\n<main id=\"results\" tabindex=\"-1\">\n" + page.body + "</main>\n<footer>\n" + origin(page) +
         "</footer>\n";
  if (!page.case_text.empty()) out += case_element(page.provenance, page.case_text, page.command, page.flags);
  if (!page.result.empty()) out += result_element(page.result);
  for (const auto& script : page.scripts) out += "<script>" + script + "</script>\n";
  return out + "</body>\n</html>\n";
}

}  // namespace limcycle
