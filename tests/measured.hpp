#pragma once
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <random>

#include "limcycle/models/linear/plants.hpp"

/// Frequency responses that tests make from known functions.
namespace limcycle::test {

using ResponseOf = std::function<std::complex<double>(std::complex<double> s)>;

/// Data at equal steps of the logarithm; `deviation`: relative, of real and imaginary part, stated if not 0.
inline FrequencyData sampled_response(const ResponseOf& G, double from, double to, int points, double deviation = 0.0,
                                      unsigned seed = 1) {
  FrequencyData data;
  data.file = "test.csv";
  std::mt19937 random(seed);
  std::normal_distribution<> normal;
  for (int i = 0; i < points; ++i) {
    const double w = from * std::pow(to / from, static_cast<double>(i) / (points - 1));
    data.frequency.push_back(w);
    const double re = normal(random), im = normal(random);
    data.response.push_back(G({0.0, w}) * std::complex<double>(1.0 + deviation * re, deviation * im));
    if (deviation > 0.0) data.deviation.push_back(deviation);
  }
  return data;
}

inline MeasuredPlant measured_plant(FrequencyData data) {
  MeasuredPlant plant;
  plant.data = std::make_shared<const FrequencyData>(std::move(data));
  return plant;
}

/// From the force on the motor to its position: two masses of 0.5 kg and a shaft of 200 N/m, damped.
inline std::complex<double> two_masses(std::complex<double> s, double damping) {
  const auto m = 0.5 * s * s, k = 200.0 + damping * s;
  return (m + k) / ((m + k) * (m + k) - k * k);
}
inline ResponseOf two_masses(double damping) {
  return [damping](std::complex<double> s) { return two_masses(s, damping); };
}

}  // namespace limcycle::test
