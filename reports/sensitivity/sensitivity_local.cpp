#include <fmt/format.h>

#include <cmath>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

std::string complex_text(std::complex<double> z, double error) {
  const double imaginary = std::abs(z.imag()) <= error ? 0.0 : z.imag();
  return fmt::format("{} {} {}j", with_absolute_error(z.real(), error), imaginary < 0.0 ? "-" : "+",
                     with_absolute_error(std::abs(imaginary), error));
}

}  // namespace

std::string per_cent(double derivative, double error, double value, double quantity) {
  if (quantity == 0.0) return "-";
  const double scale = value / quantity;
  return std::abs(derivative) <= error ? "0" : with_digits(derivative * scale, 4);
}

Table harmonic_table(const SensitivityReport& report, const Units& units) {
  Table table{{{"number", "", Align::left},
               {"d 1st harm.", units.y + " / unit"},
               {"d offset", units.y + " / unit"},
               {"1st harm.", "% per %"}},
              {}};
  if (!report.cycle) return table;
  for (const auto& one : report.local) {
    if (!one.why.empty()) continue;
    table.rows.push_back(
        {short_path(one.path), with_absolute_error(one.first_harmonic, one.first_harmonic_error),
         with_absolute_error(one.offset, one.offset_error),
         per_cent(one.first_harmonic, one.first_harmonic_error, one.value, report.cycle->first_harmonic)});
  }
  return table;
}

std::string predicted_sentence(const PredictedOscillation& predicted, const Units& units) {
  const PredictionDerivatives& found = predicted.found;
  if (found.status != Status::converged) return "No derivatives: " + found.why + ".";
  return fmt::format(
      "First harmonic {}, frequency {} rad/s, where N = {}; by the amplitude of the element's input dN/dA = {}, by the "
      "frequency dN/dw = {}.",
      Units::attach(with_digits(found.amplitude, 6), units.y), with_digits(found.frequency, 6),
      complex_text(found.gain, found.gain_error), complex_text(found.by_amplitude.gain, found.by_amplitude.error),
      complex_text(found.by_frequency.gain, found.by_frequency.error));
}

Table predicted_table(const PredictedOscillation& predicted, const Units& units) {
  Table table{{{"number", "", Align::left},
               {"d 1st harm.", units.y + " / unit"},
               {"d frequency", "rad/s / unit"},
               {"1st harm.", "% per %"},
               {"frequency", "% per %"}},
              {}};
  if (predicted.found.status != Status::converged) return table;
  for (const auto& one : predicted.numbers) {
    if (!one.why.empty()) continue;
    const PredictionDerivative& by = one.by;
    table.rows.push_back({short_path(one.path), with_absolute_error(by.amplitude, by.amplitude_error),
                          with_absolute_error(by.frequency, by.frequency_error),
                          per_cent(by.amplitude, by.amplitude_error, one.value, predicted.found.amplitude),
                          per_cent(by.frequency, by.frequency_error, one.value, predicted.found.frequency)});
  }
  return table;
}

Table gain_table(const PredictedOscillation& predicted, const Units& units) {
  const std::string unit = units.force + (units.input.empty() ? "" : "/" + units.input) + " / unit";
  Table table{{{"number", "", Align::left}, {"d Re N", unit}, {"d Im N", unit}}, {}};
  if (predicted.found.status != Status::converged) return table;
  for (const auto& one : predicted.numbers)
    if (one.why.empty() && std::abs(one.by.gain.gain) > one.by.gain.error)
      table.rows.push_back({short_path(one.path), with_absolute_error(one.by.gain.gain.real(), one.by.gain.error),
                            with_absolute_error(one.by.gain.gain.imag(), one.by.gain.error)});
  return table;
}

std::string predicted_heading(const SensitivityReport& report, std::size_t index) {
  const std::string heading = "What the describing function predicts";
  return report.predicted.size() < 2 ? heading
                                     : fmt::format("{}, {} of {}", heading, index + 1, report.predicted.size());
}

std::string threshold_sentence(const ThresholdSensitivity& threshold) {
  if (!threshold.known) return fmt::format("No threshold of {} was found: {}.", threshold.path, threshold.why);
  return fmt::format(
      "Hunting {} at {} = {} (now {}): {}.", threshold.begins ? "begins" : "ends", threshold.path,
      Units::attach(with_error(threshold.at, threshold.error), threshold.unit == "1" ? "" : threshold.unit),
      with_digits(threshold.value, 6), threshold.why);
}

Table threshold_table(const ThresholdSensitivity& threshold) {
  Table table{{{"number", "", Align::left},
               {"value", "its unit"},
               {"d threshold", threshold.unit + " / unit"},
               {"threshold", "% per %"}},
              {}};
  for (const auto& one : threshold.numbers) {
    if (!one.why.empty()) continue;
    table.rows.push_back({short_path(one.path), with_digits(one.value, 6),
                          with_absolute_error(one.by.value, one.by.error),
                          per_cent(one.by.value, one.by.error, one.value, threshold.at)});
  }
  return table;
}

}  // namespace limcycle
