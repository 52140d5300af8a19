#include <gsl/gsl_multiroots.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "limcycle/analysis/study/balance/orbit_guess.hpp"
#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle::cycle_claims {
namespace {

// ---- without stick

/// Gains that do not stabilise: small motions decay because of the friction, so that the cycle is unstable. With
/// (ki/(kd w^2) - 1) damping beyond 0.25 the cycle would have to stick, and there is none.
Servo unstable_servo(RandomPoints& draw) {
  Servo servo;
  servo.mass = draw.log_between(0.3, 3.0);
  const double frequency = draw.log_between(0.5, 5.0), damping = draw.between(0.2, 0.8);
  servo.kp = servo.mass * frequency * frequency;
  servo.kd = 2.0 * damping * servo.mass * frequency;
  servo.ki = servo.kd * frequency * frequency * (1.0 + draw.between(0.05, 0.2) / damping);
  return servo;
}

/// The unstable cycle by multiple shooting from the motion that the describing function predicts; nothing, and a
/// status, if that does not find a cycle of about this size.
std::optional<Cycle> unstable_cycle(const Loop& loop, const Servo& servo, double Fc, const std::string& where,
                                    const ClaimOptions& options, ClaimChecks& checks) {
  const double w = std::sqrt(servo.kp / servo.mass),
               A = 4.0 * Fc * w / (std::numbers::pi * (servo.ki - servo.kd * w * w));
  const FirstHarmonicBalance balance(loop);
  const auto found = find_df_roots(loop, balance, SearchBox{A / 3.0, 3.0 * A, w / 3.0, 3.0 * w}, options.stop);
  checks.is_true(where, "the describing function gives a start for shooting", found.roots.size() == 1);
  if (found.roots.size() != 1) return std::nullopt;
  const Root& root = found.roots[0];
  const auto states = [&](double phase) { return balance.linear_state(root.amplitude, root.frequency, phase); };
  ShootingOptions shooting;
  shooting.stop = options.stop;
  auto shot = shoot_multiple(loop, guess_orbit(loop, states, root.frequency, true), shooting);
  if (shot.status == Status::converged && std::abs(std::log(shot.cycle.amplitude / A)) < 1.0)
    return std::move(shot.cycle);
  checks.stop(shot.status == Status::converged ? Status::incomplete : shot.status);
  return std::nullopt;
}

void check_without_stick(const Servo& servo, double Fc, const SwitchingOutput& output, const ClaimOptions& options,
                         ClaimChecks& checks) {
  const std::string where = servo.text() + ", " + at({{"Fc|N", Fc}});
  const Loop loop = servo_loop(servo, coulomb(Fc, Fc));
  const auto cycle = unstable_cycle(loop, servo, Fc, where, options, checks);
  if (!cycle) return;
  checks.equal(where, "share of the time stuck", "", 0.0, cycle->sticking_fraction, 1e-8, 1.0);
  const auto exact = relay_cycles(relay_feedback(loop, Fc), 0.1 * cycle->period, 2.5 * cycle->period, output);
  checks.is_true(where, "the condition has one solution without an earlier switch", exact.size() == 1);
  if (exact.size() != 1) return;
  checks.equal(where, "half period", "s", exact[0].half_period, 0.5 * cycle->period, 1e-9);
  const double radius = std::abs(exact[0].eigenvalues[0]);
  checks.equal(where, "largest multiplier of the period", "", radius * radius,
               cycle->multipliers.empty() ? 0.0 : std::abs(cycle->multipliers[0]), 1e-7);
  checks.is_true(where, "unstable", cycle->stable == false && radius > 1.0);
}

// ---- with stick

/// Half a period: slip in the positive direction from break-away, then stick; its mirror image is its start.
class SlipAndStick {
 public:
  SlipAndStick(const Loop& loop, double Fs, double Fc)
      : slip_{loop.A, loop.B.col(0), loop.ports.front().C_v, Fc, 0.0}, Fs_(Fs) {
    const double CB = slip_.C.dot(slip_.B.transpose());
    hold_ = -slip_.C * slip_.A / CB;
    stick_ = slip_.A + slip_.B * hold_;
  }

  /// Velocity at the end of the slip, and the holding force at the end of the stick less that of break-away.
  Eigen::Vector2d defect(double slip, double stick) const {
    const auto [flow, push] = slip_.over(slip);
    const Eigen::MatrixXd frozen = exponential(stick_ * stick), I = Eigen::MatrixXd::Identity(flow.rows(), flow.cols());
    const Eigen::VectorXd from = -solve(Eigen::MatrixXd(I + frozen * flow), frozen * push * slip_.level);
    const Eigen::VectorXd stopped = flow * from + push * slip_.level;
    return {slip_.C.dot(stopped.transpose()), hold_.dot(from.transpose()) - Fs_};
  }

 private:
  RelayFeedback slip_;  ///< with u = +Fc: dx/dt = A x + B Fc, where B contains the sign of friction
  Eigen::RowVectorXd hold_;
  Eigen::MatrixXd stick_;
  double Fs_;
};

int defect_for_gsl(const gsl_vector* at, void* half, gsl_vector* out) {
  const auto value = static_cast<const SlipAndStick*>(half)->defect(gsl_vector_get(at, 0), gsl_vector_get(at, 1));
  if (!value.allFinite()) return GSL_EBADFUNC;
  gsl_vector_set(out, 0, value(0));
  gsl_vector_set(out, 1, value(1));
  return GSL_SUCCESS;
}

/// Times of slip and stick by Powell's hybrid method; NaN if it does not converge.
std::pair<double, double> slip_and_stick_times(SlipAndStick half, double slip, double stick) {
  using Vector = std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)>;
  using Solver = std::unique_ptr<gsl_multiroot_fsolver, decltype(&gsl_multiroot_fsolver_free)>;
  const Vector start(gsl_vector_alloc(2), gsl_vector_free);
  gsl_vector_set(start.get(), 0, slip);
  gsl_vector_set(start.get(), 1, stick);
  const Solver solver(gsl_multiroot_fsolver_alloc(gsl_multiroot_fsolver_hybrids, 2), gsl_multiroot_fsolver_free);
  gsl_multiroot_function system = {defect_for_gsl, 2, &half};
  bool good = gsl_multiroot_fsolver_set(solver.get(), &system, start.get()) == GSL_SUCCESS;
  for (int i = 0; good && i < 100; ++i) {
    if (gsl_multiroot_fsolver_iterate(solver.get()) != GSL_SUCCESS) break;  // no further progress
    if (gsl_multiroot_test_residual(solver->f, 1e-14) == GSL_SUCCESS) break;
  }
  good = good && gsl_multiroot_test_residual(solver->f, 1e-10) == GSL_SUCCESS;
  if (!good) return {std::nan(""), std::nan("")};
  return {gsl_vector_get(solver->x, 0), gsl_vector_get(solver->x, 1)};
}

/// Number of break-aways in a period of a motion.
int slips(const Trace& trace) {
  int count = 0;
  for (std::size_t i = 1; i < trace.t.size(); ++i)
    count += trace.velocity[i - 1] == 0.0 && trace.velocity[i] != 0.0 && i > 1 && trace.velocity[i - 2] == 0.0;
  return count;
}

/// A servo with an elastic drive, friction at the motor.
void check_with_stick(const TwoMass& plant, double Fs, double Fc, double hold_share, const ClaimOptions& options,
                      ClaimChecks& checks) {
  const std::string where = at({{"motor|kg", plant.motor_mass},
                                {"load|kg", plant.load_mass},
                                {"k|N/m", plant.stiffness},
                                {"d|N s/m", plant.damping},
                                {"Fs|N", Fs},
                                {"Fc|N", Fc}});
  LoopParts parts;
  parts.plant = plant;
  Pid controller;
  controller.kp = 3.0;
  controller.ki = 1.0;
  controller.kd = 6.0;
  parts.controller = controller;
  parts.friction = coulomb(Fs, Fc);
  const Loop loop = build_loop(parts);
  const auto shot = reached_cycle(loop, 1.0, where, options, checks);
  if (!shot) return;
  const Cycle& cycle = shot->cycle;
  const double stick = 0.5 * cycle.sticking_fraction * cycle.period, slip = 0.5 * cycle.period - stick;
  checks.equal(where, "slips in a period", "", 2.0, slips(cycle.trace), 0.0, 1.0);
  const auto [t1, t2] = slip_and_stick_times(SlipAndStick(loop, hold_share * Fs, Fc), 0.97 * slip, 1.03 * stick);
  checks.equal(where, "time of slip", "s", t1, slip, 1e-7);
  checks.equal(where, "time of stick", "s", t2, stick, 1e-7);
  checks.equal(where, "period", "s", 2.0 * (t1 + t2), cycle.period, 1e-9);
}

// ---- B9

void check_agreement(double Fs, double ki, Element (*other)(double, double), const ClaimOptions& options,
                     ClaimChecks& checks) {
  const std::string where = at({{"Fs/Fc", Fs}, {"ki|N/(m s)", ki}});
  const auto hunts = [&](const Element& law) {
    const auto found = settled(servo_loop({1.0, 3.0, ki, 6.0}, law), 1.0, options, 1e-4);
    if (found.outcome == Outcome::undecided)
      checks.stop(options.stop && options.stop() ? Status::interrupted : Status::incomplete);
    return found.outcome == Outcome::cycle;
  };
  const bool by_switch = hunts(stribeck(Fs, 1.0, 1e-3)), by_bristles = hunts(other(Fs, 1.0));
  checks.equal(where, "hunts by the switch law and by the bristle law", "", by_switch ? 1.0 : 0.0,
               by_bristles ? 1.0 : 0.0, 0.0, 1.0);
}

}  // namespace

ClaimResult test_friction_cycles(const ClaimOptions& options, const SwitchingOutput& output, double hold_share) {
  ClaimChecks checks;
  check_without_stick({1.0, 1.0, 1.3, 1.0}, 1.0, output, options, checks);
  const auto elastic = [](double load, double stiffness, double damping) {
    return TwoMass{1.0, load, stiffness, damping, Choice{0}, Choice{0}};
  };
  check_with_stick(elastic(0.5, 50.0, 2.0), 1.5, 1.0, hold_share, options, checks);
  at_random(checks, options, "B8", 20, [&](RandomPoints& draw) {
    const Servo servo = unstable_servo(draw);
    check_without_stick(servo, draw.log_between(0.3, 3.0), output, options, checks);
  });
  at_random(checks, options, "B8 with stick", 10, [&](RandomPoints& draw) {
    const auto plant = elastic(draw.between(0.2, 1.0), draw.log_between(30.0, 300.0), draw.between(2.0, 6.0));
    check_with_stick(plant, draw.between(1.2, 1.8), 1.0, hold_share, options, checks);
  });
  return checks.result();
}

Element bristles(double Fs, double Fc) { return lugre(Fs, Fc, 0.0); }

ClaimResult test_switch_and_bristles(const ClaimOptions& options, Element (*other)(double, double)) {
  ClaimChecks checks;
  for (const double Fs : {1.0, 1.2, 1.5})
    for (const double ki : {0.0, 2.0, 4.0, 8.0}) {
      if (options.stop && options.stop()) checks.stop(Status::interrupted);
      check_agreement(Fs, ki, other, options, checks);
    }
  return checks.result();
}

std::vector<Claim> stick_claims() {
  std::vector<Claim> list(2);
  list[0].id = "B8";
  list[0].statement =
      "Limit cycles with Coulomb friction solve exact conditions: without stick that of relay feedback with the "
      "velocity as its input, with stick that of a slip and a stick which together mirror the state.";
  list[0].formula =
      "without stick: C_v (I + Phi)^-1 Gamma Fc = 0; with stick: x = -(I + Phi_k Phi_s)^-1 Phi_k Gamma_s Fc with v "
      "= 0 at the end of the slip and the holding force Fs at that of the stick";
  list[0].source =
      "H. Olsson and K. J. Astrom (2001), IEEE TCST 9(4), 629-636, and James (1989): abstracts read; the general "
      "form derived. The numbers of their example were not found: the examples here are our own";
  list[0].evidence = Evidence::derived;
  list[0].range =
      "symmetric cycles, without stick or with one a half period; without: a mass under PID gains that do not "
      "stabilise (kd kp < m ki), where the cycle is unstable, random gains; with: an elastic drive of motor and "
      "load under PID 3, 1, 6, random load 0.2..1 kg, k 30..300 N/m, d 2..6 N s/m, Fs/Fc 1.2..1.8";
  list[0].test =
      "Without stick: multiple shooting by Newton's method from the describing function's root. With: simulation "
      "and shooting; the two equations for the times of slip and stick are solved (Powell) from 3 % off. At most 10 "
      "random points with stick.";
  list[0].run = [](const ClaimOptions& options) { return test_friction_cycles(options); };
  list[1].id = "B9";
  list[1].statement = "A switch law with a Stribeck curve and LuGre agree on where a servo hunts.";
  list[1].source =
      "R. H. A. Hensen, M. J. G. van de Molengraft, M. Steinbuch (2003), Automatica: from knowledge, qualitative; "
      "its numbers were not available";
  list[1].evidence = Evidence::knowledge;
  list[1].range =
      "m = 1, kp = 3, kd = 6, vs = 1e-3 m/s on the grid Fs/Fc 1, 1.2, 1.5 and ki 0 (no integrator), 2, 4, 8";
  list[1].test = "Simulation of both from 1 m until it is clear what is reached. No random points.";
  list[1].run = [](const ClaimOptions& options) { return test_switch_and_bristles(options); };
  return list;
}

}  // namespace limcycle::cycle_claims
