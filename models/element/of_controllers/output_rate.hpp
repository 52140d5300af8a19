#pragma once
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"

namespace limcycle {

/// Rate of the output of a dead zone or a saturation: y = slope(x) dx/dt, with the slope `inside` for |x| <= half_width
/// and `outside` elsewhere. It is added next to the element itself where a controller differentiates that output.
template <class S>
struct OutputRate : TwoBreaks<S> {
  S inside{0.0}, outside{0.0}, half_width{};

  static constexpr std::string_view kind = "output-rate";
  static constexpr bool acts_on_rate = true;
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view equation =
      "y = inside dx/dt for |x| <= half_width, else outside dx/dt: rate of a dead zone's or a saturation's output";
  static constexpr std::string_view source = "chain rule";

  static OutputRate of(const DeadZone<S>& element) {
    OutputRate rate;
    rate.outside = element.slope;
    rate.half_width = element.half_width;
    return rate;
  }
  static OutputRate of(const Saturation<S>& element) {
    OutputRate rate;
    rate.inside = element.slope;
    rate.half_width = element.limit / element.slope;
    return rate;
  }

  static std::vector<Parameter<OutputRate, S>> parameters() {
    return {{"inside", "1", "slope between the breaks", &OutputRate::inside, not_negative},
            {"outside", "1", "slope outside", &OutputRate::outside, not_negative},
            {"half_width", "1", "input at which the slope changes", &OutputRate::half_width, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    return (mode.value == 0 ? inside : outside) * in.v;
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    this->guard_at(half_width, in, mode, g);
  }
  Mode start(const Input<double>& in, std::span<double>) const { return this->start_at(value_of(half_width), in); }
  std::pair<double, double> working_gain() const { return {0.0, value_of(inside > outside ? inside : outside)}; }
  bool odd() const { return true; }
  Scales scales() const { return {}; }

  /// N = j w (inside f + outside (1 - f)), f = f(half_width/A): j w times that of the element (claims A6, A6b).
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    const double share = this->inside_share(half_width / A);
    return std::complex<double>(0.0, w * (inside * share + outside * (1.0 - share)));
  }
};

}  // namespace limcycle
