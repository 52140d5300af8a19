#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle::cycle_claims {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The slip in the direction of growing error e: states e, de/dt and J = integral of e + Fc/ki, in which it is linear.
class Slip {
 public:
  Slip(const Servo& servo, const Coulomb<double>& friction) : servo_(servo), drop_(friction.Fs - friction.Fc) {
    M_ << 0.0, 1.0, 0.0, -servo.kp / servo.mass, -(servo.kd + friction.sigma2) / servo.mass, -servo.ki / servo.mass,
        1.0, 0.0, 0.0;
    step_ = 0.1 / eigenvalues(M_).cwiseAbs().maxCoeff();
    one_step_ = flow(step_);
  }

  Matrix3d flow(double t) const { return exponential(M_ * t); }
  /// Break-away at the error e0: kp e0 + ki J = -(Fs - Fc).
  Vector3d start(double e0) const { return {e0, 0.0, (-drop_ - servo_.kp * e0) / servo_.ki}; }
  /// d(start)/d(e0)
  Vector3d start_slope() const { return {1.0, 0.0, -servo_.kp / servo_.ki}; }

  /// Time of the first stop, NaN if it does not come within 2000 steps.
  double stop_after(const Vector3d& from) const {
    Vector3d x = one_step_ * from;
    for (int i = 1; i < 2000; ++i) {
      const Vector3d next = one_step_ * x;
      if (next(1) <= 0.0)
        return zero_between([&](double t) { return (flow(t) * from)(1); }, i * step_, (i + 1) * step_);
      x = next;
    }
    return std::nan("");
  }

 private:
  Servo servo_;
  double drop_, step_ = 0.0;
  Matrix3d M_, one_step_;
};

/// The half cycle from break-away at e0 = -amplitude; nothing if it does not end in sticking.
std::optional<HuntingCycle> half_cycle(const Servo& servo, const Coulomb<double>& friction, const Slip& slip,
                                       double amplitude) {
  HuntingCycle cycle;
  cycle.amplitude = amplitude;
  const Vector3d from = slip.start(-amplitude);
  cycle.slip = slip.stop_after(from);
  if (!std::isfinite(cycle.slip)) return std::nullopt;
  const Matrix3d flow = slip.flow(cycle.slip);
  const Vector3d end = flow * from;
  const double integral = end(2) - friction.Fc / servo.ki, drive = -(servo.kp * end(0) + servo.ki * integral);
  if (std::abs(drive) > friction.Fs) return std::nullopt;
  cycle.stick = ((friction.Fs - servo.kp * end(0)) / servo.ki - integral) / end(0);
  cycle.multiplier = -(flow * slip.start_slope())(0);  // de/dt = 0 at the end: its time does not matter
  return cycle;
}

struct HuntingRow {
  double Fs, sigma2, amplitude, slip, stick, period, multiplier;
};
constexpr HuntingRow hunting_table[] = {
    {1.5, 0.0, 0.06724015, 2.56843892, 9.11619722, 23.36927229, 0.0886262},
    {1.5, 0.4, 0.06565304, 2.65312124, 9.35339812, 24.01303872, 0.0975085},
    {1.1, 0.4, 0.01313061, 2.65312124, 39.81657125, 84.93938497, 0.0975085},
};

void check_construction(const Servo& servo, const Coulomb<double>& friction, const HuntingCycle& claimed,
                        double accuracy, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where =
      servo.text() + ", " + at({{"Fs|N", friction.Fs}, {"Fc|N", friction.Fc}, {"sigma2|N s/m", friction.sigma2}});
  // From farther away some servos creep to the set-point instead (B7-2).
  const auto shot = reached_cycle(servo_loop(servo, friction), 1.5 * claimed.amplitude, where, options, checks);
  if (!shot) return;
  const Cycle& cycle = shot->cycle;
  checks.equal(where, "amplitude of the error", "m", claimed.amplitude, cycle.amplitude, accuracy);
  checks.equal(where, "period", "s", claimed.period(), cycle.period, accuracy);
  checks.equal(where, "time stuck in half a period", "s", claimed.stick, 0.5 * cycle.sticking_fraction * cycle.period,
               accuracy, claimed.slip);
  checks.is_true(where, "one of the two multipliers beside the trivial one is exactly zero",
                 cycle.multipliers.size() == 2 && cycle.multipliers[1] == 0.0);
  if (!cycle.multipliers.empty())
    checks.equal(where, "multiplier of the period", "", claimed.multiplier * claimed.multiplier,
                 cycle.multipliers[0].real(), 1e-6, 1.0);
}

void check_hunting_row(const HuntingRow& row, const OfServo& construction, const ClaimOptions& options,
                       ClaimChecks& checks) {
  const Servo servo;
  const auto friction = coulomb(row.Fs, 1.0, row.sigma2);
  const std::string where = at({{"Fs|N", row.Fs}, {"sigma2|N s/m", row.sigma2}});
  const auto built = construction(servo, friction);
  checks.is_true(where, "the construction has a cycle", built.has_value());
  if (!built) return;
  checks.equal(where, "amplitude of the table", "m", row.amplitude, built->amplitude, 6e-9, 1.0);
  checks.equal(where, "time of slip of the table", "s", row.slip, built->slip, 3e-9);
  checks.equal(where, "time of stick of the table", "s", row.stick, built->stick, 3e-9);
  checks.equal(where, "period of the table", "s", row.period, built->period(), 3e-9);
  checks.equal(where, "multiplier of the table", "", row.multiplier, built->multiplier, 1e-6);
  check_construction(servo, friction, *built, 1e-8, options, checks);
}

/// Amplitude proportional to Fs - Fc and time of slip independent of it, by simulation and shooting alone.
void check_scaling(const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = "Fs - Fc = 0.5 N and 0.1 N";
  const auto large = reached_cycle(servo_loop({}, coulomb(1.5, 1.0, 0.4)), 1.0, where, options, checks);
  const auto small = reached_cycle(servo_loop({}, coulomb(1.1, 1.0, 0.4)), 1.0, where, options, checks);
  if (!large || !small) return;
  const auto slip = [](const Cycle& cycle) { return (1.0 - cycle.sticking_fraction) * cycle.period; };
  checks.equal(where, "ratio of the amplitudes", "", 5.0, large->cycle.amplitude / small->cycle.amplitude, 1e-7);
  checks.equal(where, "ratio of the times of slip", "", 1.0, slip(large->cycle) / slip(small->cycle), 1e-7);
}

void check_lugre(const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = "LuGre, Fs = 1.5 N, Fc = 1 N, sigma2 = 0.4 N s/m";
  const auto shot = reached_cycle(servo_loop({}, lugre(1.5, 1.0, 0.4)), 1.0, where, options, checks);
  if (!shot) return;
  checks.equal(where, "period of the table", "s", 24.43679, shot->cycle.period, 3e-7);
  checks.equal(where, "amplitude of the table", "m", 0.063903, shot->cycle.amplitude, 1e-5);
}

}  // namespace

std::optional<HuntingCycle> hunting_cycle(const Servo& servo, const Coulomb<double>& friction) {
  const Slip slip(servo, friction);
  const auto excess = [&](double amplitude) {
    const Vector3d from = slip.start(-amplitude);
    const double t = slip.stop_after(from);
    return std::isfinite(t) ? (slip.flow(t) * from)(0) / amplitude - 1.0 : std::nan("");
  };
  const double unit = (friction.Fs - friction.Fc) / servo.kp;
  for (const double amplitude : zeros_on_grid(excess, 1e-4 * unit, 1e3 * unit, 80)) {
    const auto cycle = half_cycle(servo, friction, slip, amplitude);
    if (cycle && cycle->stick > 0.0) return cycle;
  }
  return std::nullopt;
}

ClaimResult test_hunting_construction(const ClaimOptions& options, const OfServo& construction) {
  ClaimChecks checks;
  for (const HuntingRow& row : hunting_table) check_hunting_row(row, construction, options, checks);
  check_scaling(options, checks);
  check_lugre(options, checks);
  at_random(checks, options, "B7-3", 20, [&](RandomPoints& draw) {
    const Servo servo = stabilising_servo(draw);
    const double Fc = draw.log_between(0.3, 3.0);
    const auto friction = coulomb(Fc * draw.between(1.1, 2.0), Fc, draw.between(0.0, 0.3) * servo.kd);
    const auto built = construction(servo, friction);
    checks.is_true(servo.text(), "the construction has a cycle", built.has_value());
    if (built) check_construction(servo, friction, *built, 1e-7, options, checks);
  });
  return checks.result();
}

}  // namespace limcycle::cycle_claims
