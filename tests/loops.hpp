#pragma once
#include <cmath>
#include <vector>

#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/loop.hpp"

/// Loops that several tests use.
namespace limcycle::test {

template <class Law>
Law with_levels(double Fs, double Fc) {
  Law law;
  law.Fs = law.Fs_minus = Fs;
  law.Fc = law.Fc_minus = Fc;
  return law;
}

/// The LuGre set of Canudas de Wit et al. (1995).
inline LuGre<double> lugre(double Fs = 1.5, double Fc = 1.0, double sigma2 = 0.4) {
  auto law = with_levels<LuGre<double>>(Fs, Fc);
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = std::sqrt(1e5);
  law.sigma2 = sigma2;
  return law;
}

inline Coulomb<double> coulomb(double Fs, double Fc, double sigma2 = 0.0) {
  auto law = with_levels<Coulomb<double>>(Fs, Fc);
  law.sigma2 = sigma2;
  return law;
}

inline Stribeck<double> stribeck(double Fs, double Fc, double vs) {
  auto law = with_levels<Stribeck<double>>(Fs, Fc);
  law.vs = vs;
  return law;
}

inline Relay<double> relay(double level, double hysteresis = 0.0, double dead_zone = 0.0) {
  Relay<double> element;
  element.level = level;
  element.hysteresis = hysteresis;
  element.dead_zone = dead_zone;
  return element;
}

inline Saturation<double> saturation(double limit) {
  Saturation<double> element;
  element.limit = limit;
  return element;
}

inline Pid pid(double kp, double ki, double kd) {
  Pid controller;
  controller.kp = kp;
  controller.ki = ki;
  controller.kd = kd;
  return controller;
}

inline Loop loop_of(Plant plant, Controller controller, Element friction) {
  LoopParts parts;
  parts.plant = std::move(plant);
  parts.controller = std::move(controller);
  parts.friction = std::move(friction);
  return build_loop(parts);
}

/// m = 1 kg under PID (3, 4, 6): the servo of the 1995 paper.
inline LoopParts servo_parts(Element friction) {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  parts.controller = pid(3.0, 4.0, 6.0);
  parts.friction = std::move(friction);
  return parts;
}
inline Loop servo(Element friction) { return build_loop(servo_parts(std::move(friction))); }

/// m = 1 kg, k = 2 N/m on a belt at 0.1 m/s.
inline Loop belt(Element friction) {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, 0.1};
  parts.friction = std::move(friction);
  return build_loop(parts);
}

/// States as in the case, from states measured from the rest point of a loop.
inline Eigen::VectorXd in_the_case(const Loop& loop, const Eigen::VectorXd& X) {
  return loop.origin.size() > 0 ? Eigen::VectorXd(loop.origin + X) : X;
}

inline Loop forward(Element element, std::vector<double> numerator, std::vector<double> denominator) {
  LoopParts parts;
  parts.plant = TransferFunction{std::move(numerator), std::move(denominator), 0.0};
  parts.element = std::move(element);
  return build_loop(parts);
}

/// x'' - mu x' + x + mu (x^3/3)' = 0: plant mu s/(s^2 - mu s + 1), element x^3/3.
inline Loop van_der_pol(double mu) {
  Cubic<double> cubic;
  cubic.coefficient = 1.0 / 3.0;
  return forward(cubic, {mu, 0.0}, {1.0, -mu, 1.0});
}

/// A pendulum with friction on a turning shaft, and its loop.
inline FroudePendulum froude_pendulum(double shaft_speed) {
  FroudePendulum p;
  p.mass = 5.0;
  p.arm = 0.2;
  p.inertia = 0.25;
  p.damping = 0.005;
  p.shaft_radius = 0.02;
  p.shaft_speed = shaft_speed;
  return p;
}

inline LoopParts parts_of(const FroudePendulum& p, const LuGre<double>& law = lugre()) {
  LoopParts parts;
  parts.plant = p;
  parts.friction = law;
  return parts;
}

}  // namespace limcycle::test
