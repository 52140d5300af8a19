#pragma once
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Amplitudes of an element that is driven by another one and by its own returning output. If the size of the required
/// drive, s(a) = a |1 - H N(a)|, is not monotone in a, several amplitudes a are solutions (a saturated command that
/// winds up, a mass that jumps over its stiction), each an oscillation of its own. A branch is one of the rising and
/// falling pieces of s, from small a on: it ends where s turns, which depends on the frequency alone.
class AmplitudeBranches {
 public:
  using Size = std::function<double(double amplitude)>;
  struct Answer {
    int branch;
    double amplitude;
  };
  /// An end of a branch.
  struct Turn {
    double amplitude, size;
  };
  static constexpr int most = 7;  ///< largest number of branches: a saturation has three, a quantizer two a step

  /// Every a with s(a) = wanted. `range` is where s may turn: below it s is proportional to a, beyond it it rises.
  /// `frequency` and `accuracy` identify the function s: it is sampled once for each pair of them.
  std::vector<Answer> answers(const Size& size, std::pair<double, double> range, double wanted, double frequency,
                              double accuracy);
  /// The solution on one branch, if there is one; costs a part of answers().
  std::optional<Answer> answer_on(int branch, const Size& size, std::pair<double, double> range, double wanted,
                                  double frequency, double accuracy);

  /// A function along its range: its turning points, and the samples that show them.
  struct Sampled {
    std::vector<Turn> turns, samples;
  };

 private:
  Sampled sampled(const Size& size, std::pair<double, double> range, double frequency, double accuracy);

  std::mutex guard_;
  std::map<std::pair<double, double>, Sampled> known_;  ///< by frequency and accuracy
};

/// Amplitudes below which and beyond which a memoryless element's gain does not change, or changes as 1/a: s can turn
/// between them when `back` is the response from its output to its own input.
class ElementReach {
 public:
  explicit ElementReach(const Element& element);
  std::pair<double, double> range(double back) const;
  /// Amplitude at which the gain begins to change; for an element like a sign, without a size of its own, that of its
  /// output.
  double bend() const { return bend_ < infinite ? bend_ : output_; }

 private:
  double output_;           ///< typical size of the output
  double bend_ = infinite;  ///< amplitude below which the gain does not change; infinite if there is none
};

}  // namespace limcycle
