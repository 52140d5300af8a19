#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/element/concepts.hpp"
#include "limcycle/models/friction/b_spline.hpp"
#include "limcycle/models/friction/features.hpp"

namespace limcycle {

/// LuGre friction whose level g is a cubic B-spline of the speed:
///   dz/dt = v - sigma0 |v| z/g(|v|),   F = sigma0 z + sigma1 dz/dt + sigma2 v,   g = sum_k c_k B_k(|v|) > 0,
/// on clamped knots that begin at 0; from the last knot on g is the last coefficient. g is even in v, lies between the
/// least and the largest coefficient and is C2, except for a kink at the last knot if the last two coefficients differ.
/// One state; rate-dependent; local memory; drifts; |z| <= max c/sigma0 is invariant. Piatkowski and Wolski (2018).
///
/// Mode: the index of the knot span that contains |v|, the last one standing for the speeds beyond. The equations do
/// not depend on it: it splits panels and steps at the knots.
template <class S>
struct LuGreSpline {
  std::vector<S> velocity, coefficients;
  S sigma0{}, sigma1{0.0}, sigma2{0.0};

  static constexpr std::string_view kind = "lugre-spline";
  static constexpr bool is_one_state = true;
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view equation =
      "dz/dt = v - sigma0 |v| z/g(|v|);  F = sigma0 z + sigma1 dz/dt + sigma2 v;  g = sum_k c_k B_k(|v|), cubic "
      "B-splines on clamped knots, constant beyond the last";
  static constexpr std::string_view source =
      "Piatkowski, Wolski (2018), Mechanism and Machine Theory 119, 37-50; curve after de Boor (1972)";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = true,
      .drift = "drifts under biased forces, cycle by cycle, as LuGre does",
      .rate = "g(v) in sliding, sigma1 and sigma2 everywhere",
      .passivity =
          "passive if sigma2/sigma1 >= (max g - min g)/min g; with unbounded speed it must have sigma2/sigma1 "
          ">= max g/g(infinity) - 1; in between it depends on the curve",
      .evidence =
          "LuGre with a cubic B-spline of the friction coefficient, as the abstract says; knots, end conditions "
          "and the form of the equations are a reconstruction, coefficients here in N"};

  static std::vector<Parameter<LuGreSpline, S>> parameters() {
    return {{"velocity", "m/s", "knots, ascending from 0", &LuGreSpline::velocity, not_negative},
            {"coefficients", "N", "of the cubic B-splines: two more than knots", &LuGreSpline::coefficients, positive},
            {"sigma0", "N/m", "bristle stiffness", &LuGreSpline::sigma0, positive},
            {"sigma1", "N s/m", "bristle damping", &LuGreSpline::sigma1, not_negative, false},
            {"sigma2", "N s/m", "viscous friction", &LuGreSpline::sigma2, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const {
    if (velocity.size() < 2) return BrokenRule{"velocity", "must have two knots or more"};
    if (!(velocity.front() == 0.0)) return BrokenRule{"velocity", "must begin with 0"};
    for (std::size_t i = 1; i < velocity.size(); ++i)
      if (!(velocity[i] > velocity[i - 1])) return BrokenRule{"velocity", "must ascend from knot to knot"};
    if (coefficients.size() != velocity.size() + 2)
      return BrokenRule{"coefficients", "must be two more than the " + std::to_string(velocity.size()) + " knots"};
    for (const S& c : coefficients)
      if (!(c > 0.0)) return BrokenRule{"coefficients", "must all be positive, so that g is"};
    return std::nullopt;
  }

  /// g(v), N.
  S level(const S& v) const {
    using std::abs;
    return cubic_b_spline<S>(velocity, coefficients, abs(v));
  }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode, std::span<const S> z, std::span<S> dz) const {
    using std::abs;
    dz[0] = in.v - sigma0 * abs(in.v) * z[0] / level(in.v);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    S dz[1];
    rate(in, mode, z, dz);
    return sigma0 * z[0] + sigma1 * dz[0] + sigma2 * in.v;
  }

  /// Energy of the bristles.
  S storage(Mode, std::span<const S> z) const { return S(0.5) * sigma0 * z[0] * z[0]; }

  /// Spans overlap slightly: no accuracy is lost, as the curve is C2, and v resting on a knot does not switch.
  int guards(Mode mode) const { return mode.value == 0 || beyond(mode) ? 1 : 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    using std::abs;
    const auto i = static_cast<std::size_t>(mode.value);
    const S speed = abs(in.v);
    if (!beyond(mode)) g[0] = velocity[i + 1] + overlap(i + 1) - speed;
    if (i > 0) g[beyond(mode) ? 0 : 1] = speed - (velocity[i] - overlap(i));
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    return {!beyond(mode) && fired == 0 ? mode.value + 1 : mode.value - 1};
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    using std::abs;
    const S speed = S(std::abs(in.v));
    const std::size_t i = speed < velocity.back() ? span_of<S>(velocity, speed) : velocity.size() - 1;
    return {static_cast<std::int64_t>(i)};
  }

  std::vector<double> knots() const { return {velocity.begin(), velocity.end()}; }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return mode; }
  Scales scales() const {
    double closest = infinite;
    for (std::size_t i = 1; i < velocity.size(); ++i)
      closest = std::min(closest, value_of(velocity[i] - velocity[i - 1]));
    return {.displacement = value_of(coefficients.front() / sigma0), .velocity = closest, .output = largest()};
  }
  double state_scale(int) const { return largest() / value_of(sigma0); }

 private:
  bool beyond(Mode mode) const { return static_cast<std::size_t>(mode.value) + 1 == velocity.size(); }
  /// The curve's third derivative jumps at an inner knot, its slope at the last.
  S overlap(std::size_t knot) const {
    const S width = velocity[knot] - velocity[knot - 1];
    return S(knot + 1 == velocity.size() ? 1e-13 : 1e-6) * width;
  }
  double largest() const {
    double most = 0.0;
    for (const S& c : coefficients) most = std::max(most, value_of(c));
    return most;
  }
};

}  // namespace limcycle
