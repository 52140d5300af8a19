#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Where the friction of a loop cannot keep a cycle up, by what its equations prove (1 = N H has no root there, H being
/// the response of the rest of the loop from the force to the displacement of what rubs):
///  - too weak: the first harmonic of a force of at most F is at most 4 F/pi, so that |N H| < 1 where (4/pi) F(A w)/A
///    |H(jw)| < 1, F(v) being the largest force of the law at speeds up to v (see ElementOn::force_bound);
///  - without energy: a passive law (see ElementOn::is_passive) takes pi A^2 Im N >= 0 out of the motion in a period,
///    which the rest of the loop does not supply where Im(1/H(jw)) < 0.
/// No describing function is needed there.
class RootlessParts {
 public:
  /// Empty where that is not known: of a law of which neither is proved, with more than one element, a mean velocity, a
  /// delay, a sampled controller, measured data, or a pole of the rest of the loop within the frequencies of the box
  /// whose damping ratio is below 0.1, the peak of which the samples of H could miss.
  static std::optional<RootlessParts> of(const Loop& loop, const SearchBox& box);

  /// True if no point of this part of the box is a root. H is that of the samples in its range, two a per cent of
  /// frequency, and one on each side of it, with a factor of 2 on |H|, and a hundredth of it on Im H, for what lies
  /// between them.
  bool forbids(const SearchBox& part) const;

 private:
  RootlessParts(const Loop& loop, const SearchBox& box);
  bool too_weak(const SearchBox& part, double response) const;
  std::size_t sample_below(double frequency) const;

  Element element_;
  double first_, step_;         ///< ln w of the first sample, and from one to the next
  std::vector<double> sizes_;   ///< |H|
  std::vector<char> supplied_;  ///< 1 if the rest of the loop may supply energy there, or next to it
};

}  // namespace limcycle
