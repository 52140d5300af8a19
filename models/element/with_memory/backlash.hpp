#pragma once
#include "limcycle/models/element/piecewise.hpp"

namespace limcycle {

/// Backlash with a friction-held output (play): the output follows slope (x -+ half_gap) while driven and is constant
/// while the input crosses the gap. Modes: +1 driven upwards, -1 driven downwards, 0 held; state: the held output.
template <class S>
struct Backlash {
  S slope{1.0}, half_gap{};

  static constexpr std::string_view kind = "backlash";
  static constexpr bool piecewise_affine = true;
  static constexpr bool uses_rate = true;
  static constexpr std::string_view equation =
      "y = slope (x - half_gap) while driven up, slope (x + half_gap) while driven down, standing in between";
  static constexpr std::string_view source = "Gelb and Vander Velde (1968), friction-controlled backlash";

  static std::vector<Parameter<Backlash, S>> parameters() {
    return {{"half_gap", "1", "half of the gap", &Backlash::half_gap, positive},
            {"slope", "1", "slope while driven", &Backlash::slope, positive, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>&, Mode, std::span<const S>, std::span<S> dz) const { dz[0] = S(0.0); }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    return mode.value == 0 ? z[0] : slope * (in.x - S(static_cast<double>(mode.value)) * half_gap);
  }
  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    if (mode.value == 0) {
      g[0] = z[0] - slope * (in.x - half_gap);
      g[1] = slope * (in.x + half_gap) - z[0];
    } else {
      g[0] = mode.value == 1 ? in.v : -in.v;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    if (mode.value == 0) return {fired == 0 ? 1 : -1};
    z[0] = slope * (in.x - S(static_cast<double>(mode.value)) * half_gap);
    return {0};
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = value_of(slope) * in.x;
    return {0};
  }
  std::pair<double, double> working_gain() const { return {value_of(slope), 0.0}; }
  double switching_input() const { return value_of(half_gap); }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const { return {.output = value_of(slope * half_gap)}; }
  double state_scale(int) const { return value_of(slope * half_gap); }

  /// N = slope ((1 + f(1 - 2h/A))/2 - j (4/pi)(h/A)(1 - h/A)), 0 for A <= h (claim A7).
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    const double gap = half_gap / A;
    if (gap >= 1.0) return std::complex<double>(0.0);
    const double u = 1.0 - 2.0 * gap;
    const double f = u < 0.0 ? -TwoBreaks<double>::inside_share(-u) : TwoBreaks<double>::inside_share(u);
    return slope * std::complex<double>(0.5 * (1.0 + f), -4.0 / std::numbers::pi * gap * (1.0 - gap));
  }
};

}  // namespace limcycle
