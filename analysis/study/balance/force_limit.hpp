#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Where the friction of a loop is too weak for a cycle, whatever its history: the first harmonic of a force of at most
/// F is at most 4 F/pi, so that 1 + N G has no root where (4/pi) F(A w)/A |G(jw)| < 1, F(v) being the largest force of
/// the law at speeds up to v (see ElementOn::force_bound). No describing function is needed there.
class ForceLimit {
 public:
  /// Empty where that is not known: without such a bound of the law, with more than one element, a mean velocity, a
  /// delay, a sampled controller, measured data, or a pole of the rest of the loop within the frequencies of the box
  /// whose damping ratio is below 0.1, the peak of which the samples of G could miss.
  static std::optional<ForceLimit> of(const Loop& loop, const SearchBox& box);

  /// True if no point of this part of the box is a root. |G| is that of the samples in its range, two a per cent of
  /// frequency, and one on each side of it, with a factor of 2 for what lies between them.
  bool forbids(const SearchBox& part) const;

 private:
  ForceLimit(const Loop& loop, const SearchBox& box);
  std::size_t sample_below(double frequency) const;

  Element element_;
  double first_, step_;            ///< ln w of the first sample, and from one to the next
  std::vector<double> responses_;  ///< |G(jw)|
};

}  // namespace limcycle
