#pragma once
#include <cmath>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Friction compensation: y = level sgn(v), v the rubbing velocity of the friction law in the same loop. Modes: +1 and
/// -1, the sign of v. At v = 0 a set-valued law has a selection, and the compensation takes the same one: the output is
/// level times that selection (see Port::selection_of). With a law that is not set-valued, the output is single-valued
/// except at zero crossings of v.
template <class S>
struct Compensation : Memoryless<S> {
  S level{};

  static constexpr Mode forward{1}, backward{-1};
  static constexpr std::string_view kind = "friction-compensation";
  static constexpr bool acts_on_rate = true;
  static constexpr bool piecewise_affine = true;
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view equation = "y = level sgn(v); at v = 0 the selection of the friction law, if any";
  static constexpr std::string_view source = "textbook";

  static std::vector<Parameter<Compensation, S>> parameters() {
    return {{"level", "N", "size of the compensating force", &Compensation::level, not_negative}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>&, Mode mode, std::span<const S>) const { return S(static_cast<double>(mode.value)) * level; }
  int guards(Mode) const { return 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    g[0] = mode == forward ? in.v : -in.v;
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int) const { return mode == forward ? backward : forward; }
  Mode start(const Input<double>& in, std::span<double>) const {
    return in.v > 0.0 || (in.v == 0.0 && in.drive >= 0.0) ? forward : backward;
  }
  bool odd() const { return true; }
  Scales scales() const { return {.output = value_of(level)}; }

  /// N = j 4 level/(pi A) sqrt(1 - (V/(A w))^2) for x = V t + A sin wt, a mean velocity V below A w; 0 above.
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    const double ratio = bias / (A * w);
    if (std::abs(ratio) >= 1.0) return std::complex<double>(0.0);
    return std::complex<double>(0.0, 4.0 * level / (std::numbers::pi * A) * std::sqrt((1.0 - ratio) * (1.0 + ratio)));
  }
};

}  // namespace limcycle
