#pragma once
#include "limcycle/models/element/piecewise.hpp"

namespace limcycle {

/// Saturation: y = slope x, limited to +-limit.
template <class S>
struct Saturation : TwoBreaks<S> {
  S slope{1.0}, limit{};

  static constexpr std::string_view kind = "saturation";
  static constexpr std::string_view equation = "y = slope x, limited to +-limit";
  static constexpr std::string_view source = "Gelb and Vander Velde (1968)";

  static std::vector<Parameter<Saturation, S>> parameters() {
    return {{"limit", "1", "largest output", &Saturation::limit, positive},
            {"slope", "1", "slope inside", &Saturation::slope, positive, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    return mode.value == 0 ? slope * in.x : S(static_cast<double>(mode.value)) * limit;
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    this->guard_at(limit / slope, in, mode, g);
  }
  Mode start(const Input<double>& in, std::span<double>) const { return this->start_at(value_of(limit / slope), in); }
  bool odd() const { return true; }
  std::pair<double, double> slope_bounds() const { return {0.0, value_of(slope)}; }
  Scales scales() const { return {.output = value_of(limit)}; }

  /// N = slope f(b/A), b = limit/slope (claim A6).
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    return slope * this->inside_share(limit / slope / A);
  }
};

}  // namespace limcycle
