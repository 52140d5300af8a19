#include "limcycle/reports/html.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "limcycle/reports/answer.hpp"
#include "limcycle/reports/figures.hpp"
#include "limcycle/reports/number.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/plotly.hpp"
#include "limcycle/reports/text.hpp"

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

std::string tag(const std::string& name, const std::string& text) {
  return fmt::format("<{0}>{1}</{0}>\n", name, html_escaped(text));
}

std::string html_table(const Table& table, const std::string& caption) {
  std::string out = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"{0}\"><table><caption>{0}</caption>\n<thead><tr>",
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

std::string trust_html(const PredictReport& report, const Units& units) {
  std::string out;
  if (const Table table = trust_table(report, units); !table.rows.empty())
    out += "<h2>Trust in the predictions</h2>\n" +
           html_table(table,
                      "Size of the harmonics that come back, share of the sinusoid that sticks, and where the "
                      "true cycles may lie");
  for (std::size_t i = 0; i < report.predictions.size(); ++i)
    if (const auto& trust = report.predictions[i].trust)
      out += tag("p", fmt::format("Prediction {}: {}. Its band: {}.", i, trust->sentence, trust->band.why));
  if (report.absence) out += "<h2>Absence of oscillations</h2>\n" + tag("p", absence_in_words(report));
  return out;
}

std::string tables(const PredictReport& report, const Units& units) {
  std::string out = "<h2>Limit cycles</h2>\n";
  out += report.cycles.empty() ? tag("p", "None was found.")
                               : html_table(cycle_table(report, units), "Limit cycles that exist, as best known");
  out += "<h2>Predictions</h2>\n";
  Table predictions = prediction_table(report, units);
  predictions.columns.push_back({"why", "", Align::left});
  for (std::size_t i = 0; i < report.predictions.size(); ++i) predictions.rows[i].push_back(report.predictions[i].why);
  out += report.predictions.empty() ? tag("p", "None in the search box.")
                                    : html_table(predictions, "What each method predicts, with its verdict");
  for (const auto& missed : report.missed)
    out += tag("p", fmt::format("Limit cycle {} is missed by {}.", missed.cycle, method_in_words(missed.method)));
  out += trust_html(report, units);
  if (report.outcomes.empty()) return out;
  Table outcomes{{{"start", "", Align::left}, {"reaches", "", Align::left}, {"cycle", ""}, {"why", "", Align::left}},
                 {}};
  for (const auto& one : report.outcomes)
    outcomes.rows.push_back(
        {one.start, std::string(to_string(one.outcome)), one.cycle ? std::to_string(*one.cycle) : "-", one.why});
  return out + "<h2>Simulations</h2>\n" + html_table(outcomes, "What each start reaches");
}

std::string figure_html(const Figure& figure) {
  const std::string label = html_escaped(figure.heading + ". " + figure.finding);
  return fmt::format(
      "<figure>\n<h3>{0}</h3>\n<div class=\"plot{1}\" data-figure=\"{2}\" tabindex=\"0\" role=\"img\" "
      "aria-label=\"{3}\"></div>\n"
      "<figcaption>{4}</figcaption>\n<script type=\"application/json\" id=\"data-{2}\">{5}</script>\n</figure>\n",
      html_escaped(figure.heading), figure.id == "nyquist" || figure.id == "time" ? " tall" : "", figure.id, label,
      html_escaped(figure.finding), figure.data);
}

/// A word of a shell command, quoted when it must be.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string provenance_html(const Provenance& from, const std::string& case_text) {
  std::string command = "limcycle predict " + shell_word(from.file);
  for (const auto& override : from.overrides) command += " --set " + shell_word(override);
  const auto entry = [](const std::string& name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_escaped(value));
  };
  std::string out = "<h2>Where this comes from</h2>\n<p>To make it again:</p>\n" + tag("pre", command) + "<dl>\n";
  out += entry("program",
               fmt::format("limcycle {} ({})", from.version, from.commit.empty() ? "commit unknown" : from.commit));
  out += entry("built with", fmt::format("{}, {}", from.compiler, from.build_type));
  out += entry("run with", fmt::format("seed {}, {} thread{}, instruction set {}", from.seed, from.threads,
                                       from.threads == 1 ? "" : "s", from.isa));
  out += entry("case file", from.file) + entry("its SHA-256", from.sha256) + "</dl>\n";
  if (case_text.empty()) return out;
  return out + "<details open><summary>Case file</summary>\n<pre>" + html_escaped(case_text) + "</pre></details>\n";
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

std::string predict_page(const PredictReport& report, const Provenance& provenance, const std::string& case_text,
                         const Units& units) {
  const Answer words = answer(report, units);
  const auto figures = predict_figures(report, units);
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; img-src data: blob:\">\n<link rel=\"icon\" href=\"data:,\">\n";
  out += R"(<meta name="generator" content="limcycle )" + html_escaped(provenance.version) + "\">\n";
  out += tag("title", provenance.title + " - limcycle");
  out += "<style>" + std::string(page_style()) + "</style>\n</head>\n<body>\n<header>\n";
  out += tag("h1", provenance.title);
  out += "<p class=\"answer\"><strong>" + html_escaped(words.what_happens) + "</strong></p>\n";
  for (const auto& sentence : words.worth) out += "<p class=\"worth\">" + html_escaped(sentence) + "</p>\n";
  out += "</header>\n<main>\n" + tables(report, units);
  if (!report.notes.empty()) {
    out += "<h2>Notes</h2>\n<ul>\n";
    for (const auto& note : report.notes) out += tag("li", note);
    out += "</ul>\n";
  }
  if (!figures.empty()) {
    out +=
        "<h2>Figures</h2>\n<p class=\"hint\">Drag to move, or use the keys of a focused figure: arrows move, + and − "
        "zoom, "
        "a shows all, 0 the first view again.</p>\n<noscript><p>The figures need JavaScript; the texts under them say "
        "what they "
        "show.</p></noscript>\n";
    for (const auto& figure : figures) out += figure_html(figure);
  }
  out += "</main>\n<footer>\n" + provenance_html(provenance, case_text) + "</footer>\n<script>";
  out += plotly_script();
  out += "</script>\n<script>" + std::string(page_script()) + "</script>\n</body>\n</html>\n";
  return out;
}

}  // namespace limcycle
