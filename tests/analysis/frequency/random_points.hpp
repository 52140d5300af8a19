#pragma once
#include <random>
#include <string>
#include <vector>

#include "limcycle/tests/analysis/frequency/df_laws.hpp"

/// Common parts of the tests of kernels at random points.
namespace df_test {

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

struct Tally {
  int points = 0, unanswered = 0, broken = 0;
  std::string which;              ///< the broken ones, as text
  std::vector<double> looseness;  ///< estimate over true error, where that exceeds roundings
};

}  // namespace df_test
