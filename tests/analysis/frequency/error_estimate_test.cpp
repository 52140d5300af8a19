// The estimated error against the true one, over random laws, points and accuracies.
#include <catch2/catch.hpp>
#include <iostream>

#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

std::mt19937 source(20240607);

double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(source); }
double spread(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
bool coin() { return uniform(0.0, 1.0) < 0.5; }

template <class Law>
void random_levels(Law& law) {
  law.Fc = spread(0.1, 10.0);
  law.Fs = law.Fc * uniform(1.0, 2.0);
  law.Fc_minus = law.Fc;
  law.Fs_minus = law.Fs;
  if (uniform(0.0, 1.0) < 0.25) {
    law.Fc_minus = law.Fc * uniform(0.5, 1.5);
    law.Fs_minus = law.Fc_minus * uniform(1.0, 2.0);
  }
}

template <class Law>
void random_curve(Law& law) {
  random_levels(law);
  law.vs = spread(1e-6, 1e-1);
  law.delta = coin() ? 2.0 : uniform(0.5, 3.0);
  law.curve.index = static_cast<int>(uniform(0.0, 3.0));
}

struct Case {
  Element element = Coulomb<double>{};
  DfPoint point;
};

Case random_case(int kind) {
  Case c;
  const double A = spread(1e-6, 1e-1), w = spread(0.1, 1000.0);
  const double peak = A * w;
  c.point = {A, w, coin() ? 0.0 : (coin() ? 1.0 : -1.0) * peak * (coin() ? uniform(0.0, 1.2) : spread(1e-3, 1.0))};
  if (kind == 0) {
    Coulomb<double> law;
    random_levels(law);
    law.sigma2 = coin() ? 0.0 : spread(1e-3, 10.0);
    c.element = law;
  } else if (kind == 1) {
    Stribeck<double> law;
    random_curve(law);
    law.sigma2 = coin() ? 0.0 : spread(1e-3, 10.0);
    c.element = law;
  } else if (kind == 2) {
    Dahl<double> law;
    law.Fc = spread(0.1, 10.0);
    law.sigma0 = spread(1e3, 1e7);
    law.exponent = coin() ? 1.0 : uniform(0.5, 3.0);
    c.element = law;
  } else if (kind == 3) {
    LuGre<double> law;
    random_curve(law);
    law.sigma0 = spread(1e3, 1e7);
    law.sigma1 = coin() ? 0.0 : spread(1.0, 1e4);
    law.sigma2 = coin() ? 0.0 : spread(1e-3, 10.0);
    law.vd = uniform(0.0, 1.0) < 0.7 ? 0.0 : spread(1e-4, 1e-1);
    c.element = law;
  } else {
    const double size = A * uniform(0.05, 1.3);
    const double offset = coin() ? 0.0 : A * uniform(-1.2, 1.2);
    c.point.bias = offset;
    if (kind == 4) c.element = relay(spread(0.1, 10.0), size * uniform(0.0, 0.5), coin() ? 0.0 : size * 0.5);
    if (kind == 5) c.element = saturation(spread(0.1, 10.0), size);
    if (kind == 6) c.element = dead_zone(spread(0.1, 10.0), size);
    if (kind == 7) c.element = backlash(size);
    if (kind == 8) c.element = cubic(spread(0.1, 10.0));
  }
  return c;
}

/// Another mesh, other stages, far finer than those that the route uses.
DescribingFunction tight(const Case& c) {
  const PrescribedMotion motion(c.point.amplitude, c.point.frequency, c.point.bias, c.element.is_friction());
  const DfOptions options = with(DfMethod::quadrature, 1e-13, 3);
  return QuadratureRoute(c.element, motion, c.element.odd() && c.point.bias == 0.0, options)
      .on_mesh({.stages = 11, .growth = 0.17, .cap = 1e-10});
}

struct Tally {
  int cases = 0, broken = 0, badly = 0, incomplete = 0;
};

Tally tally(DfMethod method, int cases, double loosest, double tightest) {
  Tally t;
  for (int i = 0; i < cases; ++i) {
    // LuGre and Dahl are the difficult laws: more than half of the cases.
    const int kind = i % 2 == 0 ? 2 + i / 2 % 2 : i / 2 % 9;
    const Case c = random_case(kind);
    const double accuracy = spread(tightest, loosest);
    const auto df = describing_function(c.element, c.point, with(method, accuracy, 3));
    const auto exact = tight(c);
    REQUIRE(exact.status == Status::converged);
    CAPTURE(c.point.amplitude, c.point.frequency, c.point.bias, accuracy, to_string(df.status));
    UNSCOPED_INFO(c.element.kind());
    REQUIRE((df.status == Status::converged || df.status == Status::incomplete));
    if (df.status == Status::converged) CHECK(df.error <= accuracy);
    t.incomplete += df.status == Status::incomplete;
    ++t.cases;
    // No first harmonic: the result of the other setting is rounding.
    if (df.gain == 0.0 && std::abs(exact.harmonics[0]) <= 1e-11 * std::abs(exact.mean)) continue;
    const double error = apart(df.gain, exact.gain), room = exact.error;
    if (error > df.error + room) {
      ++t.broken;
      t.badly += error > 10.0 * df.error + room;
      std::ostringstream text;
      text << c.element.kind();
      UNSCOPED_INFO(text.str() << " A " << c.point.amplitude << " w " << c.point.frequency << " bias " << c.point.bias
                               << " accuracy " << accuracy << ": error " << error << " estimated " << df.error);
    }
  }
  return t;
}

}  // namespace

TEST_CASE("the estimate of the quadrature route bounds the true error", "[df][error]") {
  const Tally t = tally(DfMethod::quadrature, 900, 1e-3, 1e-10);
  CAPTURE(t.cases, t.broken, t.incomplete);
  CHECK(t.broken <= t.cases / 100);
  CHECK(t.badly == 0);
  CHECK(t.incomplete <= t.cases / 50);
}

TEST_CASE("the estimate of the FFT route bounds the true error", "[df][error][fft]") {
  const Tally t = tally(DfMethod::fft, 150, 1e-2, 1e-4);
  CAPTURE(t.cases, t.broken, t.incomplete);
  CHECK(t.broken <= t.cases / 100);
  CHECK(t.badly == 0);
}
