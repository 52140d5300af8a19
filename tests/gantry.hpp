#pragma once
#include "limcycle/tests/loops.hpp"

namespace limcycle::test {

/// tests/reproducers/gantry-stribeck.toml, with another exponent, set-point or load.
inline Loop gantry(double delta, double reference = 0.0, double load = 0.0) {
  auto law = stribeck(42.0, 24.28, 0.001624);
  law.delta = delta;
  law.sigma2 = 123.2;
  auto parts = servo_parts(law);
  parts.plant = Mass{31.74, 0.0, 0.0};
  auto controller = pid(638000.0, 11.97e6, 7977.0);
  controller.tf = 0.0005;
  parts.controller = controller;
  parts.reference = reference;
  parts.load = load;
  return build_loop(parts);
}

}  // namespace limcycle::test
