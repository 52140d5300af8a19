#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Mid-tread quantizer: y = step round(x/step). Modes: the integer level; it changes at x = (level +- 1/2) step, where
/// the output is that of the side from which x came.
template <class S>
struct Quantizer : Memoryless<S> {
  S step{};

  static constexpr std::string_view kind = "quantizer";
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation = "y = step round(x/step)";
  static constexpr std::string_view source = "Gelb and Vander Velde (1968)";

  static std::vector<Parameter<Quantizer, S>> parameters() {
    return {{"step", "1", "distance of neighbouring levels", &Quantizer::step, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>&, Mode mode, std::span<const S>) const { return S(static_cast<double>(mode.value)) * step; }
  int guards(Mode) const { return 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    const auto level = static_cast<double>(mode.value);
    g[0] = S(level + 0.5) * step - in.x;
    g[1] = in.x - S(level - 0.5) * step;
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    return {fired == 0 ? mode.value + 1 : mode.value - 1};
  }
  /// Levels beyond 2^53 are not distinct in a double: there the mode stays at the last level that is.
  Mode start(const Input<double>& in, std::span<double>) const {
    constexpr double last = 9007199254740992.0;
    return {std::llround(std::clamp(in.x / value_of(step), -last, last))};
  }
  std::pair<double, double> working_gain() const { return {1.0, 0.0}; }
  double switching_input() const { return value_of(step); }
  bool odd() const { return true; }
  Scales scales() const { return {.output = value_of(step)}; }

  /// N = (2 step/(pi A)) sum over the thresholds t within A of the bias of sqrt(1 - ((t - bias)/A)^2); without bias
  /// (4 step/(pi A)) sum_i sqrt(1 - ((2 i - 1) step/(2 A))^2), 0 for A <= step/2. Gelb and Vander Velde (1968).
  /// Cost: one square root a threshold; empty beyond a million of them.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    const double first = std::ceil((bias - A) / step - 0.5), last = std::floor((bias + A) / step - 0.5);
    if (!(last - first < 1e6)) return std::nullopt;
    double sum = 0.0;
    const auto count = static_cast<long>(last - first);
    for (long i = 0; i <= count; ++i) {
      const double ratio = ((first + static_cast<double>(i) + 0.5) * step - bias) / A;
      sum += std::sqrt(std::max((1.0 - ratio) * (1.0 + ratio), 0.0));
    }
    return std::complex<double>(2.0 * step / (std::numbers::pi * A) * sum);
  }
};

}  // namespace limcycle
