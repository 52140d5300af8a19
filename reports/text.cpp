#include "limcycle/reports/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/multipliers.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"

namespace limcycle {
namespace {

std::string cycle_number(const std::optional<std::size_t>& value) { return value ? std::to_string(*value) : "-"; }

std::string titled(const std::string& heading, const std::string& body) { return "\n" + heading + "\n" + body; }

std::string outcomes(const PredictReport& report, const Units& units) {
  std::string out;
  for (const auto& one : report.outcomes) {
    std::string label(to_string(one.outcome));
    if (one.cycle) label += fmt::format(" {}", *one.cycle);
    out += item(label, 10, "from " + start_in_words(one.start, units) + (one.why.empty() ? "" : ": " + one.why));
  }
  return out;
}

/// "1.69974 to 1.75964", or "unknown" for a band without ends.
std::string ends_text(const Interval& interval) {
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return "unknown";
  return with_digits(interval.low, 4) + " to " + with_digits(interval.high, 4);
}

std::string sentences(const PredictReport& report) {
  std::string out;
  for (std::size_t i = 0; i < report.predictions.size(); ++i)
    if (const auto& trust = report.predictions[i].trust) out += item(fmt::format("{}:", i), 2, trust->sentence);
  return out;
}

std::string reasons(const PredictReport& report) {
  std::string out;
  for (std::size_t i = 0; i < report.predictions.size(); ++i)
    if (!report.predictions[i].why.empty()) out += item(fmt::format("{}:", i), 2, report.predictions[i].why);
  return out;
}

}  // namespace

std::string start_in_words(const std::string& start, const Units& units) {
  return names_displacement(start) ? Units::attach(start, units.y) : start;
}

Table cycle_table(const PredictReport& report, const Units& units) {
  Table table{{{"#", "", Align::left},
               {"period", "s"},
               {"amplitude", units.y},
               {"1st harm.", units.y},
               {"offset", units.y},
               {"stable", ""},
               {"stuck", ""},
               {"error", ""}},
              {}};
  constexpr double rounding_of_offset = 1e-10;
  for (std::size_t i = 0; i < report.cycles.size(); ++i) {
    const auto& cycle = report.cycles[i];
    // The error is that of period and amplitude. An offset is a mean over the same orbit: its absolute error is that of
    // the amplitude; seven digits of the harmonic are enough to compare it with a prediction.
    const double error = std::max(cycle.error, rounding_of_offset) * cycle.amplitude;
    const double of_harmonic = std::max(cycle.error, 0.6e-6);
    table.rows.push_back({std::to_string(i), with_error(cycle.period, cycle.error),
                          with_error(cycle.amplitude, cycle.error), with_error(cycle.first_harmonic, of_harmonic),
                          with_absolute_error(cycle.offset, error), yes_or_no(cycle.stable),
                          as_percent(cycle.sticking_fraction), as_error(cycle.error)});
  }
  return table;
}

Table prediction_table(const PredictReport& report, const Units& units) {
  Table table{{{"#", "", Align::left},
               {"method", "", Align::left},
               {"1st harm.", units.y},
               {"frequency", "rad/s"},
               {"stable", ""},
               {"verdict", "", Align::left},
               {"cycle", ""}},
              {}};
  for (std::size_t i = 0; i < report.predictions.size(); ++i) {
    const auto& one = report.predictions[i];
    table.rows.push_back({std::to_string(i), one.method, with_digits(one.amplitude, 6), with_digits(one.frequency, 6),
                          yes_or_no(one.stable), std::string(to_string(one.verdict)), cycle_number(one.cycle)});
  }
  return table;
}

Table trust_table(const PredictReport& report, const Units& units) {
  Table table{{{"#", "", Align::left},
               {"filter", ""},
               {"residual", ""},
               {"stuck", ""},
               {"frequency", "rad/s"},
               {"1st harm.", units.y},
               {"band", "", Align::left}},
              {}};
  for (std::size_t i = 0; i < report.predictions.size(); ++i) {
    const auto& trust = report.predictions[i].trust;
    if (!trust) continue;
    const Band& band = trust->band;
    table.rows.push_back(
        {std::to_string(i), with_digits(trust->filter_ratio, 2), with_digits(trust->harmonic_residual, 2),
         as_percent(trust->sticking_fraction), ends_text(band.frequency), ends_text(band.amplitude),
         std::string(band.kind == BandKind::rigorous ? to_string(band.verdict) : to_string(band.kind))});
  }
  return table;
}

std::string absence_in_words(const PredictReport& report) {
  if (!report.absence) return "";
  const bool proved = report.absence->verdict == BandVerdict::proved;
  return std::string(proved ? "Proved (Mees and Bergen 1975): " : "Not proved (Mees and Bergen 1975): ") +
         report.absence->why + ".";
}

Document predict_document(const std::string& title, const PredictReport& report, const Units& units) {
  const VerdictText words = answer(report, units);
  Document out(wrapped(title) + "\n" + wrapped(words.what_happens));
  for (const auto& sentence : words.worth) out += wrapped(sentence);
  if (!report.cycles.empty()) out.add("Limit cycles", cycle_table(report, units));
  if (const Table multipliers = multiplier_table(report); !multipliers.rows.empty())
    out.add("Floquet multipliers, without the trivial 1", multipliers);
  if (!report.predictions.empty()) {
    out.add("Predictions", prediction_table(report, units));
    out += reasons(report);
  }
  if (const Table trust = trust_table(report, units); !trust.rows.empty()) {
    out.add("Trust in the predictions, and bounds of the true cycles", trust);
    out += sentences(report);
  }
  if (report.absence) out += titled("Absence of oscillations", wrapped(absence_in_words(report)));
  if (!report.outcomes.empty()) out += titled("Reached in simulation", outcomes(report, units));
  const auto& box = report.search;
  out +=
      titled("Search box",
             wrapped(fmt::format("amplitude of the element's input {:g} to {}, frequency {:g} to {:g} rad/s",
                                 box.amplitude_min, Units::attach(fmt::format("{:g}", box.amplitude_max), units.input),
                                 box.frequency_min, box.frequency_max)));
  out += notes_text(report.notes);
  if (report.status != Status::converged && report.status != Status::no_cycle)
    out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string predict_text(const std::string& title, const PredictReport& report, const Units& units) {
  return predict_document(title, report, units).text();
}

}  // namespace limcycle
