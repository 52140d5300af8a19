/// @file
/// The hunting servo (cases/pid-lugre.toml) in a straightforward implementation, for the peers.
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace bench {

/// Too many evaluations of the right-hand side: the method would not end within reasonable time.
struct GaveUp : std::runtime_error {
  explicit GaveUp(long evaluations)
      : std::runtime_error("gave up after " + std::to_string(evaluations) + " evaluations") {}
};

/// Mass under PID control with LuGre friction. State: integral of the error I, position x, velocity over vs, bristle
/// force f = sigma0 z. On these scales one scalar tolerance is suitable for all components: an absolute tolerance on a
/// velocity in m/s breaks stiction early.
template <class Real>
struct Servo {
  Real mass = 1, kp = 3, ki = 4, kd = 6;
  Real Fs = Real(1.5), Fc = 1, vs = Real(0.001), sigma0, sigma1, sigma2 = Real(0.4);  // as doubles, like the case's
  long evaluations = 0;
  long most_evaluations = 40'000'000;

  /// Bristles damped as in the case: sigma1 = sqrt(sigma0), in double precision.
  explicit Servo(Real stiffness) : sigma0(stiffness), sigma1(std::sqrt(static_cast<double>(stiffness))) {}

  static constexpr double start[4] = {0.0, 1.0, 0.0, 0.0};

  template <class State, class Rate>
  void rate(const State& state, Rate&& d) {
    if (++evaluations > most_evaluations) throw GaveUp(most_evaluations);
    using std::abs;
    using std::exp;
    const Real I = state[0], x = state[1], w = state[2], f = state[3];
    const Real v = vs * w;
    const Real level = Fc + (Fs - Fc) * exp(-w * w);
    const Real z_rate = v - abs(v) * f / level;
    const Real friction = f + sigma1 * z_rate + sigma2 * v;
    d[0] = -x;
    d[1] = v;
    d[2] = (ki * I - kp * x - kd * v - friction) / (mass * vs);
    d[3] = sigma0 * z_rate;
  }

  /// J(i, j) = d rate_i / d state_j through `put(i, j, value)`; entries without a call are zero.
  template <class State, class Put>
  void jacobian(const State& state, Put&& put) const {
    using std::abs;
    using std::exp;
    const Real w = state[2], f = state[3];
    const Real v = vs * w;
    const Real bump = (Fs - Fc) * exp(-w * w);
    const Real level = Fc + bump;
    const Real sign = w > 0 ? Real(1) : w < 0 ? Real(-1) : Real(0);
    const Real by_w = vs - sign * vs * f / level - abs(v) * f * 2 * w * bump / (level * level);
    const Real by_f = -abs(v) / level;
    put(0, 1, Real(-1));
    put(1, 2, vs);
    put(2, 0, ki / (mass * vs));
    put(2, 1, -kp / (mass * vs));
    put(2, 2, (-kd * vs - sigma1 * by_w - sigma2 * vs) / (mass * vs));
    put(2, 3, (-1 - sigma1 * by_f) / (mass * vs));
    put(3, 2, sigma0 * by_w);
    put(3, 3, sigma0 * by_f);
  }
};

/// Right-hand side and Jacobian for Odeint's rosenbrock4, with uBLAS vectors and matrices. The servo must outlive them.
template <class Vector, class Matrix, class Real>
auto stiff_system(Servo<Real>& servo) {
  const auto rate = [&servo](const Vector& y, Vector& d, Real) { servo.rate(y, d); };
  const auto jacobian = [&servo](const Vector& y, Matrix& J, Real, Vector& dfdt) {
    J.clear();
    dfdt.clear();
    servo.jacobian(y, [&J](std::size_t i, std::size_t j, Real value) { J(i, j) = value; });
  };
  return std::make_pair(rate, jacobian);
}

}  // namespace bench
