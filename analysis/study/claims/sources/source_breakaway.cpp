#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/claims/sources/source_documents.hpp"
#include "limcycle/analysis/study/experiments/runs/breakaway.hpp"

namespace limcycle {
namespace {

constexpr double ramp = 0.1;  // N/s

/// Break-away of a law with one parameter at half, once and twice its value.
struct Triple {
  std::array<BreakAway, 3> at;
  std::string where;
  Status status = Status::converged;
};

Triple varied_over(const LawSetting& setting, const std::string& key, const std::function<bool()>& stop) {
  Triple triple;
  triple.where = values_of(setting);
  constexpr std::array factors{0.5, 1.0, 2.0};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    LawSetting changed = setting.scaled(key, factors[i]);
    changed.stop = stop;
    // The gross displacement stays that of the original law, as the reference.
    triple.at[i] = break_away(changed, ramp, gross_displacement(setting));
    if (triple.at[i].run.status != Status::converged) triple.status = triple.at[i].run.status;
  }
  return triple;
}

/// Half against once, and once against twice the parameter: the number rises, falls, or hardly changes (1 %).
enum class Trend { up, down, small };

void compare(const Triple& triple, double BreakAway::*number, const std::string& name, const std::string& unit,
             const std::string& key, Trend trend, ClaimChecks& checks) {
  constexpr std::array words{"half to once", "once to twice"};
  for (std::size_t i = 0; i < 2; ++i) {
    const double from = triple.at[i].*number, to = triple.at[i + 1].*number;
    const std::string where = triple.where + ", " + key + " from " + words[i];
    // If nothing changes, the peak is located to a relative 1e-8 or so.
    const double rounding = 1e-7 * std::abs(from);
    if (trend == Trend::up)
      checks.at_least(where, name, unit, from, to, rounding);
    else if (trend == Trend::down)
      checks.at_most(where, name, unit, from, to, rounding);
    else
      checks.equal(where, name, unit, from, to, 0.01);
  }
}

struct TrendClaim {
  std::string id, statement, key;
  double BreakAway::*number;
  std::string name, unit;
  Trend trend;
  bool random;  ///< also at random parameters
  std::string source;
};

Claim trend_claim(const TrendClaim& one) {
  return {one.id,
          one.statement,
          "",
          "thesis, section 3.6.2, " + one.source + " (the law is a reconstruction)",
          Evidence::reconstruction,
          "the thesis's default parameters, " + one.key + " at half, once and twice its value" +
              (one.random ? "; the same about random parameters: Fc from 0.4 to 3 N, Fs up to 2 Fc, the others up to 3 "
                            "times smaller or larger"
                          : ""),
          "force ramp of 0.1 N/s on a mass of 1 kg; break-away force: the largest friction force before the gross "
          "displacement of 2 Zb",
          ClaimVerdict::holds,
          [one](const ClaimOptions& options) {
            ClaimChecks checks;
            RandomShares random(options.seed);
            for (int k = 0; k <= (one.random ? options.random_points / 4 : 0); ++k) {
              checks.random(k > 0);
              const LawSetting setting = k == 0 ? document_law("non-drift") : random_proposed_law(random);
              const Triple triple = varied_over(setting, one.key, options.stop);
              if (triple.status != Status::converged) checks.stop(triple.status);
              compare(triple, one.number, one.name, one.unit, one.key, one.trend, checks);
            }
            return checks.result();
          }};
}

/// Peaks of a law over the force rate, each against the one before.
ClaimResult over_rates(const std::string& label, const std::vector<double>& rates, bool rises,
                       const ClaimOptions& options, const std::string& finding) {
  ClaimChecks checks;
  LawSetting setting = document_law(label);
  setting.stop = options.stop;
  double before = NAN;
  for (const double rate : rates) {
    const BreakAway one = break_away(setting, rate, gross_displacement(setting));
    if (one.run.status != Status::converged) checks.stop(one.run.status);
    const std::string where = short_number(rate) + " N/s against the rate before";
    if (rate != rates.front() && rises) checks.at_least(where, "largest friction force", "N", before, one.peak, 0.0);
    if (rate != rates.front() && !rises) checks.at_most(where, "largest friction force", "N", before, one.peak, 0.0);
    before = one.peak;
  }
  return checks.result(finding);
}

/// Rate and Zb changed at a constant product: the argument against the thesis's statement, tested itself.
ClaimResult scaling(const ClaimOptions& options) {
  ClaimChecks checks;
  RandomShares random(options.seed);
  // Slow compared with the lag and with little inertia, as the argument requires.
  const LawSetting setting = document_law("non-drift").scaled("tau", 0.01);
  const double gross = gross_displacement(setting);
  for (int k = 0; k <= options.random_points / 4; ++k) {
    checks.random(k > 0);
    const double factor = k == 0 ? 2.0 : random.log_between(0.4, 2.5);
    LawSetting scaled = setting.scaled("Zb", factor);
    scaled.stop = options.stop;
    const BreakAway one = break_away(setting.scaled("Zb", 1.0), 0.05, gross);
    const BreakAway two = break_away(scaled, 0.05 / factor, factor * gross);
    for (const auto* run : {&one, &two})
      if (run->run.status != Status::converged) checks.stop(run->run.status);
    checks.equal("0.05 N/s and Zb = 1 mm, against " + short_number(0.05 / factor) +
                     " N/s and Zb = " + short_number(factor) + " mm",
                 "largest friction force", "N", one.peak, two.peak, 2e-3);
  }
  return checks.result();
}

std::vector<Claim> rate_claims() {
  const std::string why =
      "with inertia and lag negligible x = Zb psi(rate t/Fs), so that velocity and force depend on rate and Zb through "
      "rate*Zb alone (thesis-rate-scaling): by one quasi-static definition break-away cannot rise with the rate and "
      "fall "
      "with Zb, as the thesis also says (thesis-break-zb); a faster ramp meets a lower Stribeck level";
  const std::string test =
      "a mass of 1 kg under a force that rises at each rate; largest friction force before gross "
      "displacement";
  return {
      {"thesis-rate", "The break-away force of the proposed law rises with the force rate.", "",
       "thesis, section 3.6.2, figure 3.37 (the law is a reconstruction)", Evidence::reconstruction,
       "the printed rates 0.05, 0.1 and 0.2 N/s, default parameters", test, ClaimVerdict::fails,
       [why](const ClaimOptions& options) {
         return over_rates("non-drift", {0.05, 0.1, 0.2}, true, options, why);
       }},
      {"thesis-rate-scaling",
       "Where inertia and lag do not matter, the break-away force of the proposed law depends on force rate and Zb "
       "through their product alone.",
       "F_b(rate, Zb) = F_b(rate Zb)", "derived", Evidence::derived,
       "rates from 0.02 to 0.125 N/s with tau = 2e-5 s, equal to 0.2 %: the micro-damping, whose share of the force "
       "goes with the velocity, and inertia are left",
       test, ClaimVerdict::holds, scaling},
      {"pendulum-rate", "The higher the force rate, the lower the break-away force of LuGre.", "",
       "Piatkowski and Wolski 2018, figure 1b and text", Evidence::read,
       "0.05 to 50 N/s (the figure's range is not legible), the paper's parameters", test, ClaimVerdict::holds,
       [](const ClaimOptions& options) {
         return over_rates("lugre", {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}, false, options, "");
       }}};
}

}  // namespace

std::vector<Claim> document_breakaway_claims() {
  std::vector<Claim> list;
  for (const auto& one : std::vector<TrendClaim>{
           {"thesis-break-zb", "The break-away force of the proposed law falls as Zb rises.", "Zb", &BreakAway::peak,
            "largest friction force", "N", Trend::down, true, "figure 3.41"},
           {"thesis-break-zb-way", "Gross sliding is reached after a shorter way as Zb falls.", "Zb",
            &BreakAway::displacement, "displacement at the largest force", "m", Trend::up, true, "figure 3.41b"},
           {"thesis-break-vs", "The break-away force of the proposed law rises with vs.", "vs", &BreakAway::peak,
            "largest friction force", "N", Trend::up, true, "figure 3.39a"},
           {"thesis-break-vs-speed", "The velocity at break-away rises with vs.", "vs", &BreakAway::velocity,
            "velocity at the largest force", "m/s", Trend::up, false, "figure 3.39b"},
           {"thesis-break-sigma", "sigma has little or no effect on the break-away force (1 %).", "sigma",
            &BreakAway::peak, "largest friction force", "N", Trend::small, false, "figure 3.38a"},
           {"thesis-break-tau", "tau has little effect on the break-away force (1 %).", "tau", &BreakAway::peak,
            "largest friction force", "N", Trend::small, true, "figure 3.40a"},
           {"thesis-break-tau-slope", "tau reduces the steepness of the transition from stick to slip.", "tau",
            &BreakAway::slope, "mean fall of F over x after the peak", "N/m", Trend::down, false, "figure 3.40"}})
    list.push_back(trend_claim(one));
  for (auto& claim : rate_claims()) list.push_back(std::move(claim));
  return list;
}

}  // namespace limcycle
