#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "limcycle/analysis/energy/passivity/passivity.hpp"

namespace limcycle {

/// A law with one free parameter; empty if its value is not valid.
using LawFamily = std::function<std::optional<Element>(double)>;

/// The element with its parameter `key` left free; values out of range or against a rule of the law give none. Throws
/// std::invalid_argument if it has no number of that name.
LawFamily family_of(const Element& element, std::string_view key);

/// Options of the location of thresholds.
struct ThresholdOptions {
  double accuracy = 1e-6;       ///< of a threshold, relative to it (or to the range, at 0)
  int scan = 33;                ///< values tested before bisection; 2 (the ends) are enough if passivity is monotone
  bool logarithmic = false;     ///< the scan
  double top_speed = infinite;  ///< largest |v| of the inputs, m/s
  std::function<Passive(const Element&)> verdict;  ///< empty: one_state_verdict
  std::function<bool()> stop;
};

/// A value at which passivity changes.
struct ThresholdChange {
  double value = 0.0;
  double error = 0.0;  ///< half the interval without a verdict
  Passive below{}, above{};
};

/// The values of a number at which passivity changes.
struct Threshold {
  Passive at_low{}, at_high{};
  std::vector<ThresholdChange> changes;  ///< ascending
  long evaluations = 0;                  ///< verdicts
  Status status = Status::converged;     ///< incomplete: a scanned value outside the changes was undecided or invalid
};

/// The values between low and high at which the law becomes or ceases to be passive: a scan, then bisection of every
/// interval with different verdicts at its ends. Complete only if the verdict changes at most once between two values
/// of the scan; in sigma2 it changes at most once at all, as sigma2 v^2 >= 0 is supplied in addition.
Threshold passivity_threshold(const LawFamily& family, double low, double high, const ThresholdOptions& options = {});

/// The least sigma2 with which a law with one state is passive (all above it are). 0 if it needs none; infinite if none
/// up to 1e12 times the law's force over its velocity is enough; NaN with a status if undecided at 0.
struct LeastDamping {
  double value = 0.0, error = 0.0;
  Status status = Status::converged;
};
LeastDamping least_sigma2(const Element& element, const ThresholdOptions& options = {});

/// The largest top speed at which a law with one state is passive (at all below it is, as there are fewer inputs).
struct PassiveSpeed {
  double value = 0.0;  ///< m/s; 0: at none, infinite: at any
  double error = 0.0;  ///< m/s
  Status status = Status::converged;
};
PassiveSpeed passive_speed(const Element& element, const ThresholdOptions& options = {});

}  // namespace limcycle
