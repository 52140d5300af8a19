#include "limcycle/reports/study_page.hpp"

#include <fmt/format.h>

#include "limcycle/reports/html.hpp"
#include "limcycle/reports/page/page.hpp"

namespace limcycle {
namespace {

std::string tag(const std::string& name, const std::string& text) {
  return fmt::format("<{0}>{1}</{0}>\n", name, html_escaped(text));
}

/// A word of a shell command, quoted when it must be.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string origin(const Provenance& from, const std::string& command, const std::string& case_text) {
  std::string all = "limcycle " + command;
  for (const auto& override : from.overrides) all += " --set " + shell_word(override);
  const auto entry = [](const std::string& name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_escaped(value));
  };
  std::string out = "<h2>Where this comes from</h2>\n<p>To make it again:</p>\n" + tag("pre", all) + "<dl>\n";
  out += entry("program", fmt::format("limcycle {} ({})", from.version, from.commit));
  out += entry("built with", fmt::format("{}, {}", from.compiler, from.build_type));
  out += entry("case file", from.file) + entry("its SHA-256", from.sha256) + "</dl>\n";
  if (case_text.empty()) return out;
  return out + "<details open><summary>Case file</summary>\n<pre>" + html_escaped(case_text) + "</pre></details>\n";
}

}  // namespace

std::string static_table(const Table& table, const std::string& caption) {
  std::string out = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table><caption>{0}</caption>\n"
      "<thead><tr>",
      html_escaped(caption));
  const auto kind = [&](std::size_t i) { return table.columns[i].align == Align::left ? " class=\"left\"" : ""; };
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto& [heading, unit, align] = table.columns[i];
    out += fmt::format("<th scope=\"col\"{}>{}</th>", kind(i),
                       html_escaped(unit.empty() ? heading : fmt::format("{} ({})", heading, unit)));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      out += fmt::format("<td{}>{}</td>", row[i].size() > 32 ? " class=\"wide\"" : kind(i), html_escaped(row[i]));
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string static_page(const Provenance& provenance, const std::string& answer, const std::string& body,
                        const std::string& command, const std::string& case_text) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "img-src data:\">\n<link rel=\"icon\" href=\"data:,\">\n";
  out += R"(<meta name="generator" content="limcycle )" + html_escaped(provenance.version) + "\">\n";
  out += tag("title", provenance.title + " - limcycle") + "<style>" + std::string(page_style()) +
         "</style>\n</head>\n<body>\n<header>\n" + tag("h1", provenance.title);
  out += "<p class=\"answer\"><strong>" + html_escaped(answer) + "</strong></p>\n</header>\n<main>\n" + body;
  return out + "</main>\n<footer>\n" + origin(provenance, command, case_text) + "</footer>\n</body>\n</html>\n";
}

}  // namespace limcycle
