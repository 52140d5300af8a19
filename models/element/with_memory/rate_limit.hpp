#pragma once
#include "limcycle/models/element/piecewise.hpp"

namespace limcycle {

/// Rate limit of an actuator: the output follows the input with the time constant tau, no faster than limit:
/// dy/dt = (x - y)/tau, limited to +-limit. The output is continuous, whatever the input does. Modes: 0 following, +-1
/// moving at the limit; state: y. As tau -> 0 it becomes the ideal limiter, which passes a sinusoid of A w <= limit.
template <class S>
struct RateLimit {
  S limit{}, tau{};

  static constexpr std::string_view kind = "rate-limit";
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation = "dy/dt = (x - y)/tau, limited to +-limit";
  static constexpr std::string_view source =
      "textbook: a lag whose rate is limited, the usual model of an actuator; ideal limiter: Duda (1995)";

  static std::vector<Parameter<RateLimit, S>> parameters() {
    return {{"limit", "1/s", "largest rate of the output", &RateLimit::limit, positive},
            {"tau", "s", "time constant with which the output follows", &RateLimit::tau, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    dz[0] = mode.value == 0 ? (in.x - z[0]) / tau : S(static_cast<double>(mode.value)) * limit;
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return z[0]; }
  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    TwoBreaks<S>::guard_at(limit * tau, {in.x - z[0], in.v, in.drive}, mode, g);
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    return {mode.value != 0 ? 0 : fired == 0 ? 1 : -1};
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = in.x;
    return {0};
  }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const { return {.output = value_of(limit * tau)}; }
  double state_scale(int) const { return value_of(limit * tau); }
};

}  // namespace limcycle
