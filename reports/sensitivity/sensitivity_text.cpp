#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

constexpr int index_digits = 3;

std::string interval_text(const Estimate& estimate) {
  return estimate.bounded() ? with_digits(estimate.low, index_digits) + ".." + with_digits(estimate.high, index_digits)
                            : "?";
}

/// Shares of a variance have three decimals: smaller digits are noise.
std::string share_text(const Estimate& estimate) {
  return estimate.known ? fmt::format("{:.3f}", estimate.value) : "?";
}

std::string share_interval_text(const Estimate& estimate) {
  return estimate.bounded() ? fmt::format("{:.3f}..{:.3f}", estimate.low, estimate.high) : "?";
}

std::string same_everywhere(const OutputSensitivity& output) {
  if (output.share_without_answer >= 1.0) return "No loop of the spread has an answer.";
  return fmt::format("It is {} for every loop that answered: there is no variance to share out.",
                     with_digits(output.sobol.mean, 6));
}

/// An estimate with few digits, "?" if it is not known.
std::string estimate_text(const Estimate& estimate) {
  return estimate.known ? with_digits(estimate.value, index_digits) : "?";
}

double per_cent_a_per_cent(const LocalSensitivity& one, double derivative, double quantity) {
  return quantity != 0.0 ? derivative * one.value / quantity : std::numeric_limits<double>::quiet_NaN();
}

/// "+2.90" or "-2.90".
std::string with_sign(double value) { return (value > 0.0 ? "+" : "") + with_digits(value, 3); }

/// The number to which the amplitude is most sensitive.
const LocalSensitivity* strongest(const SensitivityReport& report) {
  const LocalSensitivity* best = nullptr;
  for (const auto& one : report.local)
    if (std::isfinite(one.amplitude) &&
        (best == nullptr || std::abs(one.amplitude * one.value) > std::abs(best->amplitude * best->value)))
      best = &one;
  return best;
}

std::string without_derivatives(const SensitivityReport& report) {
  if (report.local.empty())
    return "The derivatives of the limit cycle were not computed: they are not known with a dead time "
           "or a sampled controller.";
  return "The limit cycle has no derivative with respect to any number: " + report.local.front().why + ".";
}

}  // namespace

std::string sensitivity_answer(const SensitivityReport& report) {
  std::string out;
  if (const auto* best = strongest(report); best != nullptr && report.cycle)
    out += fmt::format("The cycle's amplitude is most sensitive to {}: +1 % gives {} %.", best->path,
                       with_sign(per_cent_a_per_cent(*best, best->amplitude, report.cycle->amplitude)));
  else if (report.cycle)
    out += without_derivatives(report);
  else
    out += "The loop has no stable limit cycle at the given values, so there is nothing to differentiate.";
  if (!report.global) return out;
  const Probability& hunting = report.global->hunting;
  if (hunting.among_decided.known) {
    out += fmt::format(" Over the given spread it hunts from one of two starts with probability {} ({} to {})",
                       as_percent(hunting.among_decided.value), as_percent(hunting.among_decided.low),
                       as_percent(hunting.among_decided.high));
    if (hunting.undecided > 0)
      out += fmt::format(", {} of {} loops undecided", hunting.undecided, hunting.yes + hunting.no + hunting.undecided);
    if (const std::size_t not_valid = report.global->not_valid; not_valid > 0)
      out += fmt::format(", {} other points of the spread being no valid case", not_valid);
    out += report.global->matters_most
               ? "; the most influential number is " + report.spread.parameters[*report.global->matters_most].path + "."
               : ".";
  }
  return out;
}

Table derivative_table(const SensitivityReport& report, const Units& units) {
  Table table{{{"number", "", Align::left},
               {"value", "its unit"},
               {"d amplitude", units.y + " / unit"},
               {"d period", "s / unit"},
               {"amplitude", "% per %"},
               {"period", "% per %"}},
              {}};
  if (!report.cycle) return table;
  for (const auto& one : report.local) {
    if (!one.why.empty()) continue;
    table.rows.push_back({short_path(one.path), with_digits(one.value, 6),
                          with_absolute_error(one.amplitude, one.amplitude_error),
                          with_absolute_error(one.period, one.period_error),
                          per_cent(one.amplitude, one.amplitude_error, one.value, report.cycle->amplitude),
                          per_cent(one.period, one.period_error, one.value, report.cycle->period)});
  }
  return table;
}

Table change_table(const SensitivityReport& report, const Units& units) {
  Table table{{{"number", "", Align::left},
               {"times", ""},
               {"value", "its unit"},
               {"outcome", "", Align::left},
               {"amplitude", units.y},
               {"period", "s"}},
              {}};
  for (const auto& change : report.one_at_a_time)
    table.rows.push_back({short_path(change.path), with_digits(change.factor, 3), with_digits(change.value, 6),
                          change.found.in_words(), with_digits(change.found.amplitude, 6),
                          with_digits(change.found.period, 6)});
  return table;
}

Table morris_table(const SensitivityReport& report, const OutputSensitivity& output) {
  Table table{{{"number", "", Align::left},
               {"mu*", output.output},
               {"95 %", ""},
               {"mu", output.output},
               {"sigma", output.output},
               {"effects", ""}},
              {}};
  for (const std::size_t i : output.morris.by_mu_star()) {
    const MorrisEffects& effects = output.morris.parameters[i];
    table.rows.push_back({short_path(report.spread.parameters[i].path), estimate_text(effects.mu_star),
                          interval_text(effects.mu_star), estimate_text(effects.mu), estimate_text(effects.sigma),
                          std::to_string(effects.effects)});
  }
  return table;
}

Table sobol_table(const SensitivityReport& report, const OutputSensitivity& output) {
  Table table{
      {{"number", "", Align::left}, {"first", "share"}, {"95 %", ""}, {"total", "share"}, {"95 % ", ""}, {"pairs", ""}},
      {}};
  for (const std::size_t i : output.sobol.by_total()) {
    const SobolIndex& index = output.sobol.parameters[i];
    table.rows.push_back({short_path(report.spread.parameters[i].path), share_text(index.first),
                          share_interval_text(index.first), share_text(index.total), share_interval_text(index.total),
                          std::to_string(index.total_pairs)});
  }
  return table;
}

Table band_table(const SensitivityReport& report, const Units& units) {
  Table table{{{"", "", Align::left}, {"low", ""}, {"median", ""}, {"high", ""}, {"loops", ""}}, {}};
  if (!report.global) return table;
  for (const OutputSensitivity& output : report.global->outputs) {
    if (!output.band) continue;
    const std::string unit = output.output == "amplitude" ? units.y : "s";
    const auto number = [](double value) { return with_digits(value, 4); };
    table.rows.push_back({output.output + (unit.empty() ? "" : " (" + unit + ")"), number(output.band->low),
                          number(output.band->median), number(output.band->high),
                          std::to_string(output.band->answers)});
  }
  return table;
}

std::vector<std::string> sensitivity_notes(const SensitivityReport& report) {
  std::vector<std::string> notes = report.notes;
  for (const auto& one : report.local)
    if (!one.why.empty()) notes.push_back("no derivative by " + short_path(one.path) + ": " + one.why);
  for (const auto& threshold : report.thresholds) {
    const std::string what = "the threshold of " + short_path(threshold.path);
    const auto same = [&](const ThresholdNumber& one) { return one.why == threshold.numbers.front().why; };
    if (threshold.numbers.empty()) continue;
    if (std::ranges::all_of(threshold.numbers, same)) {  // a reason common to all is stated once
      if (!threshold.numbers.front().why.empty())
        notes.push_back("no derivatives of " + what + ": " + threshold.numbers.front().why);
      continue;
    }
    for (const auto& one : threshold.numbers) {
      const auto told = [&](const LocalSensitivity& other) { return other.path == one.path && other.why == one.why; };
      if (!one.why.empty() && std::ranges::none_of(report.local, told))
        notes.push_back("no derivative of " + what + " by " + short_path(one.path) + ": " + one.why);
    }
  }
  return notes;
}

Document sensitivity_document(const std::string& title, const SensitivityReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(sensitivity_answer(report)));
  if (report.cycle && !report.local.empty())
    out.add("Derivatives of the cycle (exact, at the values of the case)", derivative_table(report, units));
  if (report.cycle && !report.local.empty())
    out.add("First harmonic and offset of the cycle", harmonic_table(report, units));
  for (std::size_t k = 0; k < report.predicted.size(); ++k) {
    const auto& predicted = report.predicted[k];
    out += "\n" + predicted_heading(report, k) + "\n" + wrapped(predicted_sentence(predicted, units));
    if (const Table table = predicted_table(predicted, units); !table.rows.empty())
      out.add_untitled(predicted_heading(report, k), table);
    if (const Table table = gain_table(predicted, units); !table.rows.empty()) {
      out += "Its gain N, at this amplitude and frequency\n";
      out.add_untitled("Its gain N, at this amplitude and frequency", table);
    }
  }
  for (const auto& threshold : report.thresholds) {
    out += "\nThreshold\n" + wrapped(threshold_sentence(threshold));
    if (const Table table = threshold_table(threshold); !table.rows.empty()) out.add_untitled("Threshold", table);
  }
  if (!report.one_at_a_time.empty()) out.add("One at a time", change_table(report, units));
  if (const Table bands = band_table(report, units); !bands.rows.empty())
    out.add("Where it hunts, 95 % of the loops lie between low and high", bands);
  if (report.global)
    for (const auto& output : report.global->outputs) {
      const bool correlated = output.sobol.parameters.empty();
      if (correlated && output.share_without_answer == 0.0) continue;
      out += fmt::format("\nOutput \"{}\": no answer from {} of the loops\n", output.output,
                         as_percent(output.share_without_answer));
      if (correlated) continue;
      if (output.sobol.deviation == 0.0) {
        out += wrapped(same_everywhere(output));
        continue;
      }
      out.add("Morris: mean effect of the whole range", morris_table(report, output));
      out.add("Sobol indices: shares of the variance", sobol_table(report, output));
      std::vector<std::string> notes = output.sobol.notes;
      notes.insert(notes.end(), output.morris.notes.begin(), output.morris.notes.end());
      out += notes_text(notes);
    }
  out += notes_text(sensitivity_notes(report));
  return out;
}

std::string sensitivity_text(const std::string& title, const SensitivityReport& report, const Units& units) {
  return sensitivity_document(title, report, units).text();
}

}  // namespace limcycle
