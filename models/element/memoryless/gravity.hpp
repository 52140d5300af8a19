#pragma once
#include "limcycle/models/element/memoryless/sine.hpp"

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

  S output(const Input<S>& in, Mode mode, std::span<const S> z) const { return torque().output(in, mode, z); }
  bool odd() const { return true; }
  Scales scales() const { return {.output = value_of(mass * gravity * arm)}; }

  double mean_output(double b, double A) const { return torque().mean_output(b, A); }
  double mean_slope(double b, double A) const { return torque().mean_slope(b, A); }
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    return torque().exact_describing_function(A, w, bias);
  }

 private:
  Sine<S> torque() const {
    Sine<S> sine;
    sine.amplitude = mass * gravity * arm;
    return sine;
  }
};

}  // namespace limcycle
