#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limcycle {

/// A number of a loop that may be chosen within bounds.
struct TuneNumber {
  std::string path;  ///< "loop.controller.kp"
  std::string unit;  ///< "1" if dimensionless
  double own = 0.0;  ///< as the loop stands; may be infinite
  double low = 0.0, high = 0.0;
};

/// The box of all points that may be tried, as a unit cube: even in the logarithm of a number whose bounds have one
/// sign, else even in the number. The values of a point have four digits each, so that they are those that a reader
/// sees, and never lie beyond a bound; on a bound they are the bound itself.
class TuneSpace {
 public:
  explicit TuneSpace(std::span<const TuneNumber> numbers);

  std::size_t size() const { return sides_.size(); }
  /// Values at a place; coordinates beyond 0 and 1 count as these.
  std::vector<double> values(std::span<const double> place) const;
  /// Place of values in the box.
  std::vector<double> place(std::span<const double> values) const;
  bool contains(std::span<const double> values) const;

  /// The values with one of them lower and higher by this share of itself, one that is 0 by `of_side` of its side,
  /// number by number; empty where that is beyond a bound, or no change.
  std::vector<std::vector<double>> beside(std::span<const double> values, double share, double of_side) const;

  /// Places that fill the box evenly: those of a Sobol sequence, stretched by a seventh, so that each number is on one
  /// of its bounds in one of eight places. There optima and absent parts (an integral gain of 0) are found, which no
  /// point inside meets.
  std::vector<std::vector<double>> design(std::size_t samples, std::uint64_t seed) const;

 private:
  struct Side {
    double low, high;
    bool logarithmic;
  };
  std::vector<Side> sides_;
};

/// Largest difference of two coordinates.
double distance_between(std::span<const double> a, std::span<const double> b);

/// The nearest number with four significant digits.
double with_four_digits(double value);

}  // namespace limcycle
