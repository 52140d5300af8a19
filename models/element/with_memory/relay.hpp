#pragma once
#include <cmath>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Relay: output +level, 0 or -level. It switches on at |x| = dead_zone + hysteresis and off at dead_zone - hysteresis
/// (without dead zone: from +level to -level at x = -hysteresis). Without hysteresis it is set-valued at the switching
/// input and may slide there: the output then holds the input, as long as it lies within the jump.
/// Modes: +1, 0, -1 for the output; +2 and -2 for sliding at the upper or lower switching input.
template <class S>
struct Relay : Memoryless<S> {
  S level{}, hysteresis{0.0}, dead_zone{0.0};

  static constexpr std::string_view kind = "relay";
  static constexpr bool piecewise_affine = true;
  static constexpr Held holds = Held::input;
  static constexpr std::string_view equation =
      "y = level sgn(x) switching on at |x| = dead_zone + hysteresis, off at |x| = dead_zone - hysteresis";
  static constexpr std::string_view source = "Gelb and Vander Velde (1968)";

  static std::vector<Parameter<Relay, S>> parameters() {
    return {{"level", "1", "output when on", &Relay::level, positive},
            {"hysteresis", "1", "half-width of the hysteresis", &Relay::hysteresis, not_negative, false},
            {"dead_zone", "1", "half-width of the dead zone", &Relay::dead_zone, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const {
    if (dead_zone > 0.0 && hysteresis > dead_zone) return BrokenRule{"hysteresis", "must not exceed dead_zone"};
    return std::nullopt;
  }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    return std::abs(mode.value) == 2 ? in.drive : S(static_cast<double>(mode.value)) * level;
  }
  Held held(Mode mode) const { return std::abs(mode.value) == 2 ? Held::input : Held::nothing; }
  int guards(Mode mode) const { return mode.value == 0 || std::abs(mode.value) == 2 ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    switch (mode.value) {
      case 1:
        g[0] = in.x - (dead_zone - hysteresis);
        break;
      case -1:
        g[0] = -in.x - (dead_zone - hysteresis);
        break;
      case 0:
        g[0] = dead_zone + hysteresis - in.x;
        g[1] = dead_zone + hysteresis + in.x;
        break;
      default:
        g[0] = upper(mode) - in.drive;
        g[1] = in.drive - lower(mode);
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S>, int fired) const {
    if (std::abs(mode.value) == 2) {  // the drive left the jump at its upper or lower end
      if (dead_zone > 0.0) return mode.value == 2 ? Mode{fired == 0 ? 1 : 0} : Mode{fired == 0 ? 0 : -1};
      return {fired == 0 ? 1 : -1};
    }
    const bool at_upper = mode.value == 1 || (mode.value == 0 && fired == 0);
    const Mode sliding{at_upper ? 2 : -2};
    if (hysteresis == 0.0 && in.drive <= upper(sliding) && in.drive >= lower(sliding)) return sliding;
    if (mode.value == 0) return {fired == 0 ? 1 : -1};
    return {dead_zone > 0.0 ? 0 : -mode.value};
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    if (in.x > dead_zone + hysteresis) return {1};
    if (in.x < -(dead_zone + hysteresis)) return {-1};
    if (dead_zone > 0.0) return {0};
    if (hysteresis == 0.0 && in.drive <= level && in.drive >= -level) return {2};
    return {in.x > 0.0 || (in.x == 0.0 && in.drive >= 0.0) ? 1 : -1};
  }
  double switching_input() const { return value_of(hysteresis > dead_zone ? hysteresis : dead_zone); }
  bool odd() const { return true; }
  Scales scales() const { return {.output = value_of(level)}; }

  /// For the input b + A sin wt: the side of sign s = 1, -1 switches on where s x = d + h and off where s x = d - h.
  /// Each side that does both adds M/(pi A) (sqrt(1 - ((d-h-sb)/A)^2) + sqrt(1 - ((d+h-sb)/A)^2) - 2j h/A) to N: for b
  /// = 0 and A > d + h claims A1, A4 and A5; with a bias derived here. 0 where a biased input switches no side; empty
  /// where an unbiased input switches no side and the output depends on the history.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    std::complex<double> N = 0.0;
    for (const double b : {bias, -bias}) {
      const Side side = side_under(A, b);
      if (side == Side::undecided && bias == 0.0) return std::nullopt;
      if (side != Side::switches) continue;
      const auto root = [A](double at) { return std::sqrt((A - at) * (A + at)) / A; };
      N += level / (std::numbers::pi * A) *
           std::complex<double>(root(dead_zone - hysteresis - b) + root(dead_zone + hysteresis - b),
                                -2.0 * hysteresis / A);
    }
    return N;
  }
  /// Mean of the output for the same input: M (share of the time in which the upper side is on, less that of the
  /// lower).
  double exact_mean(double A, double bias) const requires std::same_as<S, double> {
    double mean = 0.0;
    for (const double sign : {1.0, -1.0}) {
      const double b = sign * bias;
      const Side side = side_under(A, b);
      if (side == Side::on) mean += sign;
      if (side == Side::undecided) mean += 0.5 * sign;
      if (side == Side::switches)
        mean +=
            sign * (0.5 - (std::asin((dead_zone - hysteresis - b) / A) + std::asin((dead_zone + hysteresis - b) / A)) /
                              (2.0 * std::numbers::pi));
    }
    return mean * level;
  }

 private:
  enum class Side { off, on, switches, undecided };
  /// State of the upper side in the steady state; depends on the history if it neither switches on nor off.
  Side side_under(double A, double bias) const requires std::same_as<S, double> {
    const bool turns_on = A > dead_zone + hysteresis - bias, turns_off = A > bias - (dead_zone - hysteresis);
    if (turns_on && turns_off) return Side::switches;
    if (turns_on || turns_off) return turns_on ? Side::on : Side::off;
    return Side::undecided;
  }
  S upper(Mode mode) const { return dead_zone > 0.0 && mode.value == -2 ? S(0.0) : level; }
  S lower(Mode mode) const { return dead_zone > 0.0 && mode.value == 2 ? S(0.0) : -level; }
};

}  // namespace limcycle
