#pragma once
#include "limcycle/models/element/linear_state.hpp"
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Dahl friction: dF/dx = sigma0 |1 - s F/Fc|^i sgn(1 - s F/Fc) with s = sgn(v); state z = F/sigma0 (m).
/// One state; rate-independent; local memory; drifts under biased forces; |F| <= Fc is invariant for i >= 1; passive.
/// Dahl (1968, 1976).
template <class S>
struct Dahl {
  S Fc{}, sigma0{}, exponent{1.0};

  static constexpr std::string_view kind = "dahl";
  static constexpr bool is_one_state = true;
  static constexpr bool rate_independent = true;
  static constexpr std::string_view equation =
      "dz/dt = v |1 - s sigma0 z/Fc|^exponent sgn(1 - s sigma0 z/Fc), s = sgn(v);  F = sigma0 z";
  static constexpr std::string_view source =
      "Dahl (1968), Aerospace Corp. TOR-0158(3107-18)-1; Dahl (1976), AIAA J. 14(12)";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = true,
      .drift =
          "ratchets under a biased periodic force of any size: for exponent 1, (Fc/sigma0) "
          "ln[(1 - (F1/Fc)^2)/(1 - (F2/Fc)^2)] per cycle between the forces F1 and F2",
      .rate = "none: the force is a function of the path alone",
      .passivity = "yes, with the storage F^2/(2 sigma0); for exponent 1, F v - d(storage)/dt = |v| F^2/Fc",
      .evidence =
          "equation, exponents and papers are quoted from knowledge, not confirmed; the closed forms for "
          "exponent 1 were derived and checked numerically"};

  static std::vector<Parameter<Dahl, S>> parameters() {
    return {{"Fc", "N", "sliding (Coulomb) level", &Dahl::Fc, positive},
            {"sigma0", "N/m", "bristle stiffness", &Dahl::sigma0, positive},
            {"exponent", "1", "shape of the approach to Fc", &Dahl::exponent, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode, std::span<const S> z, std::span<S> dz) const {
    const S left = S(1.0) - sign(in.v) * sigma0 * z[0] / Fc;
    const S side = sign(left);  // abs() would have no slope at 0, in steady sliding, where the rate relaxes
    dz[0] = in.v * side * power(side * left, exponent);
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return sigma0 * z[0]; }
  S storage(Mode, std::span<const S> z) const { return S(0.5) * sigma0 * z[0] * z[0]; }
  bool is_linear_in_state() const { return exponent == 1.0; }
  bool has_constant_damping() const { return true; }
  LinearRate<S> linear_rate(const Input<S>& in) const {
    using std::abs;
    return {in.v, sigma0 * abs(in.v) / Fc};
  }
  LinearOutput<S> linear_output(const Input<S>&) const { return {sigma0, S(0.0), S(0.0)}; }
  static bool is_passive() { return true; }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return mode; }
  Scales scales() const { return {.displacement = value_of(Fc / sigma0), .output = value_of(Fc)}; }
  double state_scale(int) const { return value_of(Fc / sigma0); }
};

}  // namespace limcycle
