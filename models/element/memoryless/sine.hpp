#pragma once
#include <cmath>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Sine of the input: y = amplitude sin(2 pi x/period), x in the unit of the signal that it reads. With the period of a
/// turn, 2 pi, a phase detector or the weight of a pendulum; with a pole pitch the cogging of a motor.
template <class S>
struct Sine : Memoryless<S> {
  S amplitude{}, period{2.0 * std::numbers::pi};

  static constexpr std::string_view kind = "sine";
  static constexpr std::string_view equation = "y = amplitude sin(2 pi x/period)";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<Sine, S>> parameters() {
    return {
        {"amplitude", "1", "largest output", &Sine::amplitude, any_number},
        {"period", "1", "change of the input after which the output repeats itself", &Sine::period, positive, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode, std::span<const S>) const {
    using std::sin;
    return amplitude * sin(S(wave_number()) * in.x);
  }
  bool odd() const { return true; }
  /// It bends within an eighth of a period.
  Scales scales() const { return {.displacement = 0.125 * value_of(period), .output = std::abs(value_of(amplitude))}; }
  std::pair<double, double> slope_bounds() const {
    const double steepest = std::abs(value_of(amplitude)) * wave_number_value();
    return {-steepest, steepest};
  }
  std::pair<double, double> working_gain() const { return {value_of(amplitude) * wave_number_value(), 0.0}; }

  /// The mean of sin(k (b + A sin wt)) is J0(k A) sin k b (Abramowitz and Stegun, 9.1.44-45), J0 the Bessel function,
  /// k = 2 pi/period.
  double mean_output(double b, double A) const {
    const double k = wave_number_value();
    return value_of(amplitude) * std::cyl_bessel_j(0.0, std::abs(k * A)) * std::sin(k * b);
  }
  double mean_slope(double b, double A) const {
    const double k = wave_number_value();
    return value_of(amplitude) * k * std::cyl_bessel_j(0.0, std::abs(k * A)) * std::cos(k * b);
  }

  /// N = amplitude 2 J1(k A)/A cos(k bias): the sine part of sin(k (b + A sin wt)) is 2 J1(k A) cos k b.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    const double k = wave_number_value();
    return amplitude * 2.0 * std::cyl_bessel_j(1.0, k * A) / A * std::cos(k * bias);
  }

 private:
  S wave_number() const { return S(2.0 * std::numbers::pi) / period; }
  double wave_number_value() const { return value_of(wave_number()); }
};

}  // namespace limcycle
