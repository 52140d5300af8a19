#pragma once
#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Cubic: y = coefficient x^3.
template <class S>
struct Cubic : Memoryless<S> {
  S coefficient{};

  static constexpr std::string_view kind = "cubic";
  static constexpr std::string_view equation = "y = coefficient x^3";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<Cubic, S>> parameters() {
    return {{"coefficient", "1", "factor of x^3", &Cubic::coefficient, any_number}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode, std::span<const S>) const { return coefficient * in.x * in.x * in.x; }
  bool odd() const { return true; }
  Scales scales() const { return {.output = std::abs(value_of(coefficient))}; }

  /// N = (3/4) c A^2 + 3 c bias^2, since the sine part of (b + A s)^3 is (3 b^2 A + 3 A^3/4) (claim A10).
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    return coefficient * (0.75 * A * A + 3.0 * bias * bias);
  }
};

}  // namespace limcycle
