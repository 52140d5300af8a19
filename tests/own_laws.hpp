#pragma once
#include <cmath>

#include "limcycle/models/friction/own_law.hpp"

/// Friction laws as a user writes them: plain types on double, which share no code with those of the library.
namespace limcycle::test {

/// LuGre with the levels of its paper; nothing but what is needed.
struct PlainLuGre {
  double Fs = 1.5, Fc = 1.0, vs = 1e-3, sigma0 = 1e5, sigma1 = std::sqrt(1e5), sigma2 = 0.4;

  int states() const { return 1; }
  double level(double v) const { return Fc + (Fs - Fc) * std::exp(-(v / vs) * (v / vs)); }
  double z_rate(double v, double z) const { return v - sigma0 * std::abs(v) / level(v) * z; }
  void rate(const Input<double>& in, Mode, std::span<const double> z, std::span<double> dz) const {
    dz[0] = z_rate(in.v, z[0]);
  }
  double output(const Input<double>& in, Mode, std::span<const double> z) const {
    return sigma0 * z[0] + sigma1 * z_rate(in.v, z[0]) + sigma2 * in.v;
  }
  Scales scales() const { return {.displacement = Fs / sigma0, .velocity = vs, .output = Fs}; }
};

/// The same with what else it may say of itself.
struct NamedLuGre : PlainLuGre {
  static constexpr std::string_view kind = "my-lugre";
  bool odd() const { return true; }
  double storage(Mode, std::span<const double> z) const { return 0.5 * sigma0 * z[0] * z[0]; }
};

/// Dahl's law of exponent 1.
struct OwnDahl {
  static constexpr std::string_view kind = "my-dahl";
  double Fc = 1.0, sigma0 = 1e4;

  int states() const { return 1; }
  void rate(const Input<double>& in, Mode, std::span<const double> z, std::span<double> dz) const {
    dz[0] = in.v - sigma0 * std::abs(in.v) * z[0] / Fc;
  }
  double output(const Input<double>&, Mode, std::span<const double> z) const { return sigma0 * z[0]; }
  bool odd() const { return true; }
  Scales scales() const { return {.displacement = Fc / sigma0, .output = Fc}; }
  double storage(Mode, std::span<const double> z) const { return 0.5 * sigma0 * z[0] * z[0]; }
};

/// A Stribeck curve rounded off about v = 0: F = (Fc + (Fs - Fc) exp(-(v/vs)^2)) tanh(v/v0). No state.
struct RoundStribeck {
  static constexpr std::string_view kind = "round-stribeck";
  double Fs = 1.5, Fc = 1.0, vs = 0.05, v0 = 0.005;

  double output(const Input<double>& in, Mode, std::span<const double>) const {
    return (Fc + (Fs - Fc) * std::exp(-(in.v / vs) * (in.v / vs))) * std::tanh(in.v / v0);
  }
  double slope(double v) const {
    const double curve = (Fs - Fc) * std::exp(-(v / vs) * (v / vs)), t = std::tanh(v / v0);
    return -2.0 * v / (vs * vs) * curve * t + (Fc + curve) * (1.0 - t * t) / v0;
  }
  bool odd() const { return true; }
  Scales scales() const { return {.velocity = v0, .output = Fs}; }
};

/// Jenkins' slider: two modes on each side of one that sticks, and where it comes to by sliding.
struct OwnJenkins {
  static constexpr std::string_view kind = "my-jenkins";
  double k = 1e4, Fc = 1.0;

  int states() const { return 1; }
  void rate(const Input<double>& in, Mode mode, std::span<const double>, std::span<double> dz) const {
    dz[0] = mode.value == 0 ? in.v : 0.0;
  }
  double output(const Input<double>&, Mode, std::span<const double> z) const { return k * z[0]; }
  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  void guard(const Input<double>& in, Mode mode, std::span<const double> z, std::span<double> g) const {
    if (mode.value != 0) {
      g[0] = mode.value > 0 ? in.v : -in.v;
      return;
    }
    const auto left = [this](double force) { return std::abs(Fc - force) < 1e-13 * Fc ? 0.0 : Fc - force; };
    g[0] = left(k * z[0]);
    g[1] = left(-k * z[0]);
  }
  Mode next(const Input<double>&, Mode mode, std::span<double> z, int fired) const {
    if (mode.value != 0) return {0};
    z[0] = (fired == 0 ? Fc : -Fc) / k;
    return {fired == 0 ? 1 : -1};
  }
  Mode start(const Input<double>&, std::span<double> z) const {
    z[0] = 0.0;
    return {0};
  }
  Mode after_sliding(const Input<double>& in, std::span<double> z) const {
    z[0] = std::copysign(Fc / k, in.v);
    return {in.v > 0.0 ? 1 : -1};
  }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const { return {.displacement = Fc / k, .output = Fc}; }
};

}  // namespace limcycle::test
