#pragma once
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/linear/plants.hpp"
#include "limcycle/models/scalar.hpp"

namespace limcycle {

/// Additional data of a Froude pendulum whose sleeve has play: the contact of sleeve and shaft after Hunt and Crossley
/// (1975), N = stiffness d^exponent (1 + dissipation dd/dt), clipped at 0, d the penetration.
struct SleeveContact {
  double stiffness{}, exponent{1.5}, dissipation{0.0};  ///< N/m^exponent, 1, s/m
};

/// Froude pendulum whose sleeve has radial play (pendulum.clearance, m): a rigid body in the plane, with the centre of
/// the sleeve (X, Y) relative to that of the shaft and the angle phi from hanging as its three degrees of freedom. With
/// e = |(X, Y)|, n = (X, Y)/e, t = n turned by +90 degrees:
///   penetration   d = e - clearance,
///   rubbing       v = (r + e) dphi/dt - r Omega - t . d(X, Y)/dt     (without play: the v of FroudePendulum),
///   force         -N n + F t on the sleeve, with the torque -(r + e) F about its centre.
/// Friction is that of a LuGre law whose force is taken at the nominal load N0 = mass gravity and scales with the load:
/// F = N/N0 F_law(v, z), so that the law gives friction coefficients (levels over N0). Off the shaft the bristle is
/// relaxed: z = 0.
///
/// A reconstruction: the equations of the paper that reports such a pendulum (Piatkowski and Wolski 2018) were not
/// available. State: X, Y, phi, dX/dt, dY/dt, dphi/dt, z, W (work of all forces except gravity and the elastic part of
/// N, for an audit of energy).
template <class S>
struct FroudeClearance {
  FroudePendulum pendulum;
  SleeveContact contact;
  LuGre<S> law;

  static constexpr int states = 8;
  enum StateIndex : std::size_t { x, y, angle, x_rate, y_rate, angle_rate, bristle, work };
  /// touching: N by the formula; apart: no penetration; released: penetrated, but separating so fast that N would pull.
  enum class Phase { touching, apart, released };

  double load() const { return pendulum.mass * pendulum.gravity; }  ///< N0

  /// First broken rule of the combination, or nothing. The key is a path such as "loop.plant.inertia".
  std::optional<BrokenRule> validate() const {
    const auto& p = pendulum;
    if (!(p.gravity > 0.0)) return BrokenRule{"loop.plant.gravity", "must be > 0: the friction goes with the weight"};
    if (!(p.inertia > p.mass * p.arm * p.arm))
      return BrokenRule{"loop.plant.inertia", "must be more than mass arm^2: it is about the axis of the shaft"};
    if (!(contact.stiffness > 0.0)) return BrokenRule{"stiffness", "of the contact must be > 0"};
    if (!(contact.exponent >= 1.0)) return BrokenRule{"exponent", "of the contact must be at least 1"};
    if (!(contact.dissipation >= 0.0)) return BrokenRule{"dissipation", "of the contact must be at least 0"};
    return std::nullopt;
  }

  /// Relative position of sleeve and shaft, and the forces between them.
  struct Meeting {
    S nx{}, ny{}, e{}, penetration{}, approach{};  ///< approach: rate of the penetration
    S elastic{}, normal{}, rubbing{}, friction{};  ///< elastic: that part of N
  };
  Meeting meet(std::span<const S> q, Phase phase) const {
    using std::sqrt;
    const double r = pendulum.shaft_radius;
    Meeting m;
    m.e = sqrt(q[x] * q[x] + q[y] * q[y]);
    m.ny = S(-1.0);  // any direction will do where the two centres coincide
    if (value_of(m.e) > 0.0) {
      m.nx = q[x] / m.e;
      m.ny = q[y] / m.e;
    }
    m.penetration = m.e - pendulum.clearance;
    m.approach = m.nx * q[x_rate] + m.ny * q[y_rate];
    m.rubbing = (m.e + r) * q[angle_rate] - r * pendulum.shaft_speed - (m.nx * q[y_rate] - m.ny * q[x_rate]);
    if (value_of(m.penetration) > 0.0) m.elastic = contact.stiffness * power(m.penetration, S(contact.exponent));
    if (phase != Phase::touching) return m;
    m.normal = m.elastic * (1.0 + contact.dissipation * m.approach);
    const S z[1] = {q[bristle]};
    m.friction = m.normal / load() * law.output({S(0.0), m.rubbing, S(0.0)}, Mode{}, z);
    return m;
  }

  void rate(std::span<const S> q, Phase phase, std::span<S> dq) const {
    using std::cos;
    using std::sin;
    const auto& p = pendulum;
    const Meeting m = meet(q, phase);
    const S fx = -m.normal * m.nx - m.friction * m.ny, fy = -m.normal * m.ny + m.friction * m.nx;
    const S s = sin(q[angle]), c = cos(q[angle]), w = q[angle_rate];
    const S torque = -(m.e + p.shaft_radius) * m.friction - p.damping * w;
    // Newton's law of the centre of mass at (X + arm sin phi, Y - arm cos phi), Euler's about it.
    const S turn = (torque - p.arm * (fx * c + fy * s)) / (p.inertia - p.mass * p.arm * p.arm);
    for (const auto& [position, velocity] : {std::pair(x, x_rate), std::pair(y, y_rate), std::pair(angle, angle_rate)})
      dq[position] = q[velocity];
    dq[x_rate] = fx / p.mass - p.arm * (c * turn - s * w * w);
    dq[y_rate] = fy / p.mass - p.gravity - p.arm * (s * turn + c * w * w);
    dq[angle_rate] = turn;
    dq[bristle] = S(0.0);
    if (phase == Phase::touching) {
      const S z[1] = {q[bristle]};
      law.rate({S(0.0), m.rubbing, S(0.0)}, Mode{}, z, dq.subspan(bristle, 1));
    }
    const S surface = -m.rubbing - p.shaft_radius * p.shaft_speed;  // velocity of the sleeve along t
    dq[work] = m.friction * surface - (m.normal - m.elastic) * m.approach - p.damping * w * w;
  }

  /// Guards of the phase: non-negative while it lasts.
  void guard(std::span<const S> q, Phase phase, std::span<S> g) const {
    const Meeting m = meet(q, Phase::apart);
    const S pushing = 1.0 + contact.dissipation * m.approach;
    g[0] = phase == Phase::apart ? -m.penetration : m.penetration;
    g[1] = phase == Phase::touching ? pushing : phase == Phase::released ? -pushing : S(1.0);
  }
  Phase next(Phase phase, int fired) const {
    if (fired == 0) return phase == Phase::apart ? Phase::touching : Phase::apart;
    return phase == Phase::touching ? Phase::released : Phase::touching;
  }

  /// Kinetic, potential and elastic energy, J: changes by W only.
  S energy(std::span<const S> q) const {
    using std::cos;
    using std::sin;
    const auto& p = pendulum;
    const S s = sin(q[angle]), c = cos(q[angle]), w = q[angle_rate];
    const S vx = q[x_rate] + p.arm * c * w, vy = q[y_rate] + p.arm * s * w;
    const S kinetic = 0.5 * p.mass * (vx * vx + vy * vy) + 0.5 * (p.inertia - p.mass * p.arm * p.arm) * w * w;
    const Meeting m = meet(q, Phase::apart);
    const S elastic = m.elastic * m.penetration / (contact.exponent + 1.0);
    return kinetic + p.mass * p.gravity * (q[y] - p.arm * c) + elastic;
  }
};

/// The same pendulum and friction without play and with a rigid contact: the limit of FroudeClearance. The force that
/// carries the sleeve, P along the arm and Q across it, is the resultant of N and F, so that
/// N^2 (1 + mu^2) = P^2 + Q^2 with mu = F_law/N0. State: phi, dphi/dt, z.
template <class S>
struct FroudeRigid {
  FroudePendulum pendulum;
  LuGre<S> law;

  static constexpr int states = 3;

  /// N. Q contains N itself, through the angular acceleration: N is the positive root of a quadratic equation.
  S normal(std::span<const S> q) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const auto& p = pendulum;
    const S mu = law.output({S(0.0), rubbing(q), S(0.0)}, Mode{}, q.subspan(2)) / (p.mass * p.gravity);
    const double share = p.mass * p.arm / p.inertia;
    const S along = p.mass * (p.arm * q[1] * q[1] + p.gravity * cos(q[0]));
    const S across = p.mass * p.gravity * sin(q[0]) * (1.0 - share * p.arm) - share * p.damping * q[1];
    const S k = share * p.shaft_radius * mu;  // `across` changes by -k N
    const S a = 1.0 + mu * mu - k * k, b = across * k;
    return (sqrt(b * b + a * (along * along + across * across)) - b) / a;
  }
  S rubbing(std::span<const S> q) const { return pendulum.shaft_radius * (q[1] - pendulum.shaft_speed); }

  void rate(std::span<const S> q, std::span<S> dq) const {
    using std::sin;
    const auto& p = pendulum;
    const Input<S> in{S(0.0), rubbing(q), S(0.0)};
    const S friction = normal(q) / (p.mass * p.gravity) * law.output(in, Mode{}, q.subspan(2));
    dq[0] = q[1];
    dq[1] = (-p.shaft_radius * friction - p.damping * q[1] - p.mass * p.gravity * p.arm * sin(q[0])) / p.inertia;
    law.rate(in, Mode{}, q.subspan(2), dq.subspan(2));
  }
};

}  // namespace limcycle
