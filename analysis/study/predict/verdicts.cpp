#include "limcycle/analysis/study/predict/verdicts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr double agreement = 0.05;      ///< relative difference up to which a prediction is confirmed (design 5.3)
constexpr double amplitude_reach = 10;  ///< a prediction farther off does not refer to that cycle
constexpr double frequency_reach = 3;

std::string percent_off(double ratio) {
  return (ratio < 1.0 ? "" : "+") + short_number(100.0 * (ratio - 1.0), 3) + " %";
}

}  // namespace

std::size_t merge(std::vector<Cycle>& cycles, const Cycle& cycle) {
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const double tolerance = 1e-6 + 10.0 * (cycles[i].error + cycle.error);
    const auto alike = [&](double Cycle::*size) { return std::abs(cycles[i].*size / cycle.*size - 1.0) < tolerance; };
    const bool one_family = cycles[i].remembered > 0 && cycles[i].remembered == cycle.remembered;
    if (alike(&Cycle::period) && alike(&Cycle::amplitude) && alike(&Cycle::first_harmonic) &&
        (one_family ||
         std::abs(cycles[i].offset - cycle.offset) < tolerance * cycle.amplitude + 1e-6 * cycle.amplitude))
      return i;
  }
  cycles.push_back(cycle);
  return cycles.size() - 1;
}

std::optional<std::size_t> nearest(const std::vector<Cycle>& cycles, const Prediction& prediction) {
  std::optional<std::size_t> best;
  double best_distance = infinite;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const double a = std::abs(std::log(prediction.amplitude / cycles[i].first_harmonic));
    const double w = std::abs(std::log(prediction.frequency / cycles[i].frequency()));
    if (a > std::log(amplitude_reach) || w > std::log(frequency_reach)) continue;
    if (a + w < best_distance) {
      best_distance = a + w;
      best = i;
    }
  }
  return best;
}

bool is_close(const Prediction& prediction, const Cycle& cycle) {
  return std::abs(prediction.amplitude / cycle.first_harmonic - 1.0) <= agreement &&
         std::abs(prediction.frequency / cycle.frequency() - 1.0) <= agreement;
}

void compare(Prediction& prediction, const std::vector<Cycle>& cycles, std::size_t cycle) {
  const double amplitude = prediction.amplitude / cycles[cycle].first_harmonic;
  const double frequency = prediction.frequency / cycles[cycle].frequency();
  prediction.cycle = cycle;
  prediction.verdict = is_close(prediction, cycles[cycle]) ? Verdict::confirmed : Verdict::biased;
  prediction.why =
      "first harmonic " + percent_off(amplitude) + ", frequency " + percent_off(frequency) + " against the true cycle";
  if (prediction.stable && cycles[cycle].stable && *prediction.stable != *cycles[cycle].stable) {
    prediction.verdict = Verdict::biased;
    prediction.why += "; its stability is wrong";
  }
}

bool compare(Prediction& prediction, const IrregularMotion& motion) {
  const double amplitude = prediction.amplitude / motion.mean_amplitude;
  const double frequency = prediction.frequency * motion.mean_period / (2.0 * std::numbers::pi);
  if (!(std::abs(std::log(amplitude)) <= std::log(amplitude_reach)) ||
      !(std::abs(std::log(frequency)) <= std::log(frequency_reach)))
    return false;
  const bool close = std::abs(amplitude - 1.0) <= agreement && std::abs(frequency - 1.0) <= agreement;
  prediction.motion = motion;
  prediction.verdict = close ? Verdict::confirmed : Verdict::biased;
  prediction.why = "amplitude " + percent_off(amplitude) + ", frequency " + percent_off(frequency) +
                   " against the mean of a motion that is locked to no sample";
  return true;
}

std::vector<Missed> missed_by(const std::string& method, const std::vector<Cycle>& cycles,
                              const std::vector<Prediction>& predictions) {
  std::vector<Missed> missed;
  for (std::size_t i = 0; i < cycles.size(); ++i)
    if (std::ranges::none_of(predictions, [&](const Prediction& p) { return p.method == method && p.cycle == i; }))
      missed.push_back({method, i});
  return missed;
}

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::confirmed:
      return "confirmed";
    case Verdict::biased:
      return "biased";
    case Verdict::wrong:
      return "false";
    default:
      return "undecided";
  }
}

bool searched_completely(const PredictReport& report, const std::string& method) {
  return std::ranges::find(report.incomplete, method) == report.incomplete.end();
}

const Cycle* largest_stable(const std::vector<Cycle>& cycles) {
  const Cycle* found = nullptr;
  for (const Cycle& cycle : cycles)
    if (cycle.stable == true && (found == nullptr || cycle.amplitude > found->amplitude)) found = &cycle;
  return found;
}

}  // namespace limcycle
