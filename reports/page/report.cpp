#include "limcycle/reports/page/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/dissipativity/dissipativity.hpp"
#include "limcycle/reports/figures/blocks/block_diagram.hpp"
#include "limcycle/reports/figures/drawing/plotly.hpp"
#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/figures/harmonics_figure.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/precision/precision.hpp"
#include "limcycle/reports/predict/predict_sections.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"
#include "limcycle/reports/remedy/remedy.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

/// A section under a heading of level 2, with its place in the contents.
struct ReportSection {
  std::string id, heading, body;
};

/// The body of a part, or the reason for its absence.
template <class Result>
std::string body_of(const ReportPart<Result>& part, auto&& body) {
  if (part.found) return body(*part.found);
  return part.why_not.empty() ? std::string() : html_tag("p", part.why_not);
}

ReportSection loop_section(const LoopReport& report, const Units& units) {
  return {"part-loop", "The loop",
          "<figure class=\"scroll\" tabindex=\"0\">\n" + block_diagram(report.loop, units) + "<figcaption>" +
              html_escaped(loop_in_words(report.loop, units)) + "</figcaption>\n</figure>\n"};
}

/// The figures of a prediction: the Nyquist plot belongs to the predictions, all others to the motion.
struct SortedFigures {
  std::vector<Figure> motion, frequency;
};

SortedFigures sorted_figures(const PredictReport& report, const Units& units) {
  SortedFigures out;
  for (auto& figure : predict_figures(report, units))
    (figure.id == "nyquist" ? out.frequency : out.motion).push_back(std::move(figure));
  if (auto harmonics = harmonics_figure(report, units)) {
    const auto last = std::ranges::find(out.motion, "multipliers", &Figure::id);
    out.motion.insert(last, *std::move(harmonics));
  }
  return out;
}

/// Explains missing figures, in a sentence each.
std::string missing_figures(const PredictReport& report, const SortedFigures& figures) {
  std::string out;
  const auto has = [&](const char* id) {
    return std::ranges::find(figures.motion, id, &Figure::id) != figures.motion.end();
  };
  if (report.cycles.empty())
    out += html_tag("p",
                    "Without a limit cycle there are no harmonics and no Floquet multipliers; the figures show a "
                    "simulation.");
  else if (!has("multipliers"))
    out += html_tag("p", "The Floquet multipliers of these cycles were not computed.");
  return out;
}

ReportSection motion_section(const LoopReport& report, const Units& units, const SortedFigures& figures) {
  return {
      "part-cycles", "Limit cycles",
      cycle_tables(report.predict, units) + missing_figures(report.predict, figures) + figures_html(figures.motion)};
}

ReportSection prediction_section(const LoopReport& report, const Units& units, const SortedFigures& figures) {
  std::string body = prediction_tables(report.predict, units);
  body += figures.frequency.empty()
              ? html_tag("p", "The describing function was not applied, so there is no Nyquist plot: see the notes.")
              : figures_html(figures.frequency, figures.motion.empty());
  return {"part-predictions", "Predictions", body + trust_sections(report.predict, units, 3)};
}

std::string sensitivity_body(const SensitivityReport& found, const Units& units) {
  return html_tag("p", sensitivity_answer(found)) + sensitivity_sections(found, units, 3);
}

std::string energy_body(const CountedRun& counted) {
  const auto& time = counted.run.trace.t;
  const std::string words = fmt::format("This is {}, {:.6g} s. ", counted.which, time.empty() ? 0.0 : time.back());
  return html_tag("p", words + energy_in_words(counted.energy)) +
         html_table(energy_table(counted.energy), "Energy supplied, stored and dissipated");
}

/// What ends the hunting, or where it would begin: single numbers, then the known remedies.
ReportSection cure_section(const LoopReport& report, const Units& units) {
  std::string body = body_of(report.margin, [&](const MarginReport& found) {
    return html_tag("p", margin_answer(found, units)) + margin_sections(found, 3);
  });
  body += body_of(report.remedy, [&](const RemedyReport& found) {
    return html_tag("p", remedy_answer(found, units)) + remedy_sections(found, units, 3);
  });
  return {"part-cure", report.margin.found && !report.margin.found->hunts ? "Margins" : "What would end it", body};
}

std::vector<ReportSection> sections_of(const LoopReport& report, const Units& units) {
  const SortedFigures figures = sorted_figures(report.predict, units);
  std::vector<ReportSection> out{cure_section(report, units), loop_section(report, units),
                                 motion_section(report, units, figures), prediction_section(report, units, figures)};
  const std::string outcomes = outcome_table(report.predict, units);
  out.push_back({"part-starts", "Outcome of each start",
                 outcomes.empty() ? html_tag("p", "No simulation was run to its end.") : outcomes});
  out.push_back({"part-sensitivity", "Sensitivity",
                 body_of(report.sensitivity, [&](const auto& found) { return sensitivity_body(found, units); })});
  out.push_back({"part-map", "Hunting map", body_of(report.map, [&](const auto& found) {
                   return html_tag("p", map_answer(found)) + map_sections(found, units, 3);
                 })});
  out.push_back({"part-energy", "Energy balance", body_of(report.energy, energy_body)});
  out.push_back({"part-dissipativity", "Dissipativity", body_of(report.dissipativity, [](const auto& found) {
                   return html_tag("p", dissipativity_answer(found)) + dissipativity_sections(found, 3);
                 })});
  out.push_back({"part-precision", "Accuracy and cost", body_of(report.precision, [&](const auto& found) {
                   return html_tag("p", precision_answer(found)) + precision_sections(found, units, 3);
                 })});
  return out;
}

/// What was not asked for, with the flag that asks for it; empty if nothing is missing.
std::string left_out(const LoopReport& report) {
  const auto missing = [](const auto& part) { return !part.found && part.why_not.empty(); };
  std::string list;
  const auto add = [&](bool is_missing, std::string_view what) {
    if (is_missing) list += (list.empty() ? "Left out: " : ", ") + std::string(what);
  };
  add(missing(report.margin), "margins, sensitivity and dissipativity (by --quick)");
  add(missing(report.remedy), "remedies (--remedies)");
  add(missing(report.map), "a hunting map (--x, --y)");
  add(missing(report.precision), "accuracy and cost of the methods (--benchmarks)");
  return list.empty() ? list : html_tag("p", list + ".");
}

std::string contents(const std::vector<ReportSection>& sections, bool notes) {
  std::string out = "<nav aria-label=\"Contents\">\n<ul>\n";
  const auto entry = [&](const std::string& id, const std::string& heading) {
    out += "<li><a href=\"#" + id + "\">" + html_escaped(heading) + "</a></li>\n";
  };
  for (const auto& section : sections) entry(section.id, section.heading);
  if (notes) entry("part-notes", "Notes");
  entry("origin", "Provenance");
  return out + "</ul>\n</nav>\n";
}

}  // namespace

std::string report_page(const LoopReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units, const std::string& flags) {
  VerdictText words = answer(report.predict, units);
  if (report.interrupted)
    words.worth.insert(words.worth.begin(),
                       "Interrupted: this page shows the results computed so far and marks what is missing.");
  auto sections = sections_of(report, units);
  std::erase_if(sections, [](const ReportSection& section) { return section.body.empty(); });
  std::string body = contents(sections, !report.predict.notes.empty());
  for (const auto& section : sections)
    body +=
        fmt::format("<section id=\"{}\">\n{}{}</section>\n", section.id, html_tag("h2", section.heading), section.body);
  if (!report.predict.notes.empty())
    body += "<section id=\"part-notes\">\n" + html_notes(report.predict.notes) + "</section>\n";
  body += left_out(report);
  return html_page({.provenance = provenance,
                    .answer = words.what_happens,
                    .worth = words.worth,
                    .body = body,
                    .command = "report",
                    .flags = flags,
                    .case_text = case_text,
                    .result = predict_json(provenance, in_units(report.predict, in_si(units))),
                    .scripts = {std::string(plotly_script()), std::string(page_script())}});
}

}  // namespace limcycle
