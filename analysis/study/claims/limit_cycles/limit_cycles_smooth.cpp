#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"

namespace limcycle::cycle_claims {
namespace {

using std::numbers::pi;

struct VanDerPolRow {
  double mu, period, amplitude, multiplier;
  double multiplier_accuracy;  ///< relative, of the value in the table
};
constexpr VanDerPolRow van_der_pol_table[] = {
    {0.1, 6.28711127, 2.00010398, 0.5330693, 1e-7},   {0.5, 6.38067580, 2.00248793, 3.917692e-2, 2e-7},
    {1.0, 6.66328686, 2.00861986, 8.596951e-4, 2e-7}, {2.0, 7.62987448, 2.01989138, 1.273849e-8, 5e-7},
    {5.0, 11.61223066, 2.02150806, 7.7e-38, 7e-3},    {10.0, 19.07836956, 2.01428536, 3.7e-136, 1.5e-2},
};

/// Logarithm of the multiplier by the trace formula along the cycle that was found.
double log_multiplier(const Cycle& cycle, double mu, const VanDerPolFormulas& claimed) {
  const double eps = 1e-6;
  const auto f = [&](double x) { return claimed.trace(mu, x); };
  return along(cycle, f, [&](double x) { return (f(x + eps) - f(x - eps)) / (2.0 * eps); });
}

/// The multiplier of shooting against exp of the trace integral. Errors of the steps add up over ln(multiplier).
void check_trace(const ShootingResult& shot, double mu, const VanDerPolFormulas& claimed, ClaimChecks& checks) {
  const std::string where = at({{"mu", mu}});
  const Cycle& cycle = shot.cycle;
  checks.is_true(where, "there is one multiplier beside the trivial one", cycle.multipliers.size() == 1);
  if (cycle.multipliers.size() != 1) return;
  const double exponent = log_multiplier(cycle, mu, claimed);
  checks.equal(where, "ln(multiplier)", "", exponent, std::log(std::abs(cycle.multipliers[0])), mu > 3.0 ? 1e-4 : 1e-6);
  checks.equal(where, "trivial multiplier", "", 1.0, 1.0 + shot.trivial_error, 1e-6);
}

void check_van_der_pol_row(const VanDerPolRow& row, const VanDerPolFormulas& claimed, const ClaimOptions& options,
                           ClaimChecks& checks) {
  const std::string where = at({{"mu", row.mu}});
  const auto shot = reached_cycle(van_der_pol(row.mu), 1.0, where, options, checks);
  if (!shot) return;
  const Cycle& cycle = shot->cycle;
  checks.equal(where, "period of the table", "s", row.period, cycle.period, 1e-8, 1.0);
  checks.equal(where, "amplitude of the table", "", row.amplitude, cycle.amplitude, 3e-8);
  if (!cycle.multipliers.empty())
    checks.equal(where, "multiplier of the table", "", row.multiplier, cycle.multipliers[0].real(),
                 row.multiplier_accuracy);
  check_trace(*shot, row.mu, claimed, checks);
}

/// Power of mu with which the error of a formula grows between two values.
double order(double error_small, double error_large, double ratio) {
  return std::log(std::abs(error_large / error_small)) / std::log(ratio);
}

/// The series are right if the neglected terms fall with a higher power than their last term: nearly mu^6 and mu^4.
void check_series(const VanDerPolFormulas& claimed, const ClaimOptions& options, ClaimChecks& checks) {
  const double small = 0.2, large = 0.4;
  const auto a = reached_cycle(van_der_pol(small), 1.0, at({{"mu", small}}), options, checks);
  const auto b = reached_cycle(van_der_pol(large), 1.0, at({{"mu", large}}), options, checks);
  if (!a || !b) return;
  const std::string where = at({{"mu", small}, {"and", large}});
  const auto falls_with = [&](const char* what, double expected, double at_small, double at_large) {
    checks.at_least(where, std::string("power of mu in the error of the ") + what, "", expected - 1.0,
                    order(at_small, at_large, large / small), 0.0);
  };
  falls_with("period", 6.0, a->cycle.period - claimed.period(small), b->cycle.period - claimed.period(large));
  falls_with("frequency", 6.0, a->cycle.frequency() - claimed.frequency(small),
             b->cycle.frequency() - claimed.frequency(large));
  falls_with("amplitude", 4.0, a->cycle.amplitude - claimed.amplitude(small),
             b->cycle.amplitude - claimed.amplitude(large));
  if (a->cycle.multipliers.empty() || b->cycle.multipliers.empty()) return;
  const auto exponent = [](const ShootingResult& shot, double mu) {
    return std::log(shot.cycle.multipliers[0].real()) / (-2.0 * pi * mu) - 1.0;
  };
  falls_with("exponent -2 pi mu", 2.0, exponent(*a, small), exponent(*b, large));
}

/// For large mu the neglected terms must be small against the last term, mu^(-1/3), and ever smaller.
void check_relaxation(const VanDerPolFormulas& claimed, const ClaimOptions& options, ClaimChecks& checks) {
  double before = infinite;
  for (const double mu : {10.0, 30.0, 90.0}) {
    const std::string where = at({{"mu", mu}});
    const auto shot = reached_cycle(van_der_pol(mu), 1.0, where, options, checks);
    if (!shot) return;
    const double share = std::abs(shot->cycle.period - claimed.slow_period(mu)) / (7.0143 * std::cbrt(1.0 / mu));
    checks.at_most(where, "neglected over the last term, against that at the mu before", "",
                   0.6 * std::min(before, 0.4), share, 0.0);
    before = share;
  }
}

void check_van_der_pol_describing_function(const ClaimOptions& options, ClaimChecks& checks) {
  for (const double mu : {0.1, 1.0}) {
    const std::string where = at({{"mu", mu}});
    const Loop loop = van_der_pol(mu);
    const auto found = find_df_roots(loop, FirstHarmonicBalance(loop), SearchBox{0.1, 10.0, 0.1, 10.0}, options.stop);
    checks.is_true(where, "the describing function predicts one cycle", found.roots.size() == 1);
    if (found.roots.size() != 1) continue;
    checks.equal(where, "amplitude by describing function", "", 2.0, found.roots[0].amplitude, 1e-9);
    checks.equal(where, "frequency by describing function", "rad/s", 1.0, found.roots[0].frequency, 1e-9);
  }
}

}  // namespace

double along(const Cycle& cycle, const std::function<double(double)>& f, const std::function<double(double)>& df) {
  const Trace& trace = cycle.trace;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < trace.t.size(); ++i) {
    const double h = trace.t[i + 1] - trace.t[i], x0 = trace.y[i], x1 = trace.y[i + 1];
    sum += 0.5 * h * (f(x0) + f(x1)) + h * h / 12.0 * (df(x0) * trace.rate[i] - df(x1) * trace.rate[i + 1]);
  }
  return sum;
}

VanDerPolFormulas van_der_pol_formulas() {
  return {[](double mu) { return 2.0 * pi * (1.0 + mu * mu / 16.0 - 5.0 * std::pow(mu, 4) / 3072.0); },
          [](double mu) { return 1.0 - mu * mu / 16.0 + 17.0 * std::pow(mu, 4) / 3072.0; },
          [](double mu) { return 2.0 + mu * mu / 96.0; },
          [](double mu) { return (3.0 - 2.0 * std::numbers::ln2) * mu + 7.0143 / std::cbrt(mu); },
          [](double mu, double x) { return mu * (1.0 - x * x); }};
}

ClaimResult test_van_der_pol(const ClaimOptions& options, const VanDerPolFormulas& claimed) {
  ClaimChecks checks;
  for (const VanDerPolRow& row : van_der_pol_table) check_van_der_pol_row(row, claimed, options, checks);
  check_series(claimed, options, checks);
  check_relaxation(claimed, options, checks);
  check_van_der_pol_describing_function(options, checks);
  at_random(checks, options, "B3", 20, [&](RandomPoints& draw) {
    const double mu = draw.log_between(0.05, 3.0);
    const auto shot = reached_cycle(van_der_pol(mu), 1.0, at({{"mu", mu}}), options, checks);
    if (shot) check_trace(*shot, mu, claimed, checks);
  });
  return checks.result();
}

std::vector<Claim> smooth_cycle_claims() {
  Claim claim;
  claim.id = "B3";
  claim.statement =
      "Van der Pol's oscillator: first-harmonic amplitude 2 and frequency 1, series of period, frequency and "
      "amplitude in mu, the period of relaxation oscillations, and the multiplier by the trace formula.";
  claim.formula =
      "T = 2 pi (1 + mu^2/16 - 5 mu^4/3072 + ...), w = 1 - mu^2/16 + 17 mu^4/3072 + ..., amplitude 2 + mu^2/96 + "
      "..., large mu: T = (3 - 2 ln 2) mu + 7.0143 mu^(-1/3); multiplier exp(integral of mu (1 - x^2) over a "
      "period), exp(-2 pi mu) for small mu";
  claim.source =
      "van der Pol (1926); series and asymptotics from knowledge, trace formula derived; numbers of the table "
      "checked by computation";
  claim.evidence = Evidence::knowledge;
  claim.range = "mu 0.1, 0.5, 1, 2, 5, 10 (table), 0.2 and 0.4 (series), 10 to 90 (asymptotics); random: mu 0.05..3";
  claim.test =
      "Simulation and shooting. The series by the power of mu with which their error falls: more than that of their "
      "last term; the asymptotic period by what it neglects over its last term; the multiplier from the product of "
      "the derivatives of all steps, never by differences.";
  claim.run = [](const ClaimOptions& options) { return test_van_der_pol(options); };
  return {claim};
}

}  // namespace limcycle::cycle_claims
