#pragma once
#include <complex>
#include <string>
#include <vector>

namespace limcycle {

/// A measured frequency response y/u.
struct FrequencyData {
  std::string file;                            ///< as named in messages
  std::string sha256;                          ///< of its bytes; empty: not from a file
  std::vector<double> frequency;               ///< rad/s, > 0, rising
  std::vector<std::complex<double>> response;  ///< not zero
  /// Relative standard deviation of the response: of its real and of its imaginary part, each over its size, taken as
  /// independent. Empty: not known.
  std::vector<double> deviation;

  std::size_t size() const { return frequency.size(); }
};

/// A step between neighbours that is more than this many times as large as the usual one (the median), both in
/// logarithms and in rad/s, is a gap: data at equal steps of either kind have none.
inline constexpr double gap_factor = 5.0;

/// Positions i of gaps between i and i + 1.
std::vector<std::size_t> gaps_in(const std::vector<double>& frequency);

}  // namespace limcycle
