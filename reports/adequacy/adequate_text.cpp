#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/precision/precision.hpp"

namespace limcycle {
namespace {

std::string short_name(const std::string& method) {
  if (method == "describing-function") return "DF";
  if (method == "composite-describing-function") return "comp. DF";
  return method == "harmonic-balance" ? "HB" : method;
}

/// "3.2 %", "rest", "-".
std::string verdict_cell(const AdequatePoint& point) {
  if (!point.answer.answered) return "-";
  if (std::isinf(point.error)) return point.answer.verdict == "no cycle" ? "none" : point.answer.verdict;
  return as_percent(point.error);
}

const AdequatePoint* point_of(const AdequateReport& report, const std::string& law, const std::string& method) {
  for (const auto& point : report.points)
    if (point.law == law && point.method == method) return &point;
  return nullptr;
}

std::string percent(double share) { return with_digits(100.0 * share, 2) + " %"; }

/// Reason why the laws below the simplest adequate one are not adequate: that of the nearest.
std::string why_not_less(const AdequateReport& report) {
  for (std::size_t i = *report.least; i-- > 0;) {
    const AdequatePoint* point = point_of(report, report.laws[i].name, "shooting");
    if (point && !point->within)
      return fmt::format(". The simpler law {} is not adequate: {}", report.laws[i].name, point->why);
  }
  return ". There is no simpler law";
}

/// Methods that are not adequate with the simplest adequate law.
std::string failing_methods(const AdequateReport& report) {
  std::string out;
  for (const auto& point : report.points)
    if (point.law == report.laws[*report.least].name && !point.within)
      out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", short_name(point.method),
                         point.answer.answered ? point.why : "no answer");
  return out.empty() ? "" : " Not adequate with it: " + out + ".";
}

std::string best_in_words(const AdequateReport& report, const Units& units) {
  std::string out = "Reference: the case's own law, solved by shooting: " + report.best.verdict;
  if (report.best.hunts())
    out += fmt::format(", period {} s, amplitude {}", with_digits(report.best.period, 6),
                       Units::attach(with_digits(report.best.amplitude, 4), units.y));
  return out + (report.verified.empty() ? "." : ", confirmed " + report.verified + ".");
}

}  // namespace

std::string adequate_answer(const AdequateReport& report, const Units& units) {
  const std::string front = report.status == Status::interrupted ? "Interrupted; partial result: " : "";
  if (report.status == Status::undefined) return "There is no reference: " + report.why + ".";
  if (!report.best.answered || (!report.least && report.status == Status::interrupted))
    return front + "no law was assessed.";
  const std::string range = report.spread.empty() ? "" : " over the spread of the parameters";
  if (!report.least)
    return front +
           fmt::format("No law of the ladder stays within {} of the best available{}. ", percent(report.tolerance),
                       range) +
           best_in_words(report, units);
  const std::string& law = report.laws[*report.least].name;
  const AdequatePoint* point = report.cheapest ? &report.points[*report.cheapest] : point_of(report, law, "shooting");
  return front +
         fmt::format(
             "Simplest adequate model: the law {} with {} ({}). Verdict, period and amplitude stay within {}{} (worst "
             "{}){}.{} ",
             law, point->method, as_duration(point->answer.seconds), percent(report.tolerance), range,
             percent(point->worst), why_not_less(report), failing_methods(report)) +
         best_in_words(report, units);
}

Table ladder_table(const AdequateReport& report) {
  Table table{{{"law", "", Align::left}}, {}};
  for (const auto& method : answering_methods()) table.columns.push_back({short_name(method), ""});
  table.columns.push_back({"worst", ""});
  table.columns.push_back({"enough", "", Align::left});
  for (const auto& law : report.laws) {
    std::vector<std::string> row{law.name};
    for (const auto& method : answering_methods()) {
      const AdequatePoint* point = point_of(report, law.name, method);
      row.push_back(point ? verdict_cell(*point) : "-");
    }
    const AdequatePoint* shot = point_of(report, law.name, "shooting");
    row.push_back(!shot || std::isnan(shot->worst) ? "-" : std::isinf(shot->worst) ? "other" : percent(shot->worst));
    row.push_back(!law.law ? "no law" : !shot ? "-" : yes_or_no(shot->within));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table rule_table(const AdequateReport& report) {
  Table table{{{"law", "", Align::left}, {"parameters", "", Align::left}}, {}};
  for (const auto& law : report.laws) table.rows.push_back({law.name, law.rule});
  return table;
}

Table adequate_table(const AdequateReport& report, const Units& units) {
  Table table{{{"law", "", Align::left},
               {"method", "", Align::left},
               {"result", "", Align::left},
               {"period", "s"},
               {"amplitude", units.y},
               {"error", ""},
               {"worst", ""},
               {"CPU time", ""},
               {"enough", "", Align::left},
               {"why not", "", Align::left}},
              {}};
  const auto share = [](double value) {
    return std::isnan(value) ? std::string("-") : std::isinf(value) ? std::string("other verdict") : percent(value);
  };
  for (const auto& point : report.points) {
    const bool cycle = point.answer.answered && point.answer.hunts();
    table.rows.push_back({point.law, point.method, point.answer.answered ? point.answer.verdict : "no answer",
                          cycle ? with_digits(point.answer.period, 5) : "-",
                          cycle ? with_digits(point.answer.amplitude, 4) : "-", share(point.error), share(point.worst),
                          as_duration(point.answer.seconds), yes_or_no(point.within), point.why});
  }
  return table;
}

Document adequate_document(const std::string& title, const AdequateReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(adequate_answer(report, units)));
  if (!report.points.empty()) {
    out.add("Error of period and amplitude by law and method, or the other verdict", ladder_table(report));
    out += wrapped(
        "DF: describing function, comp. DF: with mass and friction as one element, HB: harmonic balance; none: no "
        "cycle found, -: no answer. Worst: by shooting, over the spread of the parameters; only for laws that are "
        "adequate at the case's own values.",
        80, 2);
    Table costs{{{"law", "", Align::left}}, {}};
    for (const auto& method : answering_methods()) costs.columns.push_back({short_name(method), ""});
    for (const auto& law : report.laws) {
      if (!law.law) continue;
      costs.rows.push_back({law.name});
      for (const auto& method : answering_methods()) {
        const AdequatePoint* point = point_of(report, law.name, method);
        costs.rows.back().push_back(point ? as_duration(point->answer.seconds) : "-");
      }
    }
    out.add("CPU time of an answer", costs);
  }
  out += "\nParameters of each law\n";
  for (const auto& law : report.laws) out += item(law.name, 20, law.rule);
  if (!report.spread.empty()) {
    std::string spread;
    for (const auto& one : report.spread) spread += (spread.empty() ? "" : "; ") + one;
    out += "\n" + wrapped("Spread: " + report.spread_rule) + wrapped(spread, 80, 2);
  }
  out += notes_text(report.notes);
  if (report.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string adequate_text(const std::string& title, const AdequateReport& report, const Units& units) {
  return adequate_document(title, report, units).text();
}

}  // namespace limcycle
