#pragma once
#include <random>
#include <string>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/tests/loops.hpp"

/// Laws and elements shared by the tests of describing functions.
namespace limcycle::test {

inline Dahl<double> dahl(double exponent = 1.0) {
  Dahl<double> law;
  law.Fc = 1.0;
  law.sigma0 = 1e5;
  law.exponent = exponent;
  return law;
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

/// Refined by the quadrature route alone.
template <class Law>
DescribingFunction quadrature(const Law& law, double A, double w, double bias, double accuracy, int harmonics = 7) {
  const PrescribedMotion motion(A, w, bias, true);
  return QuadratureRoute(law, motion, law.odd() && bias == 0.0, with(DfMethod::quadrature, accuracy, harmonics))
      .refine();
}

}  // namespace limcycle::test
