#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"

namespace limcycle::cycle_claims {
namespace {

using std::numbers::pi;

std::string oscillator_in_words(const ForcedOscillator& o) {
  return at({{"w/w0", o.ratio}, {"F0|N", o.force}, {"Fc|N", o.level}, {"m|kg", o.mass}, {"k|N/m", o.stiffness}});
}

double forcing_frequency(const ForcedOscillator& o) { return o.ratio * std::sqrt(o.stiffness / o.mass); }

/// Half the swing of the last two periods of a long run, and a flag for a rest in between.
struct Swung {
  double amplitude = 0.0, before = 0.0;  ///< of the last and the last but one period, m
  bool rests = false;
};

std::optional<Swung> swing(const ForcedOscillator& o, const ClaimOptions& options, ClaimChecks& checks) {
  LoopParts parts;
  parts.plant = Mass{o.mass, 0.0, o.stiffness};
  parts.friction = coulomb(o.level, o.level);
  const double period = 2.0 * pi / forcing_frequency(o);
  SimulateOptions run_options;
  // A turn leaves the share (k X b^2 - Fc)/(k X b^2 + Fc) of the area of deviations: slow with little friction.
  run_options.duration = 400.0 * period;
  run_options.sample = run_options.duration;
  run_options.force = Signal{.kind = Signal::Kind::sine, .value = o.force, .frequency = forcing_frequency(o)};
  run_options.stepper = "dopri5";
  run_options.rtol = 1e-9;
  run_options.stop = options.stop;
  const Simulation run = simulate(build_loop(parts), run_options);
  if (run.status != Status::converged) {
    checks.stop(run.status);
    return std::nullopt;
  }
  // Steps end where the velocity is zero, so that the extremes are points of the trace.
  const auto half_swing = [&](double from, double to, bool& rests) {
    double low = infinite, high = -infinite;
    for (std::size_t i = 1; i < run.trace.t.size(); ++i) {
      if (run.trace.t[i] < from || run.trace.t[i] > to) continue;
      low = std::min(low, run.trace.y[i]);
      high = std::max(high, run.trace.y[i]);
      rests = rests || (run.trace.rate[i] == 0.0 && run.trace.rate[i - 1] == 0.0);
    }
    return 0.5 * (high - low);
  };
  Swung out;
  bool ignored = false;
  out.amplitude = half_swing(run_options.duration - period, run_options.duration, out.rests);
  out.before = half_swing(run_options.duration - 2.0 * period, run_options.duration - period, ignored);
  return out;
}

void check_non_stop(const ForcedOscillator& o, OfForced exact, const ClaimOptions& options, ClaimChecks& checks) {
  const auto swung = swing(o, options, checks);
  if (!swung) return;
  checks.equal(oscillator_in_words(o), "last two periods of the run", "m", swung->before, swung->amplitude, 1e-6);
  checks.is_true(oscillator_in_words(o), "the mass never rests", !swung->rests);
  checks.equal(oscillator_in_words(o), "amplitude", "m", exact(o), swung->amplitude, 2e-6);
}

/// First-harmonic balance |k - m w^2 + N(X, w)| X = F0 with the gain N by quadrature.
void check_first_harmonic(const ForcedOscillator& o, OfForced first_harmonic, ClaimChecks& checks) {
  const double w = forcing_frequency(o), claimed = first_harmonic(o);
  DfOptions df;
  df.method = DfMethod::quadrature;
  df.accuracy = 1e-10;
  const auto excess = [&](double amplitude) {
    const auto gain = describing_function(coulomb(o.level, o.level), {amplitude, w, 0.0}, df).gain;
    return std::abs(o.stiffness - o.mass * w * w + gain) * amplitude - o.force;
  };
  const double unit = o.force / o.stiffness;
  const auto roots = zeros_on_grid(excess, 0.01 * unit, 100.0 * unit, 60);
  checks.is_true(oscillator_in_words(o), "the first-harmonic balance has one solution", roots.size() == 1);
  if (roots.size() == 1)
    checks.equal(oscillator_in_words(o), "amplitude by describing function", "m", claimed, roots[0], 1e-8);
}

/// If the condition is broken the formula still gives a number, which must be wrong.
void check_stopping(const ClaimOptions& options, ClaimChecks& checks, OfForced exact) {
  ForcedOscillator slow;
  slow.ratio = 0.4;
  const double formula = exact(slow);
  checks.equal(oscillator_in_words(slow), "the formula where it does not hold", "m", 1.0804, formula, 5e-5);
  checks.is_true(oscillator_in_words(slow), "the condition says that the motion stops", !never_stops(slow, formula));
  const auto swung = swing(slow, options, checks);
  if (!swung) return;
  checks.equal(oscillator_in_words(slow), "true amplitude", "m", 1.132, swung->amplitude, 5e-4);
  checks.is_true(oscillator_in_words(slow), "the mass rests for a part of each period", swung->rests);
  checks.at_least(oscillator_in_words(slow), "true amplitude less that of the formula", "m", 0.05,
                  swung->amplitude - formula, 0.0);
}

ForcedOscillator random_oscillator(RandomPoints& draw) {
  for (;;) {
    ForcedOscillator o;
    o.mass = draw.log_between(0.1, 10.0);
    o.stiffness = draw.log_between(0.1, 100.0);
    o.force = draw.log_between(0.1, 10.0);
    o.level = o.force * draw.between(0.1, 0.4);
    o.ratio = draw.share() < 0.5 ? draw.between(0.55, 0.85) : draw.between(1.2, 1.7);
    if (never_stops(o, 0.8 * den_hartog_amplitude(o))) return o;  // NaN compares false
  }
}

}  // namespace

double den_hartog_amplitude(const ForcedOscillator& o) {
  const double V = 1.0 / (1.0 - o.ratio * o.ratio);
  const double U = std::sin(pi / o.ratio) / (o.ratio * (1.0 + std::cos(pi / o.ratio)));
  return o.force / o.stiffness * std::sqrt(V * V - std::pow(o.level / o.force * U, 2));
}

double forced_df_amplitude(const ForcedOscillator& o) {
  return o.force / o.stiffness * std::sqrt(1.0 - std::pow(4.0 * o.level / (pi * o.force), 2)) /
         std::abs(1.0 - o.ratio * o.ratio);
}

bool never_stops(const ForcedOscillator& o, double amplitude) {
  return o.stiffness * amplitude * o.ratio * o.ratio > o.level;
}

ClaimResult test_den_hartog(const ClaimOptions& options, OfForced exact, OfForced first_harmonic) {
  ClaimChecks checks;
  struct Row {
    double ratio, exact, df;
  };
  for (const Row& row : {Row{0.7, 1.927775, 1.896145}, Row{1.3, 1.391345, 1.401498}, Row{1.5, 0.765942, 0.773627}}) {
    ForcedOscillator o;
    o.ratio = row.ratio;
    checks.equal(oscillator_in_words(o), "amplitude of the table", "m", row.exact, exact(o), 1e-6);
    checks.equal(oscillator_in_words(o), "amplitude by describing function of the table", "m", row.df,
                 first_harmonic(o), 1e-6);
    check_non_stop(o, exact, options, checks);
    check_first_harmonic(o, first_harmonic, checks);
  }
  check_stopping(options, checks, exact);
  at_random(checks, options, "B6", 20, [&](RandomPoints& draw) {
    const ForcedOscillator o = random_oscillator(draw);
    check_non_stop(o, exact, options, checks);
    check_first_harmonic(o, first_harmonic, checks);
  });
  return checks.result();
}

std::vector<Claim> forced_friction_claims() {
  Claim claim;
  claim.id = "B6";
  claim.statement =
      "A mass on a spring with Coulomb friction, forced by F0 cos(w t), has a closed-form amplitude as long as it "
      "never stops, and another, close to it, by describing function. Where it stops the formula still gives a "
      "number, which is wrong.";
  claim.formula =
      "X = (F0/k) sqrt(V^2 - (Fc/F0)^2 U^2), V = 1/(1 - b^2), U = sin(pi/b)/(b (1 + cos(pi/b))), b = w/w0; "
      "non-stop: k X b^2 > Fc; describing function: X = (F0/k) sqrt(1 - (4 Fc/(pi F0))^2)/|1 - b^2|";
  claim.source = "J. P. Den Hartog (1931), from knowledge; the condition in terms of X derived; checked by simulation";
  claim.evidence = Evidence::knowledge;
  claim.range =
      "non-stop motion only; table: F0 = k = m = 1, Fc = 0.2, b = 0.7, 1.3, 1.5; refused at b = 0.4; random: Fc/F0 "
      "0.1..0.4, b 0.55..0.85 and 1.2..1.7, k X b^2 > 1.25 Fc";
  claim.test =
      "Explicit Runge-Kutta with located events from rest over 400 periods, the last two of which must agree; the "
      "first-harmonic balance is solved with the gain by quadrature.";
  claim.run = [](const ClaimOptions& options) { return test_den_hartog(options); };
  return {claim};
}

}  // namespace limcycle::cycle_claims
