/// @file
/// Part "stepping": one run of the hunting servo for each contender and tolerance, compared with the reference.
#pragma once

#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "limcycle/bench/measure.hpp"

namespace bench {

/// Ten periods at sigma0 = 1e5. The other stiffnesses run for the same time.
inline constexpr double stepping_duration = 244.36786455993;
/// Position is compared at this many times, equally spaced, the last at the end.
inline constexpr int stepping_samples = 200;
inline double sample_time(int k) { return stepping_duration * k / stepping_samples; }

inline constexpr std::array<double, 6> stiffnesses = {1e3, 1e4, 1e5, 1e6, 1e7, 1e8};

inline std::string stepping_problem(double sigma0) {
  char text[32];
  std::snprintf(text, sizeof text, "sigma0=1e%.0f", std::log10(sigma0));
  return text;
}

/// Positions of the reference by sigma0, from the file that bench/stepping_reference writes.
inline std::map<double, std::vector<double>> read_reference(const char* file) {
  std::ifstream in(file);
  std::map<double, std::vector<double>> all;
  double sigma0 = 0.0, estimate = 0.0;
  while (in >> sigma0 >> estimate) {
    auto& x = all[sigma0];
    x.resize(stepping_samples);
    for (double& value : x) in >> value;
  }
  if (all.empty() || in.bad()) throw std::runtime_error(std::string("no reference in ") + file);
  return all;
}

struct Positions {
  std::vector<double> x;  ///< at sample_time(1) ... sample_time(stepping_samples)
  long evaluations = 0;
};

/// Tolerances 1e-3, 1e-3.5, ... down to `least`.
inline std::vector<double> tolerances(double least) {
  std::vector<double> all;
  for (int i = 6; std::pow(10.0, -0.5 * i) > 0.99 * least; ++i) all.push_back(std::pow(10.0, -0.5 * i));
  return all;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double difference = i < a.size() ? std::abs(a[i] - b[i]) : INFINITY;
    if (!(difference <= worst)) worst = difference;  // keeps a NaN
  }
  return worst;
}

/// Runs `march(sigma0, tolerance)` -> Positions over the tolerances and prints a row for each; after a slow run the
/// next tolerance is skipped, after a very slow one the next three. After a run that gave up, tighter tolerances are
/// not tried.
template <class March>
void stepping_ladder(const char* contender, double sigma0, const std::vector<double>& reference, double least,
                     March&& march) {
  int left_out = 0;
  for (const double tolerance : tolerances(least)) {
    if (left_out > 0 && left_out--) continue;
    Row row{"stepping", stepping_problem(sigma0), contender, short_power(tolerance)};
    const double begin = cpu_seconds();
    try {
      Positions run;
      row.seconds = least_cpu_seconds([&] { run = march(sigma0, tolerance); });
      row.evaluations = run.evaluations;
      row.error = largest_difference(run.x, reference);
      if (!std::isfinite(row.error)) {
        row.error = -1.0;
        row.status = "not finite";
      }
    } catch (const std::exception& failure) {
      row.seconds = cpu_seconds() - begin;
      row.status = failure.what();
    }
    print(row);
    left_out = row.seconds > 2.0 ? 3 : row.seconds > 0.2 ? 1 : 0;
    if (row.status.rfind("gave up", 0) == 0) return;
  }
}

}  // namespace bench
