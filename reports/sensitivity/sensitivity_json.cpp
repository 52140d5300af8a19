#include <cmath>
#include <complex>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

Json value_json(const Estimate& estimate) { return estimate.known ? number(estimate.value) : Json(nullptr); }

Json interval_json(const Estimate& estimate) {
  return estimate.bounded() ? Json::array({number(estimate.low), number(estimate.high)}) : Json(nullptr);
}

double elasticity_of(const LocalSensitivity& one, double derivative, double quantity) {
  return quantity != 0.0 ? derivative * one.value / quantity : std::numeric_limits<double>::quiet_NaN();
}

Json local_json(const LocalSensitivity& one, const Cycle& cycle) {
  Json multipliers = Json::array();
  for (const auto& value : one.multipliers)
    multipliers.push_back(Json::array({number(value.real()), number(value.imag())}));
  return {{"name", one.path},
          {"unit", one.unit},
          {"value", number(one.value)},
          {"derivative",
           {{"amplitude", number(one.amplitude)},
            {"period", number(one.period)},
            {"first_harmonic", number(one.first_harmonic)},
            {"offset", number(one.offset)},
            {"multipliers", multipliers}}},
          {"elasticity",
           {{"amplitude", number(elasticity_of(one, one.amplitude, cycle.amplitude))},
            {"period", number(elasticity_of(one, one.period, cycle.period))},
            {"first_harmonic", number(elasticity_of(one, one.first_harmonic, cycle.first_harmonic))}}},
          {"error", number(one.error)},
          {"errors",
           {{"amplitude", number(one.amplitude_error)},
            {"period", number(one.period_error)},
            {"first_harmonic", number(one.first_harmonic_error)},
            {"offset", number(one.offset_error)}}},
          {"why", one.why}};
}

Json pair_json(std::complex<double> z) { return Json::array({number(z.real()), number(z.imag())}); }

Json predicted_json(const PredictedOscillation& predicted) {
  const PredictionDerivatives& found = predicted.found;
  if (found.status != Status::converged) return {{"why", found.why}, {"parameters", Json::array()}};
  Json parameters = Json::array();
  for (const auto& one : predicted.numbers) {
    Json row = {{"name", one.path}, {"unit", one.unit}, {"value", number(one.value)}, {"why", one.why}};
    const bool known = one.why.empty();
    const auto told = [known](double value) { return known ? number(value) : Json(nullptr); };
    row["derivative"] = {{"gain", known ? pair_json(one.by.gain.gain) : Json(nullptr)},
                         {"amplitude", told(one.by.amplitude)},
                         {"frequency", told(one.by.frequency)}};
    row["elasticity"] = {{"amplitude", told(one.by.amplitude * one.value / found.amplitude)},
                         {"frequency", told(one.by.frequency * one.value / found.frequency)}};
    row["errors"] = {{"gain", told(one.by.gain.error)},
                     {"amplitude", told(one.by.amplitude_error)},
                     {"frequency", told(one.by.frequency_error)}};
    parameters.push_back(std::move(row));
  }
  return {{"amplitude", number(found.amplitude)},
          {"frequency", number(found.frequency)},
          {"input_amplitude", number(found.input_amplitude)},
          {"gain", pair_json(found.gain)},
          {"gain_by_amplitude", pair_json(found.by_amplitude.gain)},
          {"gain_by_frequency", pair_json(found.by_frequency.gain)},
          {"errors",
           {{"gain", number(found.gain_error)},
            {"gain_by_amplitude", number(found.by_amplitude.error)},
            {"gain_by_frequency", number(found.by_frequency.error)}}},
          {"why", ""},
          {"parameters", parameters}};
}

Json threshold_json(const ThresholdSensitivity& threshold) {
  Json parameters = Json::array();
  for (const auto& one : threshold.numbers) {
    const bool known = one.why.empty();
    const auto told = [known](double value) { return known ? number(value) : Json(nullptr); };
    parameters.push_back({{"name", one.path},
                          {"unit", one.unit},
                          {"value", number(one.value)},
                          {"derivative", told(one.by.value)},
                          {"elasticity", told(threshold.at != 0.0 ? one.by.value * one.value / threshold.at : NAN)},
                          {"error", told(one.by.error)},
                          {"why", one.why}});
  }
  const bool known = threshold.known;
  return {{"name", threshold.path},
          {"unit", threshold.unit},
          {"value", number(threshold.value)},
          {"what", !known             ? "none"
                   : threshold.begins ? "begins"
                                      : "ends"},
          {"at", known ? number(threshold.at) : Json(nullptr)},
          {"error", known ? number(threshold.error) : Json(nullptr)},
          {"why", threshold.why},
          {"parameters", parameters}};
}

Json change_json(const ParameterChange& change) {
  Json outcomes = Json::array();
  for (const Outcome outcome : change.found.outcomes) outcomes.push_back(to_string(outcome));
  return {{"name", change.path},
          {"factor", number(change.factor)},
          {"value", number(change.value)},
          {"valid", !change.found.outcomes.empty()},
          {"hunts", change.found.has(Outcome::cycle)},
          {"outcomes", outcomes},
          {"amplitude", number(change.found.amplitude)},
          {"period", number(change.found.period)}};
}

void add_output(const SensitivityReport& report, const OutputSensitivity& output, Json& morris, Json& sobol,
                Json& interactions, Json& convergence) {
  const auto name = [&](std::size_t i) { return report.spread.parameters[i].path; };
  for (std::size_t i = 0; i < output.morris.parameters.size(); ++i) {
    const MorrisEffects& effects = output.morris.parameters[i];
    morris.push_back({{"name", name(i)},
                      {"output", output.output},
                      {"mu_star", value_json(effects.mu_star)},
                      {"sigma", value_json(effects.sigma)},
                      {"mu", value_json(effects.mu)},
                      {"mu_star_interval", interval_json(effects.mu_star)},
                      {"effects", effects.effects},
                      {"without_answer", effects.without_answer}});
  }
  for (std::size_t i = 0; i < output.sobol.parameters.size(); ++i) {
    const SobolIndex& index = output.sobol.parameters[i];
    sobol.push_back({{"name", name(i)},
                     {"output", output.output},
                     {"first", value_json(index.first)},
                     {"total", value_json(index.total)},
                     {"first_interval", interval_json(index.first)},
                     {"total_interval", interval_json(index.total)},
                     {"pairs", index.total_pairs}});
  }
  for (const auto& pair : output.sobol.interactions)
    interactions.push_back({{"names", {name(pair.one), name(pair.other)}},
                            {"output", output.output},
                            {"share", value_json(pair.share)},
                            {"interval", interval_json(pair.share)}});
  for (const auto& stage : output.convergence)
    for (std::size_t i = 0; i < stage.parameters.size(); ++i)
      convergence.push_back({{"name", name(i)},
                             {"output", output.output},
                             {"samples", stage.samples},
                             {"first", value_json(stage.parameters[i].first)},
                             {"total", value_json(stage.parameters[i].total)}});
}

Json robustness_json(const SensitivityReport& report) {
  const Probability& hunting = report.global->hunting;
  const auto& most = report.global->matters_most;
  return {{"probability_of_hunting", value_json(hunting.among_decided)},
          {"interval", interval_json(hunting.among_decided)},
          {"hunting", hunting.yes},
          {"not_hunting", hunting.no},
          {"undecided", hunting.undecided},
          {"not_valid", report.global->not_valid},
          {"bounds", Json::array({number(hunting.low), number(hunting.high)})},
          {"matters_most", most ? Json(report.spread.parameters[*most].path) : Json(nullptr)}};
}

/// Rows of predictions and thresholds.
std::string derivative_rows(const SensitivityReport& report) {
  std::string out;
  const auto row = [&](const char* kind, const std::string& name, const std::string& output, double value) {
    out += csv_line({kind, name, output, shortest(value), "", "", "", "derivative"});
  };
  for (std::size_t k = 0; k < report.predicted.size(); ++k)
    for (const auto& one : report.predicted[k].numbers) {
      if (!one.why.empty() || report.predicted[k].found.status != Status::converged) continue;
      const std::string of = " of prediction " + std::to_string(k);
      row("predicted", one.path, "amplitude" + of, one.by.amplitude);
      row("predicted", one.path, "frequency" + of, one.by.frequency);
      row("predicted", one.path, "real gain" + of, one.by.gain.gain.real());
      row("predicted", one.path, "imaginary gain" + of, one.by.gain.gain.imag());
    }
  for (const auto& threshold : report.thresholds)
    for (const auto& one : threshold.numbers)
      if (one.why.empty()) row("threshold", one.path, threshold.path, one.by.value);
  return out;
}

}  // namespace

std::string sensitivity_json(const Provenance& provenance, const SensitivityReport& report, Status ended) {
  Json parameters = Json::array(), changes = Json::array(), morris = Json::array(), sobol = Json::array(),
       interactions = Json::array(), convergence = Json::array(), without = Json::object();
  if (report.cycle)
    for (const auto& one : report.local) parameters.push_back(local_json(one, *report.cycle));
  for (const auto& change : report.one_at_a_time) changes.push_back(change_json(change));
  double share = 0.0;
  if (report.global)
    for (const auto& output : report.global->outputs) {
      add_output(report, output, morris, sobol, interactions, convergence);
      without[output.output] = number(output.share_without_answer);
      if (output.output == EnsembleOutcome::names[1]) share = output.share_without_answer;
    }
  Json bands = Json::array(), correlations = Json::array();
  if (report.global)
    for (const auto& output : report.global->outputs)
      if (output.band)
        bands.push_back({{"output", output.output},
                         {"low", number(output.band->low)},
                         {"median", number(output.band->median)},
                         {"high", number(output.band->high)},
                         {"answers", output.band->answers}});
  const auto& spread = report.spread.parameters;
  for (const auto& pair : report.spread.correlations)
    correlations.push_back({{"between", {spread[pair.one].path, spread[pair.other].path}}, {"value", pair.value}});
  Json predicted = Json::array(), thresholds = Json::array();
  for (const auto& one : report.predicted) predicted.push_back(predicted_json(one));
  for (const auto& one : report.thresholds) thresholds.push_back(threshold_json(one));
  const Json body = {{"answer", sensitivity_answer(report)},
                     {"cycle", report.cycle ? Json{{"amplitude", number(report.cycle->amplitude)},
                                                   {"period", number(report.cycle->period)},
                                                   {"first_harmonic", number(report.cycle->first_harmonic)},
                                                   {"offset", number(report.cycle->offset)},
                                                   {"error", number(report.cycle->error)}}
                                            : Json(nullptr)},
                     {"parameters", parameters},
                     {"predicted", predicted},
                     {"thresholds", thresholds},
                     {"one_at_a_time", changes},
                     {"morris", morris},
                     {"sobol", sobol},
                     {"interactions", interactions},
                     {"convergence", convergence},
                     {"bands", bands},
                     {"correlations", correlations},
                     {"robustness", report.global ? robustness_json(report) : Json(nullptr)},
                     {"share_without_answer", report.global ? number(share) : Json(nullptr)},
                     {"without_answer", without},
                     {"notes", report.notes},
                     {"status", to_string(ended)}};
  return json_document("sensitivity", provenance, json_text(body));
}

std::string sensitivity_csv(const SensitivityReport& report) {
  std::string out = csv_line({"kind", "name", "output", "value", "low", "high", "factor", "what"});
  const auto row = [&](const char* kind, const std::string& name, const std::string& output, double value,
                       const Estimate* interval, const std::string& factor, const std::string& what) {
    const bool bounded = interval != nullptr && interval->bounded();
    out += csv_line({kind, name, output, shortest(value), bounded ? shortest(interval->low) : "",
                     bounded ? shortest(interval->high) : "", factor, what});
  };
  const auto estimate = [&](const char* kind, const std::string& name, const std::string& output, const Estimate& one,
                            const std::string& what) {
    if (one.known) row(kind, name, output, one.value, &one, "", what);
  };
  for (const auto& one : report.local) {
    row("local", one.path, "amplitude", one.amplitude, nullptr, "", "derivative");
    row("local", one.path, "period", one.period, nullptr, "", "derivative");
    row("local", one.path, "first_harmonic", one.first_harmonic, nullptr, "", "derivative");
    row("local", one.path, "offset", one.offset, nullptr, "", "derivative");
  }
  out += derivative_rows(report);
  for (const auto& change : report.one_at_a_time) {
    row("one-at-a-time", change.path, "amplitude", change.found.amplitude, nullptr, shortest(change.factor),
        change.found.in_words());
    row("one-at-a-time", change.path, "period", change.found.period, nullptr, shortest(change.factor),
        change.found.in_words());
  }
  if (!report.global) return out;
  for (const auto& output : report.global->outputs) {
    if (output.band) {
      const Estimate median{output.band->median, output.band->low, output.band->high, true};
      estimate("band", "", output.output, median, "median");
    }
    const auto name = [&](std::size_t i) { return report.spread.parameters[i].path; };
    for (std::size_t i = 0; i < output.morris.parameters.size(); ++i) {
      estimate("morris", name(i), output.output, output.morris.parameters[i].mu_star, "mu_star");
      estimate("morris", name(i), output.output, output.morris.parameters[i].sigma, "sigma");
    }
    for (std::size_t i = 0; i < output.sobol.parameters.size(); ++i) {
      estimate("sobol", name(i), output.output, output.sobol.parameters[i].first, "first");
      estimate("sobol", name(i), output.output, output.sobol.parameters[i].total, "total");
    }
    for (const auto& pair : output.sobol.interactions)
      estimate("interaction", name(pair.one) + " " + name(pair.other), output.output, pair.share, "second");
  }
  return out;
}

}  // namespace limcycle
