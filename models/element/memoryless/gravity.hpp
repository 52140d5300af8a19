#pragma once
#include <cmath>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Torque of the weight of a pendulum, N m, at the angle x (rad) from hanging: y = mass gravity arm sin(x).
template <class S>
struct Gravity : Memoryless<S> {
  S mass{}, gravity{}, arm{};

  static constexpr std::string_view kind = "gravity";
  static constexpr std::string_view equation = "y = mass gravity arm sin(x)";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<Gravity, S>> parameters() {
    return {{"mass", "kg", "mass of the pendulum", &Gravity::mass, positive},
            {"gravity", "m/s^2", "acceleration of gravity", &Gravity::gravity, not_negative},
            {"arm", "m", "from the axis to the centre of mass", &Gravity::arm, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode, std::span<const S>) const {
    using std::sin;
    return mass * gravity * arm * sin(in.x);
  }
  bool odd() const { return true; }
  Scales scales() const { return {.output = value_of(mass * gravity * arm)}; }

  /// The mean of sin(b + A sin wt) is J0(A) sin b (Abramowitz and Stegun, 9.1.44-45), J0 the Bessel function.
  double mean_output(double b, double A) const {
    return value_of(mass * gravity * arm) * std::cyl_bessel_j(0.0, std::abs(A)) * std::sin(b);
  }
  double mean_slope(double b, double A) const {
    return value_of(mass * gravity * arm) * std::cyl_bessel_j(0.0, std::abs(A)) * std::cos(b);
  }

  /// N = mass gravity arm 2 J1(A)/A cos(bias): the sine part of sin(b + A sin wt) is 2 J1(A) cos b.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    return mass * gravity * arm * 2.0 * std::cyl_bessel_j(1.0, A) / A * std::cos(bias);
  }
};

}  // namespace limcycle
