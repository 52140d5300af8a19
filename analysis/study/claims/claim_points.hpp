#pragma once
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <string_view>

#include "limcycle/analysis/study/claims/claim.hpp"

namespace limcycle {

/// Random parameters of a claim: the same numbers for the same seed with every standard library (the standard specifies
/// the numbers of the engine, but not of its distributions). Draw one number per declaration or within braces: the
/// order of evaluation of the arguments of a call is unspecified, too.
class RandomPoints {
 public:
  explicit RandomPoints(std::uint64_t seed) : source_(seed) {}
  double between(double low, double high) { return low + (high - low) * share(); }
  /// Uniform in the logarithm; 0 < low < high.
  double log_between(double low, double high);
  /// low, low + 1, ..., high.
  int whole(int low, int high) { return low + static_cast<int>(share() * (high - low + 1)); }
  /// Uniform in [0, 1).
  double share() { return static_cast<double>(source_() >> 11) * 0x1.0p-53; }

 private:
  std::mt19937_64 source_;
};

/// A number with its name, for the place of a comparison.
struct Named {
  std::string_view name;
  double value;
  std::string_view unit = {};
};

/// "A = 5e-06 m, w = 10 rad/s".
std::string place(std::initializer_list<Named> numbers);

/// A number as a source prints it, `last_digit` being one unit of its last digit: it agrees if the computed one rounds
/// to it, within a tenth of that unit and the error of the computation.
void check_printed(ClaimChecks& checks, std::string where, std::string quantity, std::string unit, double printed,
                   double last_digit, double computed, double error = 0.0);

inline bool stopped(const ClaimOptions& options) { return options.stop && options.stop(); }

}  // namespace limcycle
