#include "limcycle/reports/json.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"

namespace limcycle {
namespace {

Json pair(std::complex<double> value) { return Json::array({number(value.real()), number(value.imag())}); }

Json agreement_json(const Agreement& second) {
  return {{"rtol", second.rtol},
          {"agrees", second.agrees},
          {"verdict_agrees", second.verdict_agrees},
          {"outcome", to_string(second.outcome)},
          {"period_difference", number(second.period_difference)},
          {"amplitude_difference", number(second.amplitude_difference)},
          {"position_difference", number(second.position_difference)},
          {"end_difference", number(second.end_difference)},
          {"phase_drift", number(second.phase_drift)},
          {"parted", number(second.parted)},
          {"steps", second.steps},
          {"status", to_string(second.status)},
          {"why", second.why}};
}

/// Terms that do not apply to the loop are null, not zero.
Json energy_json(const EnergyBalance& energy) {
  const auto if_ = [](bool applies, double value) { return applies ? number(value) : Json(nullptr); };
  const bool plant = energy.of_plant, law = energy.of_friction, storage = energy.of_storage;
  return {{"of", plant ? "loop" : "friction"},
          {"supplied",
           {{"command", if_(plant, energy.command)},
            {"load", if_(plant, energy.load)},
            {"drive", if_(plant && law, energy.drive)},
            {"friction", if_(law, energy.rubbing)}}},
          {"stored",
           {{"kinetic", if_(plant, energy.kinetic)},
            {"potential", if_(plant, energy.potential)},
            {"friction", if_(storage, energy.in_friction)}}},
          {"dissipated",
           {{"viscous", if_(plant, energy.viscous)},
            {"friction", if_(law, energy.friction)},
            {"impulses", if_(energy.checks(), energy.impulses)}}},
          {"turnover", number(energy.turnover)},
          {"balance_difference", if_(energy.checks(), std::abs(energy.error()))},
          {"allowed", if_(energy.checks(), energy.allowed)},
          {"balanced", energy.checks() ? Json(energy.balanced()) : Json(nullptr)}};
}

std::string text_of(const std::string& command, const Provenance& provenance, const Json& body) {
  return json_document(command, provenance, json_text(body));
}

/// `sample_time`: of a sampled controller; 0: there is none.
Json cycle_json(const Cycle& cycle, double sample_time) {
  Json multipliers = Json::array();
  for (const auto& multiplier : cycle.multipliers) multipliers.push_back(pair(multiplier));
  return {{"amplitude", number(cycle.amplitude)},
          {"first_harmonic", number(cycle.first_harmonic)},
          {"period", number(cycle.period)},
          {"frequency", number(cycle.frequency())},
          {"offset", number(cycle.offset)},
          {"stable", or_null(cycle.stable)},
          {"multipliers", multipliers},
          {"multiplier_error", cycle.multipliers.empty() ? Json(nullptr) : number(cycle.multiplier_error)},
          {"sticking_fraction", number(cycle.sticking_fraction)},
          {"method", cycle.method},
          {"error", number(cycle.error)},
          {"residual", number(cycle.residual)},
          {"half_wave_symmetric", cycle.half_wave_symmetric},
          {"remembered", cycle.remembered},
          {"locked", sample_time > 0.0 ? Json(true) : Json(nullptr)},
          {"samples", sample_time > 0.0 ? Json(std::lround(cycle.period / sample_time)) : Json(nullptr)}};
}

/// The motion of a sampled loop whose period is no number of samples, as the cycle that it is on the mean.
Json unlocked_json(const IrregularMotion& motion) {
  Cycle mean;
  mean.amplitude = motion.mean_amplitude;
  mean.period = motion.mean_period;
  mean.first_harmonic = mean.offset = mean.sticking_fraction = mean.error = mean.residual = NAN;
  mean.stable = true;
  mean.method = "simulation";
  Json out = cycle_json(mean, 0.0);
  out["locked"] = false;
  out["spread"] = {{"period", number(0.5 * (motion.longest_period - motion.shortest_period))},
                   {"amplitude", number(0.5 * (motion.largest_amplitude - motion.smallest_amplitude))}};
  return out;
}

Json ends(const Interval& interval) { return pair({interval.low, interval.high}); }

Json trust_json(const std::optional<Trust>& trust) {
  if (!trust) return nullptr;
  const Band& band = trust->band;
  return {{"filter_ratio", number(trust->filter_ratio)},
          {"worst_harmonic", trust->worst_harmonic},
          {"harmonic_residual", number(trust->harmonic_residual)},
          {"sticking_fraction", number(trust->sticking_fraction)},
          {"band",
           {{"kind", to_string(band.kind)},
            {"verdict", to_string(band.verdict)},
            {"frequency", ends(band.frequency)},
            {"amplitude", ends(band.amplitude)},
            {"input_amplitude", ends(band.input_amplitude)},
            {"why", band.why}}},
          {"sentence", trust->sentence}};
}

Json absence_json(const std::optional<Absence>& absence) {
  if (!absence) return nullptr;
  Json undecided = Json::array();
  for (const auto& interval : absence->undecided) undecided.push_back(ends(interval));
  return {{"verdict", to_string(absence->verdict)},
          {"frequency", pair({absence->box.frequency_min, absence->box.frequency_max})},
          {"input_amplitude", pair({absence->box.amplitude_min, absence->box.amplitude_max})},
          {"undecided", undecided},
          {"why", absence->why}};
}

Json spread_json(const std::optional<RootSpread>& spread) {
  if (!spread) return nullptr;
  return {{"amplitude", number(spread->amplitude)}, {"frequency", number(spread->frequency)}};
}

Json prediction_json(const Prediction& prediction, const std::optional<std::size_t>& cycle) {
  Json out = {{"method", prediction.method},
              {"amplitude", number(prediction.amplitude)},
              {"frequency", number(prediction.frequency)},
              {"stable", or_null(prediction.stable)},
              {"verdict", to_string(prediction.verdict)},
              {"cycle", or_null(cycle)},
              {"input_amplitude", number(prediction.input_amplitude)},
              {"residual", number(prediction.residual)},
              {"why", prediction.why},
              {"harmonics", prediction.harmonics},
              {"uncertainty", spread_json(prediction.spread)},
              {"trust", trust_json(prediction.trust)}};
  if (prediction.sampling) out["sampling"] = spread_json(prediction.sampling);
  return out;
}

/// Appends a number as the library does; null for one that does not exist. A table has a million of them, so that no
/// Json is made for each.
void append_number(std::string& out, double value) {
  if (!std::isfinite(value)) {
    out += "null";
    return;
  }
  char buffer[64];
  out.append(buffer, nlohmann::detail::to_chars(buffer, buffer + sizeof buffer, value));
}

void append_pair(std::string& out, double first, double second) {
  out += '[';
  append_number(out, first);
  out += ',';
  append_number(out, second);
  out += ']';
}

void append_point(std::string& out, const DfPoint& point, const DescribingFunction& result) {
  // The zeros of a result without an answer are not values.
  const auto known = [&](double value) { return result.answered() ? value : NAN; };
  const auto add = [&](std::string_view key, double value) {
    out.append(key);
    append_number(out, value);
  };
  add("{\"amplitude\":", point.amplitude);
  add(",\"frequency\":", point.frequency);
  add(",\"bias\":", point.bias);
  out += ",\"gain\":";
  append_pair(out, known(result.gain.real()), known(result.gain.imag()));
  add(",\"mean\":", known(result.mean));
  out += ",\"harmonics\":[";
  for (std::size_t k = 0; k < result.harmonics.size(); ++k) {
    if (k > 0) out += ',';
    append_pair(out, known(result.harmonics[k].real()), known(result.harmonics[k].imag()));
  }
  add("],\"dissipation\":", known(result.dissipation));
  add(",\"error\":", known(result.error));
  out.append(R"(,"method":")").append(result.method);
  out.append(R"(","status":")").append(to_string(result.status)).append(R"("})");
}

/// The motions of a sampled loop that are not locked to its samples, each once, as cycles behind the others.
class UnlockedMotions {
 public:
  UnlockedMotions(const PredictReport& report, Json& cycles) {
    if (!(report.sample_time > 0.0)) return;
    for (const OutcomeOfStart& one : report.outcomes) {
      if (one.outcome != Outcome::irregular || index_of(one.irregular)) continue;
      known_.emplace_back(&one.irregular, cycles.size());
      cycles.push_back(unlocked_json(one.irregular));
    }
  }
  std::optional<std::size_t> index_of(const IrregularMotion& motion) const {
    const auto same = std::ranges::find_if(known_, [&](const auto& other) { return agree(*other.first, motion); });
    return same == known_.end() ? std::nullopt : std::optional(same->second);
  }

 private:
  std::vector<std::pair<const IrregularMotion*, std::size_t>> known_;
};

Json outcome_json(const OutcomeOfStart& outcome, const std::optional<std::size_t>& cycle) {
  Json out = {{"start", outcome.start},
              {"outcome", to_string(outcome.outcome)},
              {"cycle", or_null(cycle)},
              {"why", outcome.why}};
  if (!outcome.by.empty()) out["by"] = outcome.by;
  if (outcome.outcome == Outcome::irregular) {
    out["half_range"] = number(outcome.irregular.half_range);
    out["mean_period"] = number(outcome.irregular.mean_period);
    out["periods"] = {number(outcome.irregular.shortest_period), number(outcome.irregular.longest_period)};
    out["observed"] = number(outcome.irregular.observed);
    if (outcome.irregular.beat_frequency > 0.0) out["beat_frequency"] = number(outcome.irregular.beat_frequency);
  }
  return out;
}

}  // namespace

std::string df_json(const Provenance& provenance, const std::vector<DfPoint>& points,
                    const std::vector<DescribingFunction>& results) {
  if (results.size() > points.size()) throw std::invalid_argument("more describing functions than points");
  std::string out = json_beginning("df", provenance);
  if (!results.empty()) out.reserve(out.size() + results.size() * (260 + 48 * results.front().harmonics.size()));
  out += ",\n  \"points\": [";
  for (std::size_t i = 0; i < results.size(); ++i) {
    out += i == 0 ? "\n    " : ",\n    ";
    append_point(out, points[i], results[i]);
  }
  if (!results.empty()) out += "\n  ";
  out += "],\n  \"status\": \"";
  out += status_word(provenance, results.size() < points.size() ? Status::interrupted : Status::converged);
  return out += "\"\n}\n";
}

std::string predict_json(const Provenance& provenance, const PredictReport& report) {
  Json top;
  for (const char* key : {"cycles", "predictions", "missed", "outcomes"}) top[key] = Json::array();
  for (const auto& cycle : report.cycles) top["cycles"].push_back(cycle_json(cycle, report.sample_time));
  const UnlockedMotions unlocked(report, top["cycles"]);
  for (const auto& prediction : report.predictions)
    top["predictions"].push_back(
        prediction_json(prediction, prediction.motion ? unlocked.index_of(*prediction.motion) : prediction.cycle));
  for (const auto& missed : report.missed)
    top["missed"].push_back({{"method", missed.method}, {"cycle", missed.cycle}});
  for (const auto& outcome : report.outcomes) {
    const bool irregular = outcome.outcome == Outcome::irregular;
    top["outcomes"].push_back(outcome_json(outcome, irregular ? unlocked.index_of(outcome.irregular) : outcome.cycle));
  }
  top["search"] = {
      {"amplitude", Json::array({number(report.search.amplitude_min), number(report.search.amplitude_max)})},
      {"frequency", Json::array({number(report.search.frequency_min), number(report.search.frequency_max)})}};
  top["absence"] = absence_json(report.absence);
  top["cause"] = report.cause ? Json{{"kind", report.cause->kind}, {"why", report.cause->why}} : Json(nullptr);
  top["notes"] = report.notes;
  top["status"] = to_string(report.status);
  return text_of("predict", provenance, top);
}

std::string simulate_json(const Provenance& provenance, const Simulation& run, const std::optional<Agreement>& second,
                          const std::optional<EnergyBalance>& energy) {
  Json top;
  top["columns"] = run.columns;
  top["rows"] = Json::array();
  for (const auto& row : run.rows) {
    Json line = Json::array();
    for (const double value : row) line.push_back(number(value));
    top["rows"].push_back(std::move(line));
  }
  top["events"] = Json::array();
  for (const auto& event : run.events) top["events"].push_back({{"t", number(event.t)}, {"what", event.what}});
  top["outcome"] = to_string(run.outcome);
  const bool periodic = run.outcome == Outcome::cycle || run.outcome == Outcome::family;
  top["period"] = periodic ? number(run.period) : Json(nullptr);
  top["amplitude"] = periodic ? number(run.amplitude) : Json(nullptr);
  top["agreement"] = second ? agreement_json(*second) : Json(nullptr);
  top["energy"] = energy ? energy_json(*energy) : Json(nullptr);
  top["stepper"] = run.stepper;
  top["steps"] = run.steps;
  top["status"] = to_string(run.status);
  top["notes"] = run.notes;
  top["why"] = run.why;
  return text_of("simulate", provenance, top);
}

}  // namespace limcycle
