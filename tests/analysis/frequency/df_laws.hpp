#pragma once
#include <random>
#include <string>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/models/element/backlash.hpp"
#include "limcycle/models/element/cubic.hpp"
#include "limcycle/models/element/dead_zone.hpp"
#include "limcycle/models/element/relay.hpp"
#include "limcycle/models/element/saturation.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"

/// Laws and elements shared by the tests of describing functions.
namespace df_test {

using namespace limcycle;

inline LuGre<double> lugre(double sigma2 = 0.4) {
  LuGre<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = 316.22776601683796;
  law.sigma2 = sigma2;
  return law;
}

inline Coulomb<double> coulomb(double level = 1.0) {
  Coulomb<double> law;
  law.Fc = law.Fs = law.Fc_minus = law.Fs_minus = level;
  return law;
}

inline Stribeck<double> stribeck() {
  Stribeck<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  return law;
}

inline Dahl<double> dahl(double exponent = 1.0) {
  Dahl<double> law;
  law.Fc = 1.0;
  law.sigma0 = 1e5;
  law.exponent = exponent;
  return law;
}

inline Relay<double> relay(double level, double hysteresis = 0.0, double dead_zone = 0.0) {
  Relay<double> element;
  element.level = level;
  element.hysteresis = hysteresis;
  element.dead_zone = dead_zone;
  return element;
}

inline Saturation<double> saturation(double slope, double limit) {
  Saturation<double> element;
  element.slope = slope;
  element.limit = limit;
  return element;
}

inline DeadZone<double> dead_zone(double slope, double half_width) {
  DeadZone<double> element;
  element.slope = slope;
  element.half_width = half_width;
  return element;
}

inline Backlash<double> backlash(double half_gap) {
  Backlash<double> element;
  element.half_gap = half_gap;
  return element;
}

inline Cubic<double> cubic(double coefficient) {
  Cubic<double> element;
  element.coefficient = coefficient;
  return element;
}

inline DfOptions with(DfMethod method, double accuracy, int harmonics = 7) {
  return {.harmonics = harmonics, .accuracy = accuracy, .method = method};
}

/// Relative distance of two gains.
inline double apart(std::complex<double> a, std::complex<double> b) {
  const double distance = std::abs(a - b);
  return distance == 0.0 ? 0.0 : distance / std::abs(b);
}

}  // namespace df_test
