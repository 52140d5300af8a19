#pragma once
#include <cmath>

#include "limcycle/models/friction/own_law.hpp"

/// Friction laws as a user writes them: plain types on double, which share no code with those of the library.
namespace limcycle::test {

/// LuGre with the levels of its paper; required members only.
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

/// The same with optional members.
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

/// Jenkins' slider: a sticking mode, a slipping one on each side, and its state after long sliding.
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

/// Dry friction with stiction, which holds its body at rest: modes 0 at rest, +1 and -1 sliding.
struct OwnStiction {
  static constexpr std::string_view kind = "my-stiction";
  static constexpr Held holds = Held::rate;
  double Fs = 1.5, Fc = 1.0, sigma2 = 0.4;

  double output(const Input<double>& in, Mode mode, std::span<const double>) const {
    return mode.value == 0 ? in.drive : static_cast<double>(mode.value) * Fc + sigma2 * in.v;
  }
  Held held(Mode mode) const { return mode.value == 0 ? Held::rate : Held::nothing; }
  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  void guard(const Input<double>& in, Mode mode, std::span<const double>, std::span<double> g) const {
    if (mode.value != 0) {
      g[0] = static_cast<double>(mode.value) * in.v;
      return;
    }
    g[0] = Fs - in.drive;
    g[1] = Fs + in.drive;
  }
  Mode next(const Input<double>& in, Mode mode, std::span<double>, int fired) const {
    if (mode.value == 0) return {fired == 0 ? 1 : -1};
    return at_rest(in.drive);
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    return in.v > 0.0 ? Mode{1} : in.v < 0.0 ? Mode{-1} : at_rest(in.drive);
  }
  Mode at_rest(double drive) const { return {drive > Fs ? 1 : drive < -Fs ? -1 : 0}; }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const { return {.output = Fs}; }
};

/// The same bristle as TemplatedDahl, which converts itself to another scalar.
template <class S>
struct RemadeDahl {
  S Fc{1.0}, sigma0{1e4};

  template <class To>
  RemadeDahl<To> on() const {
    return {To(value_of(Fc)), To(value_of(sigma0))};
  }
  int states() const { return 1; }
  void rate(const Input<S>& in, Mode, std::span<const S> z, std::span<S> dz) const {
    using std::abs;
    dz[0] = in.v - sigma0 * abs(in.v) * z[0] / Fc;
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return sigma0 * z[0]; }
  Scales scales() const { return {.displacement = value_of(Fc / sigma0), .output = value_of(Fc)}; }
};

/// A bristle on any scalar, with the parameter table that converts it: its derivatives are exact.
template <class S>
struct TemplatedDahl {
  static constexpr std::string_view kind = "templated-dahl";
  S Fc{1.0}, sigma0{1e4};

  static std::vector<Parameter<TemplatedDahl, S>> parameters() {
    return {{"Fc", "N", "level", &TemplatedDahl::Fc, positive},
            {"sigma0", "N/m", "stiffness", &TemplatedDahl::sigma0, positive}};
  }
  int states() const { return 1; }
  void rate(const Input<S>& in, Mode, std::span<const S> z, std::span<S> dz) const {
    using std::abs;
    dz[0] = in.v - sigma0 * abs(in.v) * z[0] / Fc;
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return sigma0 * z[0]; }
  bool odd() const { return true; }
  Scales scales() const { return {.displacement = value_of(Fc / sigma0), .output = value_of(Fc)}; }
};

}  // namespace limcycle::test
