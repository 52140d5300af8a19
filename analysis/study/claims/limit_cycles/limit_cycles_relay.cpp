#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"

namespace limcycle::cycle_claims {
namespace {

using std::numbers::pi;

Relay<double> relay(double level, double hysteresis) {
  Relay<double> element;
  element.level = level;
  element.hysteresis = hysteresis;
  return element;
}

/// A row of the table of B1, relay of level 1.
struct RelayRow {
  const char* plant;
  std::vector<double> denominator;
  double hysteresis, half_period, frequency, peak, radius, df_frequency, df_amplitude;
};

std::vector<RelayRow> relay_table() {
  return {
      {"1/(s+1)^3",
       {1.0, 3.0, 3.0, 1.0},
       0.0,
       1.83987534,
       1.70750300,
       0.16306148,
       0.383990575,
       std::sqrt(3.0),
       0.5 / pi},
      {"1/(s(s+1)^2)", {1.0, 2.0, 1.0, 0.0}, 0.0, 3.21223060, 0.97800969, 0.65831341, 0.353748014, 1.0, 2.0 / pi},
      {"1/(s(s+1)), hysteresis 0.1",
       {1.0, 1.0, 0.0},
       0.1,
       1.42362311,
       2.20675868,
       0.23445282,
       0.240839845,
       2.192528,
       0.240981},
  };
}

void check_relay_describing_function(const Loop& loop, const RelayRow& row, const ClaimOptions& options,
                                     ClaimChecks& checks) {
  const auto found = find_df_roots(loop, FirstHarmonicBalance(loop), SearchBox{1e-3, 10.0, 0.01, 100.0}, options.stop);
  checks.is_true(row.plant, "the describing function predicts one cycle", found.roots.size() == 1);
  if (found.roots.size() != 1) return;
  checks.equal(row.plant, "frequency by describing function", "rad/s", row.df_frequency, found.roots[0].frequency,
               3e-7);
  checks.equal(row.plant, "amplitude by describing function", "", row.df_amplitude, found.roots[0].amplitude, 3e-6);
}

/// The exact condition against shooting, within the accuracy of the trace.
void check_against_shooting(const Loop& loop, const RelayFeedback& relay, const SwitchingOutput& output,
                            const std::string& where, const ClaimOptions& options, ClaimChecks& checks) {
  const auto shot = reached_cycle(loop, 1.0, where, options, checks);
  if (!shot) return;
  const Cycle& cycle = shot->cycle;
  const auto exact = relay_cycles(relay, 0.02 * cycle.period, 20.0 * cycle.period, output);
  checks.is_true(where, "the condition has one solution without an earlier switch", exact.size() == 1);
  if (exact.size() != 1) return;
  checks.equal(where, "half period", "s", exact[0].half_period, 0.5 * cycle.period, 1e-10);
  checks.equal(where, "peak", "", exact[0].peak, cycle.amplitude, 1e-8);
  const double largest = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers[0]);
  checks.equal(where, "largest multiplier of the period", "", std::norm(exact[0].eigenvalues[0]), largest, 1e-8, 1.0);
  checks.is_true(where, "stable if and only if the eigenvalues of W lie within the unit circle",
                 cycle.stable == (std::abs(exact[0].eigenvalues[0]) < 1.0));
}

void check_relay_row(const RelayRow& row, const SwitchingOutput& output, const ClaimOptions& options,
                     ClaimChecks& checks) {
  const Loop loop = forward_loop(relay(1.0, row.hysteresis), {1.0}, row.denominator);
  check_against_shooting(loop, relay_feedback(loop, 1.0, row.hysteresis), output, row.plant, options, checks);
  check_relay_describing_function(loop, row, options, checks);
  const auto shot = reached_cycle(loop, 1.0, row.plant, options, checks);
  if (!shot) return;
  const Cycle& cycle = shot->cycle;
  checks.equal(row.plant, "half period of the table", "s", row.half_period, 0.5 * cycle.period, 6e-9, 1.0);
  checks.equal(row.plant, "frequency of the table", "rad/s", row.frequency, cycle.frequency(), 6e-9, 1.0);
  checks.equal(row.plant, "peak of the table", "", row.peak, cycle.amplitude, 6e-9, 1.0);
  const double radius = cycle.multipliers.empty() ? 0.0 : std::sqrt(std::abs(cycle.multipliers[0]));
  checks.equal(row.plant, "spectral radius of W of the table", "", row.radius, radius, 3e-9, 1.0);
}

/// 1/s with hysteresis: a triangle of half period 2 hysteresis/level, where the describing function has its root at
/// the very edge of its range, amplitude = hysteresis.
void check_integrator(double hysteresis, double level, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = "1/s, " + at({{"hysteresis", hysteresis}, {"level", level}});
  const Loop loop = forward_loop(relay(level, hysteresis), {1.0}, {1.0, 0.0});
  const auto shot = reached_cycle(loop, 2.0 * hysteresis, where, options, checks);
  if (!shot) return;
  checks.equal(where, "half period", "s", 2.0 * hysteresis / level, 0.5 * shot->cycle.period, 1e-10);
  checks.equal(where, "peak", "", hysteresis, shot->cycle.amplitude, 1e-10);
  checks.is_true(where, "each switch forgets everything: no multiplier but zeros",
                 std::ranges::all_of(shot->cycle.multipliers, [](const auto& m) { return std::abs(m) < 1e-12; }));
  // sqrt(1 - (h/A)^2) leaves a residual of about sqrt(2 (A/h - 1)) just inside the range.
  const FirstHarmonicBalance balance(loop);
  const double frequency = 4.0 * level / (pi * hysteresis);
  checks.equal(where, "residual of the describing function at its root", "", 0.0,
               std::abs(balance(hysteresis * (1.0 + 1e-12), frequency, 1e-12)), 2e-6, 1.0);
  const double df_period = 0.5 * pi * pi * hysteresis / level;
  checks.equal(where, "period by describing function", "s", df_period, 2.0 * pi / frequency, 1e-14);
  checks.equal(where, "period by describing function over the exact one", "", 1.234, df_period / shot->cycle.period,
               5e-4);
}

void check_lag(double hysteresis, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = "1/(s+1), " + at({{"hysteresis", hysteresis}});
  const Loop loop = forward_loop(relay(1.0, hysteresis), {1.0}, {1.0, 1.0});
  const auto shot = reached_cycle(loop, 1.0, where, options, checks);
  if (!shot) return;
  checks.equal(where, "half period", "s", std::log((1.0 + hysteresis) / (1.0 - hysteresis)), 0.5 * shot->cycle.period,
               1e-10);
  checks.equal(where, "peak", "", hysteresis, shot->cycle.amplitude, 1e-10);
}

void check_random_plant(RandomPoints& draw, const SwitchingOutput& output, const ClaimOptions& options,
                        ClaimChecks& checks) {
  const double a = draw.log_between(0.3, 3.0), w = draw.log_between(0.3, 3.0), zeta = draw.between(0.3, 1.5);
  const double level = draw.log_between(0.1, 10.0), dc = level / (a * w * w);
  const double hysteresis = draw.share() < 0.5 ? 0.0 : draw.between(0.0, 0.3) * dc;
  const std::string where = "1/((s + a)(s^2 + 2 zeta w s + w^2)), " +
                            at({{"a", a}, {"w", w}, {"zeta", zeta}, {"level", level}, {"hysteresis", hysteresis}});
  const Loop loop =
      forward_loop(relay(level, hysteresis), {1.0}, {1.0, a + 2.0 * zeta * w, w * w + 2.0 * zeta * w * a, a * w * w});
  check_against_shooting(loop, relay_feedback(loop, level, hysteresis), output, where, options, checks);
}

void check_dead_time(const LagWithDeadTime& lag, OfLag half_period, OfLag amplitude, const ClaimOptions& options,
                     ClaimChecks& checks) {
  const std::string where = at({{"K", lag.gain}, {"T|s", lag.time}, {"L|s", lag.delay}, {"level", lag.level}});
  const Loop delayed = forward_loop(relay(lag.level, 0.0), {lag.gain}, {lag.time, 1.0}, lag.delay);
  const auto [loop, order, delay_states] = in_time_domain(delayed, lowest_pade_order);
  checks.is_true(where, "the dead time is exact in the simulation", order == 0);
  const auto shot = reached_cycle(loop, lag.gain * lag.level, where, options, checks);
  if (!shot) return;
  checks.equal(where, "half period", "s", half_period(lag), 0.5 * shot->cycle.period, 1e-10);
  checks.equal(where, "amplitude", "", amplitude(lag), shot->cycle.amplitude, 1e-10);
}

}  // namespace

ClaimResult test_relay_condition(const ClaimOptions& options, const SwitchingOutput& output) {
  ClaimChecks checks;
  for (const RelayRow& row : relay_table()) check_relay_row(row, output, options, checks);
  check_integrator(0.1, 1.0, options, checks);
  check_lag(0.2, options, checks);
  at_random(checks, options, "B1", 20, [&](RandomPoints& draw) { check_random_plant(draw, output, options, checks); });
  at_random(checks, options, "B1 of first order", 3, [&](RandomPoints& draw) {
    check_integrator(draw.log_between(0.01, 1.0), draw.log_between(0.1, 10.0), options, checks);
    check_lag(draw.between(0.02, 0.9), options, checks);
  });
  return checks.result();
}

double dead_time_half_period(const LagWithDeadTime& lag) {
  return lag.time * std::log(2.0 * std::exp(lag.delay / lag.time) - 1.0);
}
double dead_time_amplitude(const LagWithDeadTime& lag) {
  return -lag.gain * lag.level * std::expm1(-lag.delay / lag.time);
}

ClaimResult test_dead_time(const ClaimOptions& options, OfLag half_period, OfLag amplitude) {
  ClaimChecks checks;
  check_dead_time({1.0, 1.0, 0.5, 1.0}, half_period, amplitude, options, checks);
  at_random(checks, options, "B2", 20, [&](RandomPoints& draw) {
    const double time = draw.log_between(0.1, 10.0);
    check_dead_time({draw.log_between(0.1, 10.0), time, time * draw.log_between(0.1, 3.0), draw.log_between(0.1, 10.0)},
                    half_period, amplitude, options, checks);
  });
  return checks.result();
}

std::vector<Claim> relay_cycle_claims() {
  std::vector<Claim> list(2);
  list[0].id = "B1";
  list[0].statement =
      "The symmetric limit cycles of relay feedback, dx/dt = A x + B u, u = -d sgn(C x) with hysteresis eps, have "
      "the half periods h that solve one scalar equation, as long as there is no earlier switch; one is stable if "
      "all eigenvalues of W lie within the unit circle.";
  list[0].formula =
      "C (I + Phi)^-1 Gamma d = eps, Phi = exp(A h), Gamma = integral of exp(A s) B over 0..h; W = (I - w C/(C w)) "
      "Phi, w = dx/dt before the switch; 1/s: h = 2 eps/d; 1/(s+1): h = ln((d + eps)/(d - eps))";
  list[0].source =
      "K. J. Astrom and T. Hagglund; K. H. Johansson, A. Rantzer, K. J. Astrom (1999), Automatica 35, abstract "
      "read; numbers of the table checked by computation";
  list[0].evidence = Evidence::read;
  list[0].range =
      "table: 1/(s+1)^3, 1/(s(s+1)^2), 1/(s(s+1)), 1/s, 1/(s+1), level 1; random: 1/((s + a)(s^2 + 2 zeta w s + "
      "w^2)), a and w 0.3..3, zeta 0.3..1.5, level 0.1..10, hysteresis 0 or up to 0.3 of the static output";
  list[0].test =
      "The loop is simulated from a displacement with located switches and shooting is started where it settles; "
      "the condition is solved on its own (Brent). Describing-function numbers by the root search over the box.";
  list[0].run = [](const ClaimOptions& options) { return test_relay_condition(options); };
  list[1].id = "B2";
  list[1].statement =
      "A relay in front of one lag with dead time oscillates with a period and an amplitude in closed form.";
  list[1].formula =
      "half period T ln(2 exp(L/T) - 1), amplitude K d (1 - exp(-L/T)) for K exp(-L s)/(T s + 1), relay +-d";
  list[1].source = "derived; elementary, see Astrom and Hagglund (1995) on relay experiments";
  list[1].evidence = Evidence::derived;
  list[1].range = "the slowest cycle, which is the stable one; random: T 0.1..10 s, L/T 0.1..3, K and d 0.1..10";
  list[1].test = "Simulation and shooting of the loop with the dead time moved behind the relay, where it is exact.";
  list[1].run = [](const ClaimOptions& options) { return test_dead_time(options); };
  return list;
}

}  // namespace limcycle::cycle_claims
