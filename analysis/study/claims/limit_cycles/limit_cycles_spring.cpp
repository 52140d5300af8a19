#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"

namespace limcycle::cycle_claims {
namespace {

using std::numbers::pi;

double natural_frequency(double mass, double stiffness) { return std::sqrt(stiffness / mass); }

std::string belt_in_words(const StickSlipBelt& belt) {
  return at({{"m|kg", belt.mass},
             {"k|N/m", belt.stiffness},
             {"speed|m/s", belt.speed},
             {"Fs|N", belt.Fs},
             {"Fc|N", belt.Fc}});
}

Loop loop_of(const StickSlipBelt& belt, Element friction) {
  return belt_loop(Belt{belt.mass, belt.stiffness, 0.0, belt.speed}, std::move(friction));
}

/// Largest |value| of a column, the peak between the steps by a parabola.
double largest(const Trace& trace, const std::vector<double>& column) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < column.size(); ++i)
    if (std::abs(column[i]) > std::abs(column[best])) best = i;
  if (best == 0 || best + 1 == column.size()) return std::abs(column[best]);
  const double a = trace.t[best] - trace.t[best - 1], b = trace.t[best + 1] - trace.t[best];
  if (!(a > 0.0 && b > 0.0)) return std::abs(column[best]);  // at a switch
  const double left = (column[best] - column[best - 1]) / a, right = (column[best + 1] - column[best]) / b;
  const double slope = (left * b + right * a) / (a + b), curvature = (right - left) / (a + b);
  return std::abs(curvature == 0.0 ? column[best] : column[best] - 0.25 * slope * slope / curvature);
}

void check_belt(const StickSlipBelt& belt, OfBelt slip, OfBelt stick, OfBelt amplitude, const ClaimOptions& options,
                ClaimChecks& checks) {
  const std::string where = belt_in_words(belt);
  // From so far that the mass catches up with the belt: smaller motions would slide about Fc/k for ever.
  const double far = 2.0 * (belt.Fs / belt.stiffness + belt_amplitude(belt));
  const auto shot = reached_cycle(loop_of(belt, coulomb(belt.Fs, belt.Fc)), far, where, options, checks);
  if (!shot) return;
  const Cycle& cycle = shot->cycle;
  const double stuck = cycle.sticking_fraction * cycle.period;
  checks.equal(where, "period", "s", slip(belt) + stick(belt), cycle.period, 1e-9);
  checks.equal(where, "time stuck", "s", stick(belt), stuck, 1e-7, slip(belt));
  checks.equal(where, "amplitude", "m", amplitude(belt), cycle.amplitude, 1e-7);
  const auto [low, high] = extremes(cycle.trace);
  checks.equal(where, "middle of the motion", "m", belt.Fc / belt.stiffness, 0.5 * (low + high), 1e-5, amplitude(belt));
}

/// The other rows of the table, by their numbers: with viscous friction, and with LuGre in place of ideal stiction.
void check_numbers(const ClaimOptions& options, ClaimChecks& checks) {
  const StickSlipBelt belt;
  const auto check = [&](const std::string& where, Element friction, double period, double speed,
                         std::optional<double> spring_force) {
    const auto shot = reached_cycle(loop_of(belt, std::move(friction)), 0.0, where, options, checks);
    if (!shot) return;
    const Cycle& cycle = shot->cycle;
    checks.equal(where, "period of the table", "s", period, cycle.period, 1.5e-6);
    checks.equal(where, "peak velocity over the belt", "m/s", speed, largest(cycle.trace, cycle.trace.velocity), 2e-5);
    if (spring_force)
      checks.equal(where, "peak spring force", "N", *spring_force, belt.stiffness * largest(cycle.trace, cycle.trace.y),
                   1e-5);
  };
  check("Coulomb, sigma2 = 0", coulomb(1.5, 1.0), 7.611259, 0.467423, {});
  check("Coulomb, sigma2 = 0.4 N s/m", coulomb(1.5, 1.0, 0.4), 6.453933, 0.376819, {});
  check("LuGre, sigma2 = 0.4 N s/m", lugre(1.5, 1.0, 0.4), 6.36272, 0.36982, 1.50799);
  check("LuGre, sigma2 = 0", lugre(1.5, 1.0, 0.0), 7.49381, 0.45873, {});
}

struct Turning {
  double t, y;
};

/// Points where the velocity changes its sign or stops, from a run whose steps end at those events.
std::vector<Turning> turning_points(const Simulation& run, double speed_scale) {
  std::vector<Turning> points;
  const Trace& trace = run.trace;
  for (std::size_t i = 1; i < trace.t.size(); ++i) {
    const bool at_rest = std::abs(trace.rate[i]) < 1e-9 * speed_scale;
    const bool moved = std::abs(trace.rate[i - 1]) >= 1e-9 * speed_scale;
    if (at_rest && moved) points.push_back({trace.t[i], trace.y[i]});
  }
  return points;
}

void check_free_decay(double mass, double stiffness, double Fc, double Fs, double start, double lost_each_half,
                      const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = at({{"m|kg", mass}, {"k|N/m", stiffness}, {"Fc|N", Fc}, {"Fs|N", Fs}, {"y(0)|m", start}});
  LoopParts parts;
  parts.plant = Mass{mass, 0.0, stiffness};
  parts.friction = coulomb(Fs, Fc);
  const double w0 = natural_frequency(mass, stiffness), lost = lost_each_half * Fc / stiffness;
  SimulateOptions run_options;
  run_options.duration = pi / w0 * (start / lost + 3.0);
  run_options.initial = {{"y", start}};
  run_options.stepper = "dopri5";
  run_options.rtol = 1e-11;
  run_options.stop = options.stop;
  const Simulation run = simulate(build_loop(parts), run_options);
  if (run.status != Status::converged) return checks.stop(run.status);
  const auto points = turning_points(run, start * w0);
  double amplitude = start, side = 1.0, time = 0.0;
  for (const Turning& point : points) {
    amplitude -= lost;
    side = -side;
    time += pi / w0;
    checks.equal(where, "turning point", "m", side * amplitude, point.y, 1e-7, start);
    checks.equal(where, "time of the turning point", "s", time, point.t, 1e-7);
  }
  checks.is_true(where, "it turns at least twice", points.size() >= 2);
  checks.at_most(where, "spring force where it stops", "N", Fs, stiffness * std::abs(run.trace.y.back()), 1e-6 * Fs);
  checks.is_true(where, "it stops at the first turning point whose spring force is within Fs",
                 stiffness * (amplitude + lost) > Fs && stiffness * std::abs(amplitude) <= Fs);
}

}  // namespace

double slip_time(const StickSlipBelt& belt) {
  const double w0 = natural_frequency(belt.mass, belt.stiffness), drop = (belt.Fs - belt.Fc) / belt.stiffness;
  return 2.0 / w0 * (pi - std::atan(w0 * drop / belt.speed));
}
double stick_time(const StickSlipBelt& belt) { return 2.0 * (belt.Fs - belt.Fc) / (belt.stiffness * belt.speed); }
double belt_amplitude(const StickSlipBelt& belt) {
  return std::hypot((belt.Fs - belt.Fc) / belt.stiffness, belt.speed / natural_frequency(belt.mass, belt.stiffness));
}

ClaimResult test_stick_slip(const ClaimOptions& options, OfBelt slip, OfBelt stick, OfBelt amplitude) {
  ClaimChecks checks;
  check_belt({}, slip, stick, amplitude, options, checks);
  check_numbers(options, checks);
  at_random(checks, options, "B4", 20, [&](RandomPoints& draw) {
    StickSlipBelt belt;
    belt.mass = draw.log_between(0.1, 10.0);
    belt.stiffness = draw.log_between(0.5, 50.0);
    belt.Fc = draw.log_between(0.1, 10.0);
    belt.Fs = belt.Fc * draw.between(1.1, 2.0);
    // The speed relative to that of the slip: sticking from a tenth of the time of slip to ten times as much.
    belt.speed = (belt.Fs - belt.Fc) / std::sqrt(belt.mass * belt.stiffness) * draw.log_between(0.1, 3.0);
    check_belt(belt, slip, stick, amplitude, options, checks);
  });
  return checks.result();
}

ClaimResult test_free_decay(const ClaimOptions& options, double lost_each_half) {
  ClaimChecks checks;
  check_free_decay(1.0, 2.0, 1.0, 1.0, 7.3, lost_each_half, options, checks);
  check_free_decay(1.0, 2.0, 1.0, 1.5, 7.3, lost_each_half, options, checks);
  at_random(checks, options, "B5", 20, [&](RandomPoints& draw) {
    const double mass = draw.log_between(0.1, 10.0), stiffness = draw.log_between(0.1, 100.0);
    const double Fc = draw.log_between(0.1, 10.0), Fs = Fc * draw.between(1.0, 1.9);
    check_free_decay(mass, stiffness, Fc, Fs, Fc / stiffness * draw.between(6.0, 30.0), lost_each_half, options,
                     checks);
  });
  return checks.result();
}

std::vector<Claim> spring_friction_claims() {
  std::vector<Claim> list(2);
  list[0].id = "B4";
  list[0].statement =
      "A mass on a spring on a running belt, friction dropping from Fs to Fc when it slides and no damping: closed "
      "forms of the times of stick and slip and of the amplitude about Fc/k.";
  list[0].formula =
      "t_stick = 2 D/V, t_slip = (2/w0)(pi - atan(w0 D/V)), amplitude sqrt(D^2 + (V/w0)^2), D = (Fs - Fc)/k, w0 = "
      "sqrt(k/m)";
  list[0].source = "derived; numbers with viscous friction and with LuGre checked by computation (Runge-Kutta, 1e-5 s)";
  list[0].evidence = Evidence::derived;
  list[0].range =
      "Fs > Fc, V > 0; table: m = 1, k = 2, V = 0.1, Fs = 1.5, Fc = 1; random: m 0.1..10, k 0.5..50, Fc 0.1..10, "
      "Fs/Fc 1.1..2, V sqrt(m k)/(Fs - Fc) 0.1..3";
  list[0].test = "Simulation from far and shooting; the numbers of LuGre with the same levels by the stiff stepper.";
  list[0].run = [](const ClaimOptions& options) { return test_stick_slip(options); };
  list[1].id = "B5";
  list[1].statement =
      "A free mass on a spring with Coulomb friction loses the same amplitude every half cycle, keeps its frequency "
      "and stops where the spring is within the break-away level.";
  list[1].formula = "2 Fc/k each half cycle, 4 Fc/k each cycle; frequency sqrt(k/m); stops when k |y| <= Fs at v = 0";
  list[1].source = "textbook; derived";
  list[1].evidence = Evidence::derived;
  list[1].range = "no viscous friction; random: m 0.1..10, k 0.1..100, Fc 0.1..10, Fs/Fc 1..1.9, y(0) 6..30 Fc/k";
  list[1].test = "Turning points of a run by an explicit Runge-Kutta method with located events (no exact flow).";
  list[1].run = [](const ClaimOptions& options) { return test_free_decay(options); };
  return list;
}

}  // namespace limcycle::cycle_claims
