#pragma once
#include <cstddef>
#include <vector>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle::test {

/// One step of Runge and Kutta in the present modes, of either sign; the tests take short ones, exact to rounding.
inline State moved(LoopField& field, const State& x, double h) {
  State k1, k2, k3, k4, at = x;
  const auto stage = [&](const State& k, double part) {
    for (std::size_t i = 0; i < x.size(); ++i) at[i] = x[i] + part * h * k[i];
  };
  field.rate(x, k1, 0.0);
  stage(k1, 0.5);
  field.rate(at, k2, 0.0);
  stage(k2, 0.5);
  field.rate(at, k3, 0.0);
  stage(k3, 1.0);
  field.rate(at, k4, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) at[i] = x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  return at;
}

/// Time, of either sign, at which the guard is zero on the motion from x: secant steps.
inline double time_to(LoopField& field, const State& x, std::size_t guard, double step) {
  std::vector<double> g;
  const auto value = [&](double t) {
    field.guards(moved(field, x, t), 0.0, g);
    return g.at(guard);
  };
  double t0 = 0.0, g0 = value(t0), t1 = step, g1 = value(t1);
  for (int i = 0; i < 60 && g1 != 0.0 && g1 != g0; ++i) {
    const double t2 = t1 - g1 * (t1 - t0) / (g1 - g0);
    t0 = t1;
    g0 = g1;
    t1 = t2;
    g1 = value(t1);
  }
  return t1;
}

}  // namespace limcycle::test
