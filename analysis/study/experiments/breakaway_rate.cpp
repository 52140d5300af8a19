#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/breakaway.hpp"

namespace limcycle {
namespace {

std::string rate_in_words(double rate) { return quantity(rate, "N/s"); }

/// "rises", "falls" or "stays" from the first to the last of some values, by the sign of every step.
std::string trend_over_rate(const std::vector<double>& values) {
  bool up = true, down = true;
  const double least = 2e-5 * std::abs(values.front());
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || !std::isfinite(values[i - 1])) return "is not known";
    up = up && values[i] >= values[i - 1] - least;
    down = down && values[i] <= values[i - 1] + least;
  }
  if (up && down) return "stays";
  return up ? "rises" : down ? "falls" : "goes both ways";
}

std::vector<double> column(const Experiment& e, const std::string& law, const std::string& key,
                           std::span<const double> rates) {
  std::vector<double> values;
  for (const double rate : rates) values.push_back(e.value(law, key, rate_in_words(rate)));
  return values;
}

LawPart rates_of(const LawSetting& setting, std::span<const double> rates, bool over_rate) {
  LawPart part;
  std::vector<double> peaks, applied;
  for (const double rate : rates) {
    const BreakAway one = break_away(setting, rate, gross_displacement(setting));
    if (one.run.status != Status::converged) part.status = one.run.status;
    peaks.push_back(one.peak);
    applied.push_back(one.applied);
    part.rows.push_back({"", rate_in_words(rate), {one.peak, one.displacement, one.velocity, one.applied}});
    if (over_rate) continue;
    std::vector<double> u, F;
    for (std::size_t i = 0; i < one.run.u.size() && (one.run.u[i] < one.peak || one.run.F[i] > 0.93 * one.peak); ++i)
      if (one.run.u[i] > 0.93 * one.peak) {
        u.push_back(one.run.u[i]);
        F.push_back(one.run.F[i]);
      }
    part.add(0, thinned(rate_in_words(rate), one.run.x, one.run.F, 200));
    part.add(1, thinned(rate_in_words(rate), u, F, 200));
  }
  const std::vector<double> x(rates.begin(), rates.end());
  if (over_rate) {
    part.add(0, {"peak of friction", x, peaks});
    part.add(0, {"applied at gross displacement", x, applied});
  }
  part.finding = "peak " + trend_over_rate(peaks) + " with the rate (" + quantity(peaks.front(), "N", 5) + " to " +
                 quantity(peaks.back(), "N", 5) + "); applied force at " + quantity(gross_displacement(setting), "m") +
                 " " + trend_over_rate(applied) + " (" + quantity(applied.front(), "N", 5) + " to " +
                 quantity(applied.back(), "N", 5) + ")";
  return part;
}

constexpr std::array thesis_rates{0.05, 0.1, 0.2};
constexpr std::array paper_rates{0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0};

const std::vector<Quantity> quantities{{"peak", "peak force", "N"},
                                       {"displacement", "x at peak", "m"},
                                       {"velocity", "v at peak", "m/s"},
                                       {"applied", "u at gross x", "N"}};

const std::string definitions =
    "Break-away force by two definitions: the largest friction force before sliding, and the applied force when the "
    "body "
    "has moved a fixed gross distance: twice the break-away displacement, 0.002 m (0.0288 m for the soft gms)";

ExperimentClaim rises_with_rate(const Experiment& e) {
  ExperimentClaim claim{"the break-away force of the proposed law rises with the force rate",
                        "thesis, section 3.6.2, figure 3.37", ClaimOutcome::not_tested, ""};
  if (!has_law(e, "non-drift")) return claim;
  const auto peaks = column(e, "non-drift", "peak", thesis_rates);
  const auto applied = column(e, "non-drift", "applied", thesis_rates);
  const bool by_peak = trend_over_rate(peaks) == "rises", by_applied = trend_over_rate(applied) == "rises";
  claim.outcome = by_peak && by_applied   ? ClaimOutcome::confirmed
                  : by_peak != by_applied ? ClaimOutcome::depends
                                          : ClaimOutcome::not_confirmed;
  claim.measure = "from 0.05 to 0.2 N/s the peak " + trend_over_rate(peaks) + " by " +
                  change(peaks.front(), peaks.back()) + ", the applied force at gross displacement " +
                  trend_over_rate(applied) + " by " + change(applied.front(), applied.back());
  return claim;
}

ExperimentClaim lugre_falls(const Experiment& e, std::span<const double> rates) {
  ExperimentClaim claim{"the higher the force rate, the lower the break-away force (LuGre)",
                        "pendulum paper, figure 1b and text", ClaimOutcome::not_tested, ""};
  if (!has_law(e, "lugre")) return claim;
  const auto peaks = column(e, "lugre", "peak", rates);
  claim.outcome = trend_over_rate(peaks) == "falls" ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
  claim.measure = "the peak " + trend_over_rate(peaks) + " from " + quantity(peaks.front(), "N", 5) + " to " +
                  quantity(peaks.back(), "N", 5);
  return claim;
}

}  // namespace

Experiment breakaway_rate_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "breakaway-rate";
  e.title = "Break-away at three force rates";
  e.document = "thesis, figure 3.37";
  e.input = "a mass of 1 kg under a force that rises with 0.05, 0.1 and 0.2 N/s, as in the thesis. " + definitions;
  e.quantities = quantities;
  e.figures = {
      {"force-displacement", "Friction force over displacement", "x", "m", "F", "N"},
      {"force-applied", "Friction force over applied force about break-away (figure 3.37)", "u", "N", "F", "N"}};
  run_by_law(e, options, [](const LawSetting& setting) { return rates_of(setting, thesis_rates, false); });
  e.claims = {rises_with_rate(e), lugre_falls(e, thesis_rates)};
  e.notes.emplace_back(
      "where inertia and lag do not matter, velocity and force depend on rate and Zb through their product alone: by "
      "one "
      "quasi-static definition the break-away force cannot rise with the rate and fall with Zb");
  return e;
}

Experiment breakaway_force_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "breakaway-force";
  e.title = "Break-away force over force rate";
  e.document = "pendulum paper, figure 1b";
  e.input = "a mass of 1 kg under a force that rises with 0.05 to 50 N/s (the paper's figure has no legible range). " +
            definitions;
  e.quantities = quantities;
  e.figures = {{"force-rate", "Break-away force over force rate (figure 1b)", "rate", "N/s", "force", "N", true}};
  run_by_law(e, options, [](const LawSetting& setting) { return rates_of(setting, paper_rates, true); });
  e.claims = {lugre_falls(e, paper_rates)};
  return e;
}

}  // namespace limcycle
