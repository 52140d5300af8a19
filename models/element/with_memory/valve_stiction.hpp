#pragma once
#include <cmath>
#include <complex>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Sticking valve by data alone: the stem stops where the command turns, and stands until the command has gone on by J,
/// or back by S, from where it was when the stem stopped; then the stem jumps by J, and follows:
/// y = x - (S - J)/2 while it moves up, x + (S - J)/2 while it moves down. S: dead band plus stick band, J: slip jump.
/// J = 0: backlash of half-gap S/2; J = S: no dead band. For a command that is a continuous function of time, the rules
/// of Choudhury and others and those of Kano and others are these; they differ in how samples of a command tell that
/// the stem stops, of which there are none here. The model of He and others (2007) stops the stem after every jump, so
/// that it climbs a ramp in steps; it is not offered.
///
/// Modes: +-1 moving up, down; +-2 standing after it. State: the y at which the stem stands.
template <class T>
struct ValveStiction {
  T S{}, J{};

  static constexpr std::string_view kind = "valve-stiction";
  static constexpr bool piecewise_affine = true;
  static constexpr bool uses_rate = true;
  static constexpr std::string_view equation =
      "y = x - (S - J)/2 moving up, x + (S - J)/2 moving down; stands from where x turns until x has gone on by J or "
      "back by S";
  static constexpr std::string_view source =
      "Choudhury, Thornhill and Shah (2005), Control Engineering Practice 13, 641-658; Kano et al. (2004), IFAC "
      "DYCOPS; "
      "both quoted from knowledge, the describing function checked against the derivation here";

  static std::vector<Parameter<ValveStiction, T>> parameters() {
    return {{"S", "1", "dead band plus stick band", &ValveStiction::S, positive},
            {"J", "1", "slip jump", &ValveStiction::J, not_negative}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<T>&, Mode, std::span<const T>, std::span<T> dz) const { dz[0] = T(0.0); }
  T output(const Input<T>& in, Mode mode, std::span<const T> z) const {
    return is_moving(mode) ? in.x - direction(mode) * half_gap() : z[0];
  }
  int guards(Mode mode) const { return is_moving(mode) ? 1 : 2; }
  void guard(const Input<T>& in, Mode mode, std::span<const T> z, std::span<T> g) const {
    const T d = direction(mode);
    if (is_moving(mode)) {
      g[0] = d * in.v;
      return;
    }
    const T gone_on = d * (in.x - z[0]) - half_gap();  // since the stem stopped
    g[0] = J - gone_on;
    g[1] = S + gone_on;
  }
  Mode next(const Input<T>& in, Mode mode, std::span<T> z, int fired) const {
    const std::int64_t up = mode.value > 0 ? 1 : -1;
    if (!is_moving(mode)) return {fired == 0 ? up : -up};
    z[0] = in.x - direction(mode) * half_gap();
    return {2 * up};
  }
  /// Moves: of the answers to a swing of S/2 to (S + J)/2 that is the one which does not stand for ever.
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = in.x;
    return {in.v < 0.0 ? -1 : 1};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  std::pair<double, double> working_gain() const { return {1.0, 0.0}; }
  double switching_input() const { return value_of(S); }
  Scales scales() const { return {.output = value_of(S)}; }
  double state_scale(int) const { return value_of(S); }

  /// With sin phi = (A - S)/A and gap = 2 (S - J)/A, the stem standing from the crest until pi - phi:
  ///   pi Re N = pi/2 + phi + 2 cos phi - sin phi cos phi - gap cos phi,
  ///   pi Im N = 2 (sin phi - 1) + cos(phi)^2 - gap sin phi;
  /// 0 for A <= S/2, where it stands for ever, as it may, after another start, up to (S + J)/2. Choudhury et al.
  /// (2005), equation of N(A).
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<T, double> {
    if (bias != 0.0) return std::nullopt;
    if (A <= 0.5 * S) return std::complex<double>(0.0);
    const double sine = 1.0 - S / A, cosine = std::sqrt((1.0 - sine) * (1.0 + sine)), phi = std::asin(sine);
    const double gap = 2.0 * (S - J) / A;
    const double b = 2.0 * cosine + std::numbers::pi / 2.0 + phi - sine * cosine - gap * cosine;
    const double a = 2.0 * (sine - 1.0) + cosine * cosine - gap * sine;
    return std::complex<double>(b, a) / std::numbers::pi;
  }

 private:
  T half_gap() const { return T(0.5) * (S - J); }
  static bool is_moving(Mode mode) { return std::abs(mode.value) == 1; }
  static T direction(Mode mode) { return T(mode.value > 0 ? 1.0 : -1.0); }
};

}  // namespace limcycle
