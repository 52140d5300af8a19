#pragma once
#include <cmath>
#include <complex>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Dead zone with hysteresis: y = 0 from where |x| falls to half_width until it rises to half_width + hysteresis; else
/// y = x. Before an integrator it holds the integral once the error is small, and lets it go on only when the error has
/// become larger.
///
/// Modes: +-1 passes, of the sign of x; 0 holds.
template <class S>
struct HystereticDeadZone : Memoryless<S> {
  S half_width{}, hysteresis{};

  static constexpr std::string_view kind = "hysteretic-dead-zone";
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation =
      "y = 0 from where |x| falls to half_width until it rises to half_width + hysteresis; else y = x";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<HystereticDeadZone, S>> parameters() {
    return {{"half_width", "1", "|x| at which it begins to hold", &HystereticDeadZone::half_width, positive},
            {"hysteresis", "1", "by which |x| must then exceed half_width", &HystereticDeadZone::hysteresis, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const { return mode.value == 0 ? S(0.0) : in.x; }
  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    if (mode.value != 0) {
      g[0] = S(mode.value > 0 ? 1.0 : -1.0) * in.x - half_width;
    } else {
      g[0] = outer() - in.x;
      g[1] = outer() + in.x;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S>, int fired) const {
    if (mode.value == 0) return {fired == 0 ? 1 : -1};
    const bool jumped_across = -static_cast<double>(mode.value) * value_of(in.x) > value_of(outer());
    return jumped_across ? Mode{-mode.value} : Mode{0};
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    if (std::abs(in.x) <= value_of(half_width)) return {0};
    return {in.x > 0.0 ? 1 : -1};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  double switching_input() const { return value_of(outer()); }
  Scales scales() const { return {.output = value_of(outer())}; }

  /// Passing from sin t1 = (half_width + hysteresis)/A until sin t2 = half_width/A, t2 > pi/2, in each half period:
  ///   pi N = t2 - t1 - sin t2 cos t2 + sin t1 cos t1 + j (sin(t2)^2 - sin(t1)^2);
  /// 0 for A <= half_width + hysteresis, where it holds.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    if (A <= outer()) return std::complex<double>(0.0);
    const double rise = outer() / A, fall = half_width / A;
    const double t1 = std::asin(rise), t2 = std::numbers::pi - std::asin(fall);
    const double real =
        t2 - t1 + fall * std::sqrt((1.0 - fall) * (1.0 + fall)) + rise * std::sqrt((1.0 - rise) * (1.0 + rise));
    return std::complex<double>(real, fall * fall - rise * rise) / std::numbers::pi;
  }

 private:
  S outer() const { return half_width + hysteresis; }
};

}  // namespace limcycle
