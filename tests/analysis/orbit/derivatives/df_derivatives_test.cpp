#include "limcycle/analysis/orbit/derivatives/df_derivatives.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

template <class Law>
using Members = std::vector<std::pair<const char*, double Law::*>>;

template <class Law>
std::vector<ElementNeighbours> beside(const Law& law, const Members<Law>& members) {
  std::vector<ElementNeighbours> pairs;
  for (const auto& [name, member] : members) {
    Law low = law, high = law;
    low.*member *= 1.0 - 1e-6;
    high.*member *= 1.0 + 1e-6;
    pairs.push_back({low, high, 0.5 * (high.*member - low.*member), law.*member});
  }
  return pairs;
}

Complex gain_of(const Element& element, const DfPoint& at) {
  DfOptions options;
  options.accuracy = 1e-12;
  options.harmonics = 1;
  const auto found = describing_function(element, at, options);
  REQUIRE(found.answered());
  return found.gain;
}

/// Difference of order 6.
Complex difference(double at, const std::function<Complex(double)>& f) {
  Complex sum = 0.0;
  const double h = 1e-3 * at;
  for (const auto& [steps, weight] : {std::pair(1.0, 45.0), {2.0, -9.0}, {3.0, 1.0}})
    sum += weight / (60.0 * h) * (f(at + steps * h) - f(at - steps * h));
  return sum;
}

/// To 1e-7 of N over the number, and to the stated error (differences leave some 1e-9 of N).
void close(const GainDerivative& found, Complex expected, double number, Complex gain) {
  const double size = std::abs(gain) / number, off = std::abs(found.gain - expected);
  CAPTURE(found.gain, expected, off / size, found.error / size);
  CHECK(off < 1e-7 * size);
  CHECK(off <= found.error + 2e-9 * size);
  CHECK(found.error < 1e-6 * size);
}

template <class Law>
void against_differences(const Law& law, const DfPoint& at, const Members<Law>& members) {
  const auto found = df_derivatives(law, at.amplitude, at.frequency, at.bias, beside(law, members));
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  const Complex N = gain_of(law, at);
  CHECK(std::abs(found.gain - N) < 1e-9 * std::abs(N));
  CHECK(std::abs(found.gain - N) <= found.gain_error + 1e-9 * std::abs(N));
  const auto moved = [&](double DfPoint::*member) {
    return difference(at.*member, [&](double to) {
      DfPoint there = at;
      there.*member = to;
      return gain_of(law, there);
    });
  };
  close(found.amplitude, moved(&DfPoint::amplitude), at.amplitude, N);
  close(found.frequency, moved(&DfPoint::frequency), at.frequency, N);
  if (at.bias != 0.0) close(found.bias, moved(&DfPoint::bias), at.bias, N);
  for (std::size_t k = 0; k < members.size(); ++k) {
    CAPTURE(members[k].first);
    const auto member = members[k].second;
    const Complex expected = difference(law.*member, [&](double to) {
      Law there = law;
      there.*member = to;
      return gain_of(there, at);
    });
    close(found.by[k], expected, law.*member, N);
  }
}

}  // namespace

TEST_CASE("derivatives of a describing function: closed forms of relay, saturation and Coulomb friction") {
  // Relay with hysteresis: N = 4M/(pi A) e^{-j asin(h/A)}.
  const double M = 2.0, h = 0.1, A = 0.7;
  const auto law = relay(M, h);
  const auto of_relay = df_derivatives(
      law, A, 3.0, 0.0, beside(law, {{"level", &Relay<double>::level}, {"hysteresis", &Relay<double>::hysteresis}}));
  REQUIRE(of_relay.status == Status::converged);
  const double c = std::sqrt(A * A - h * h);
  const Complex N = 4.0 * M / (pi * A) * Complex(c / A, -h / A);
  CHECK(std::abs(of_relay.gain - N) < 1e-12);
  close(of_relay.by[0], N / M, M, N);
  close(of_relay.by[1], 4.0 * M / (pi * A * A) * Complex(-h / c, -1.0), h, N);
  close(of_relay.amplitude, 4.0 * M / pi * Complex(-c / (A * A * A) * 2.0 + 1.0 / (A * c), 2.0 * h / (A * A * A)), A,
        N);
  close(of_relay.frequency, 0.0, 3.0, N);

  // Saturation: N = (2/pi) k (asin r + r sqrt(1 - r^2)), r = L/(k A): dN/dL = (4/(pi A)) sqrt(1 - r^2).
  const auto flat = saturation(0.5);
  const auto of_limit = df_derivatives(flat, 1.0, 3.0, 0.0, beside(flat, {{"limit", &Saturation<double>::limit}}));
  REQUIRE(of_limit.status == Status::converged);
  close(of_limit.by[0], 4.0 / pi * std::sqrt(0.75), 0.5, of_limit.gain);

  // Coulomb and viscous friction: N = j (4 Fc/(pi A) + sigma2 w).
  const auto dry = coulomb(1.0, 1.0, 0.4);
  const auto of_friction = df_derivatives(dry, 0.1, 2.0, 0.0, beside(dry, {{"sigma2", &Coulomb<double>::sigma2}}));
  REQUIRE(of_friction.status == Status::converged);
  close(of_friction.amplitude, Complex(0.0, -4.0 / (pi * 0.01)), 0.1, of_friction.gain);
  close(of_friction.frequency, Complex(0.0, 0.4), 2.0, of_friction.gain);
  close(of_friction.by[0], Complex(0.0, 2.0), 0.4, of_friction.gain);
}

TEST_CASE("derivatives of a describing function: backlash is homogeneous, stiff LuGre comes to Coulomb") {
  // N of backlash depends on half_gap/A and is proportional to the slope.
  Backlash<double> play;
  play.half_gap = 0.3;
  play.slope = 1.7;
  const auto found = df_derivatives(
      play, 1.1, 2.0, 0.0, beside(play, {{"gap", &Backlash<double>::half_gap}, {"slope", &Backlash<double>::slope}}));
  REQUIRE(found.status == Status::converged);
  CHECK(std::abs(found.by[0].gain) > 0.1);
  CHECK(std::abs(1.1 * found.amplitude.gain + 0.3 * found.by[0].gain) < 1e-8 * std::abs(found.gain));
  CHECK(std::abs(1.7 * found.by[1].gain - found.gain) < 1e-8 * std::abs(found.gain));

  // Bristles of increasing stiffness: dN/dsigma2 = j w, dN/dA = -j 4 Fc/(pi A^2) in the limit.
  const double A = 0.1, w = 2.0;
  double last = infinite;
  for (const double sigma0 : {1e4, 1e5, 1e6}) {
    auto law = lugre(1.0, 1.0, 0.4);
    law.sigma0 = sigma0;
    law.sigma1 = 0.0;
    const auto near = df_derivatives(law, A, w, 0.0, beside(law, {{"sigma2", &LuGre<double>::sigma2}}));
    REQUIRE(near.status == Status::converged);
    CHECK(std::abs(near.by[0].gain - Complex(0.0, w)) < 1e-6);
    const double off = std::abs(near.amplitude.gain + Complex(0.0, 4.0 / (pi * A * A)));
    CHECK(off < 0.35 * last);  // proportional to 1/sqrt(sigma0)
    last = off;
  }
  CHECK(last < 1e-2 * 4.0 / (pi * A * A));
}

TEST_CASE("derivatives of a describing function against differences: laws with bristles and sliders") {
  using L = LuGre<double>;
  const Members<L> of_lugre{{"vs", &L::vs}, {"sigma0", &L::sigma0}, {"sigma1", &L::sigma1}, {"sigma2", &L::sigma2}};
  for (const double A : {1e-5, 1e-4, 1e-2})
    for (const double w : {1.0, 30.0}) against_differences(lugre(), {A, w, 0.0}, of_lugre);
  against_differences(lugre(), {1e-2, 1.0, 3e-3}, of_lugre);  // it drifts, and turns back

  Dahl<double> dahl;
  dahl.Fc = 1.0;
  dahl.sigma0 = 1e3;
  dahl.exponent = 1.5;
  using D = Dahl<double>;
  against_differences(dahl, {2e-3, 2.0, 0.0}, {{"Fc", &D::Fc}, {"sigma0", &D::sigma0}, {"exponent", &D::exponent}});

  using E = ElastoPlastic<double>;
  auto plastic = with_levels<E>(1.5, 1.0);
  plastic.vs = 1e-3;
  plastic.sigma0 = 1e4;
  plastic.sigma1 = 100.0;
  plastic.sigma2 = 0.4;
  against_differences(plastic, {1e-3, 2.0, 0.0}, {{"sigma0", &E::sigma0}, {"vs", &E::vs}, {"zba", &E::zba_ratio}});

  using M = Gms<double>;
  auto sliders = with_levels<M>(1.5, 1.0);
  sliders.vs = 1e-2;
  sliders.k = {1000.0, 400.0, 200.0};
  sliders.alpha = {0.3, 0.4, 0.3};
  sliders.C = 50.0;
  sliders.sigma2 = 0.3;
  against_differences(sliders, {5e-3, 2.0, 0.0}, {{"C", &M::C}, {"vs", &M::vs}, {"sigma2", &M::sigma2}});
  against_differences(sliders, {5e-4, 2.0, 0.0}, {{"C", &M::C}});

  Jenkins<double> spring;
  spring.k = 100.0;
  spring.Fc = 1.0;
  using J = Jenkins<double>;
  against_differences(spring, {5e-2, 2.0, 0.0}, {{"k", &J::k}, {"Fc", &J::Fc}});
  against_differences(spring, {5e-3, 2.0, 0.0}, {{"k", &J::k}});  // elastic: the symmetric one of many states
}

TEST_CASE("derivatives of a describing function: the error falls with the tolerance and is stated") {
  using L = LuGre<double>;
  const auto law = lugre();
  const auto pairs = beside(law, {{"sigma0", &L::sigma0}, {"vs", &L::vs}});
  const auto at = [&](double rtol) {
    DfDerivativeOptions options;
    options.rtol = rtol;
    const auto found = df_derivatives(law, 1e-4, 1.0, 0.0, pairs, options);
    REQUIRE(found.status == Status::converged);
    return found;
  };
  const auto best = at(1e-12);
  double last = infinite;
  for (const double rtol : {1e-5, 1e-7, 1e-9}) {
    const auto rough = at(rtol);
    const double error = std::abs(rough.by[0].gain - best.by[0].gain);
    CAPTURE(rtol, error, rough.by[0].error);
    CHECK(error <= rough.by[0].error);
    CHECK(error < 0.15 * last);
    last = error;
    CHECK(std::abs(rough.by[1].gain - best.by[1].gain) <= rough.by[1].error);
    CHECK(std::abs(rough.frequency.gain - best.frequency.gain) <= rough.frequency.error);
  }
  CHECK(last < 1e-7 * std::abs(best.by[0].gain));
}

TEST_CASE("derivatives of a describing function: by one direction's level alone the half periods differ") {
  // N = j (2 (Fc + Fc_minus))/(pi A): half of it by either level.
  const auto dry = coulomb(1.0, 1.0);
  Coulomb<double> low = dry, high = dry;
  low.Fc_minus = 1.0 - 1e-6;
  high.Fc_minus = 1.0 + 1e-6;
  low.Fs_minus = high.Fs_minus = 2.0;
  const std::vector<ElementNeighbours> pairs{{low, high, 1e-6, 1.0}};
  const auto found = df_derivatives(dry, 0.1, 2.0, 0.0, pairs);
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  close(found.by[0], Complex(0.0, 2.0 / (pi * 0.1)), 1.0, found.gain);
}

TEST_CASE("derivatives of a describing function: what has none says so, and what is wrong is refused") {
  const auto refused = [](const Element& element, double A, double w, double bias) {
    const auto found = df_derivatives(element, A, w, bias, {});
    CHECK_FALSE(found.why.empty());
    CHECK(found.by.empty());
    CHECK(found.gain == 0.0);
    return found.status;
  };
  auto banded = with_levels<Karnopp<double>>(1.5, 1.0);
  banded.dv = 1e-3;
  CHECK(refused(banded, 1.0, 1.0, 0.0) == Status::undefined);
  CHECK(refused(NonDrift<double>{}, 1.0, 1.0, 0.0) == Status::undefined);
  Jenkins<double> spring;
  spring.k = 100.0;
  spring.Fc = 1.0;
  DfDerivativeOptions options;
  options.max_steps = 3;
  CHECK_FALSE(df_derivatives(lugre(), 1e-2, 1.0, 0.0, {}, options).why.empty());
  options = {};
  options.stop = [] { return true; };
  CHECK(df_derivatives(lugre(), 1e-2, 1.0, 0.0, {}, options).status == Status::interrupted);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(df_derivatives(lugre(), 0.0, 1.0, 0.0, {}), std::invalid_argument);
  CHECK_THROWS_AS(df_derivatives(lugre(), 1.0, -1.0, 0.0, {}), std::invalid_argument);
  CHECK_THROWS_AS(df_derivatives(lugre(), 1.0, 1.0, nan, {}), std::invalid_argument);
  const std::vector<ElementNeighbours> wrong{{lugre(), coulomb(1.5, 1.0), 1.0, 1.0}};
  CHECK_THROWS_AS(df_derivatives(lugre(), 1.0, 1.0, 0.0, wrong), std::invalid_argument);
  const std::vector<ElementNeighbours> nothing{{spring, spring, 0.0, 100.0}};
  CHECK_THROWS_AS(df_derivatives(spring, 1.0, 1.0, 0.0, nothing), std::invalid_argument);
}
