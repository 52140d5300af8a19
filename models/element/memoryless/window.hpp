#pragma once
#include "limcycle/models/element/piecewise.hpp"

namespace limcycle {

/// Passes small signals only: y = x for |x| <= half_width, else 0.
template <class S>
struct Window : TwoBreaks<S> {
  S half_width{};

  static constexpr std::string_view kind = "window";
  static constexpr std::string_view equation = "y = x for |x| <= half_width, else 0";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<Window, S>> parameters() {
    return {{"half_width", "1", "largest input that passes", &Window::half_width, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const { return mode.value == 0 ? in.x : S(0.0); }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    this->guard_at(half_width, in, mode, g);
  }
  Mode start(const Input<double>& in, std::span<double>) const { return this->start_at(value_of(half_width), in); }
  bool odd() const { return true; }
  std::pair<double, double> working_gain() const { return {1.0, 0.0}; }
  double switching_input() const { return value_of(half_width); }
  Scales scales() const { return {.output = value_of(half_width)}; }

  /// N = f(b/A) - (4/pi) (b/A) sqrt(1 - (b/A)^2), b = half_width: the saturation's less that of its level.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    const double u = half_width / A;
    if (u >= 1.0) return std::complex<double>(1.0);
    return this->inside_share(u) - 4.0 / std::numbers::pi * u * std::sqrt((1.0 - u) * (1.0 + u));
  }
};

}  // namespace limcycle
