#pragma once
#include <random>
#include <string>
#include <vector>

#include "limcycle/tests/analysis/frequency/df_laws.hpp"

/// Common parts of the tests of kernels at random points.
namespace limcycle::test {

class Random {
 public:
  explicit Random(unsigned seed) : source_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(source_); }
  double spread(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool coin() { return uniform(0.0, 1.0) < 0.5; }

 private:
  std::mt19937 source_;
};

inline DfOptions asking(double accuracy, Isa isa = Isa::scalar, int harmonics = 7) {
  DfOptions options = with(DfMethod::automatic, accuracy, harmonics);
  options.isa = isa;
  return options;
}

/// Amplitudes of 1e-6 to 0.1 and frequencies of 0.1 to 1000.
inline std::vector<DfPoint> grid(int rows, int columns) {
  std::vector<DfPoint> points;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      points.push_back({1e-6 * std::pow(1e5, static_cast<double>(i) / (rows - 1)),
                        0.1 * std::pow(1e4, static_cast<double>(j) / (columns - 1)), 0.0});
  return points;
}

struct Tally {
  int points = 0, unanswered = 0, broken = 0;
  std::string which;              ///< the broken ones, as text
  std::vector<double> looseness;  ///< estimate over true error, where that exceeds roundings
};

}  // namespace limcycle::test
