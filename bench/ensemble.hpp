/// @file
/// Part "ensembles": random servos, each from y = 1 for 250 s.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "limcycle/bench/servo.hpp"

namespace bench {

inline constexpr double ensemble_duration = 250.0;
inline constexpr int ensemble_size = 800;    ///< run by limcycle
inline constexpr int ensemble_checked = 60;  ///< the first ones, which the peers run and whose errors are measured

/// Servos with gains and friction drawn from ranges around the case's; the same on every machine.
inline std::vector<Servo<double>> random_servos() {
  std::mt19937_64 bits(20260101);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(bits() >> 11) * 0x1p-53);
  };
  std::vector<Servo<double>> all;
  for (int i = 0; i < ensemble_size; ++i) {
    Servo<double> servo(between(1e4, 1e6));
    servo.kp = between(2.0, 5.0);
    servo.ki = between(2.0, 6.0);
    servo.kd = between(4.0, 9.0);
    servo.Fs = between(1.1, 2.0);
    servo.vs = between(5e-4, 5e-3);
    servo.most_evaluations = 400'000'000;
    all.push_back(servo);
  }
  return all;
}

}  // namespace bench
