#pragma once
#include <cmath>

#include "limcycle/models/element/piecewise.hpp"

namespace limcycle {

/// Characteristic given by points: straight lines between them, level beyond the first and the last. A table that
/// begins at the input 0 is continued as an odd function. Modes: 0 below the first point, k on the line to point k
/// (counted from 0, those of negative inputs included), as many as there are points beyond the last. No memory.
template <class S>
struct Lookup : Memoryless<S> {
  std::vector<S> inputs, outputs;

  static constexpr std::string_view kind = "lookup";
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation =
      "y on straight lines through the points (inputs, outputs), level beyond them; odd if the inputs begin at 0";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<Lookup, S>> parameters() {
    return {{"inputs", "1", "inputs of the points, ascending; from 0: an odd function", &Lookup::inputs},
            {"outputs", "1", "outputs at these inputs", &Lookup::outputs}};
  }
  std::optional<BrokenRule> validate() const {
    if (inputs.size() < 2) return BrokenRule{"inputs", "must be two or more"};
    for (std::size_t i = 1; i < inputs.size(); ++i)
      if (!(inputs[i] > inputs[i - 1])) return BrokenRule{"inputs", "must ascend from point to point"};
    if (outputs.size() != inputs.size())
      return BrokenRule{"outputs", "must be as many as the " + std::to_string(inputs.size()) + " inputs"};
    if (odd() && value_of(outputs.front()) != 0.0)
      return BrokenRule{"outputs", "must begin with 0 where the inputs do, as for an odd function"};
    return std::nullopt;
  }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    const int i = std::clamp(static_cast<int>(mode.value), 0, points());
    if (i == 0 || i == points()) return y(i == 0 ? 0 : i - 1);
    return y(i - 1) + slope(i) * (in.x - x(i - 1));
  }
  int guards(Mode mode) const { return mode.value == 0 || mode.value == points() ? 1 : 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    const int i = static_cast<int>(mode.value);
    if (i == 0) {
      g[0] = x(0) - in.x;
    } else {
      g[0] = in.x - x(i - 1);
      if (i < points()) g[1] = x(i) - in.x;
    }
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    return {mode.value + (mode.value == 0 || fired == 1 ? 1 : -1)};
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    int i = 0;
    while (i < points() && in.x > value_of(x(i))) ++i;
    return {i};
  }
  Mode mirror(Mode mode) const { return {points() - mode.value}; }

  bool odd() const { return !inputs.empty() && value_of(inputs.front()) == 0.0; }
  /// Slope at the input 0; 0 beyond the points.
  std::pair<double, double> working_gain() const {
    const auto mode = start({0.0, 0.0, 0.0}, {}).value;
    return {mode == 0 || mode == points() ? 0.0 : value_of(slope(static_cast<int>(mode))), 0.0};
  }
  Scales scales() const {
    double largest = 0.0;
    for (const S& one : outputs) largest = std::max(largest, std::abs(value_of(one)));
    return {.output = largest > 0.0 ? largest : 1.0};
  }

  /// Of an odd table without bias: sum over its points x_k > 0 of (slope before - slope after) f(x_k/A), f as for
  /// the saturation, which each corner adds.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0 || !odd()) return std::nullopt;
    double sum = 0.0;
    for (int i = points() / 2; i < points(); ++i) {
      const double after = i + 1 < points() ? slope(i + 1) : 0.0;
      sum += (slope(i) - after) * TwoBreaks<double>::inside_share(x(i) / A);
    }
    return std::complex<double>(sum);
  }

 private:
  /// An odd table of n points stands for 2 (n - 1): the line through the origin has no corner there.
  int points() const {
    const int n = static_cast<int>(inputs.size());
    return odd() ? 2 * (n - 1) : n;
  }
  S at(const std::vector<S>& list, int i) const {
    const auto n = static_cast<int>(inputs.size());
    const auto of = [&](int k) { return list[static_cast<std::size_t>(k)]; };
    if (!odd()) return of(i);
    return i < n - 1 ? -of(n - 1 - i) : of(i - n + 2);
  }
  S x(int i) const { return at(inputs, i); }
  S y(int i) const { return at(outputs, i); }
  /// Of the line to point i.
  S slope(int i) const { return (y(i) - y(i - 1)) / (x(i) - x(i - 1)); }
};

}  // namespace limcycle
