#pragma once
#include "limcycle/models/element/piecewise.hpp"

namespace limcycle {

/// Dead zone: y = 0 for |x| <= half_width, slope (x -+ half_width) outside.
template <class S>
struct DeadZone : TwoBreaks<S> {
  S slope{1.0}, half_width{};

  static constexpr std::string_view kind = "dead-zone";
  static constexpr std::string_view equation = "y = 0 for |x| <= half_width, else slope (x - half_width sgn(x))";
  static constexpr std::string_view source = "Gelb and Vander Velde (1968)";

  static std::vector<Parameter<DeadZone, S>> parameters() {
    return {{"half_width", "1", "half-width of the dead zone", &DeadZone::half_width, positive},
            {"slope", "1", "slope outside", &DeadZone::slope, positive, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    return mode.value == 0 ? S(0.0) : slope * (in.x - S(static_cast<double>(mode.value)) * half_width);
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    this->guard_at(half_width, in, mode, g);
  }
  Mode start(const Input<double>& in, std::span<double>) const { return this->start_at(value_of(half_width), in); }
  bool odd() const { return true; }
  std::pair<double, double> slope_bounds() const { return {0.0, value_of(slope)}; }
  Scales scales() const { return {.output = value_of(slope * half_width)}; }

  /// N = slope (1 - f(half_width/A)), 0 for A <= half_width (claim A6b).
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    return slope * (1.0 - this->inside_share(half_width / A));
  }
};

}  // namespace limcycle
