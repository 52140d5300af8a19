#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// The loop of a case with other numbers at the same paths: equivalent to `--set` of these numbers, without reading the
/// file each time. A number that is not written and takes the value of another one (Fs_minus, of Fs) still follows it.
/// Safe from several threads. Cost of a loop: some 10 us.
class LoopVariation {
 public:
  /// Throws InputError, for `flag` (such as "--x"), if a path is not a scalar parameter of the loop.
  LoopVariation(const Case& from, const std::string& flag, std::span<const std::string> paths);
  LoopVariation(const Case& from, const std::string& flag, const std::string& path)
      : LoopVariation(from, flag, std::span(&path, 1)) {}

  /// The parts of the loop with these values, one for each path; empty if they are not valid.
  std::optional<LoopParts> parts(std::span<const double> values) const;

  /// The same, joined.
  std::optional<Loop> loop(std::span<const double> values) const;
  /// The same for a variation of one number.
  std::optional<Loop> operator()(double value) const { return loop({&value, 1}); }

 private:
  struct Number {
    std::function<void(LoopParts&, double)> set;
    Range range;
  };
  std::optional<LoopParts> changed(std::span<const double> values) const;

  LoopParts parts_;
  std::vector<Number> numbers_;                               ///< in the order of the paths
  std::vector<std::function<void(LoopParts&)>> not_written_;  ///< copy the value of another parameter, in this order
};

}  // namespace limcycle
