/// The period of generalised Maxwell-slip elements, one by one, against the march that knows nothing of that.
#include "limcycle/analysis/frequency/kernels/gms_period.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/tests/analysis/frequency/random_points.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Elements of random shares and stiffness, damped or not.
template <class Law>
void give_elements(Law& law, Random& random) {
  const int count = static_cast<int>(random.uniform(1.0, 8.0));
  double sum = 0.0;
  const bool damped = random.coin();
  for (int i = 0; i < count; ++i) {
    law.k.push_back(law.Fs * random.spread(10.0, 1e6));
    law.alpha.push_back(random.uniform(0.1, 1.0));
    if (damped) law.sigma1.push_back(random.spread(0.1, 100.0));
    sum += law.alpha.back();
  }
  for (double& share : law.alpha) share /= sum;
  law.C = law.Fs * random.spread(1.0, 1e5);
  law.sigma2 = random.coin() ? 0.0 : random.spread(0.1, 10.0);
}

Element some_gms(Random& random) {
  const double Fc = random.spread(0.1, 10.0), Fs = Fc * random.uniform(1.0, 3.0);
  if (random.coin()) {
    Gms<double> law;
    law.Fs = law.Fs_minus = Fs;
    law.Fc = law.Fc_minus = Fc;
    law.vs = random.spread(1e-4, 0.1);
    law.delta = random.coin() ? 2.0 : 1.0;
    give_elements(law, random);
    return law;
  }
  GmsTable<double> law;
  law.Fs = law.Fs_minus = Fs;
  double v = 0.0;
  for (int i = 0; i < 5; ++i) {
    law.velocities.push_back(v += random.spread(1e-4, 0.1));
    law.forces.push_back(random.uniform(Fc, Fs));
  }
  law.velocities_minus = law.velocities;
  law.forces_minus = law.forces;
  give_elements(law, random);
  return law;
}

Gms<double> two_elements(double first, double second) {
  Gms<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 0.01;
  law.C = 33.0;
  law.k = {first, second};
  law.alpha = {0.3, 0.7};
  return law;
}

DescribingFunction gms_df(const Element& law, const DfPoint& point, DfMethod method, double accuracy) {
  const PrescribedMotion motion(point.amplitude, point.frequency, 0.0, true);
  return QuadratureRoute(law, motion, true, with(method, accuracy)).refine();
}

DfPoint some_point(Random& random) { return {random.spread(1e-7, 1.0), random.spread(0.01, 1e3), 0.0}; }

}  // namespace

TEST_CASE("period of gms elements: the harmonics of the march, much sooner") {
  Random random(161803);
  double evaluations = 0.0, of_march = 0.0;
  int left_out = 0;
  for (int k = 0; k < samples(80); ++k) {
    const Element law = some_gms(random);
    const DfPoint point = some_point(random);
    INFO(k << ": " << law.kind() << ", A " << point.amplitude << ", w " << point.frequency);
    const auto own = gms_df(law, point, DfMethod::automatic, 1e-7);
    const auto march = gms_df(law, point, DfMethod::quadrature, 1e-10);
    if (!march.answered() || !march.symmetric) {
      ++left_out;
      continue;
    }
    REQUIRE(own.answered());
    CHECK(own.symmetric);
    for (std::size_t order = 0; order < march.harmonics.size(); ++order)
      CHECK(std::abs(own.harmonics[order] - march.harmonics[order]) <=
            (own.error + march.error + 1e-8) * std::abs(march.harmonics[0]));
    CHECK(own.dissipation == Approx(march.dissipation)
                                 .epsilon(1e-6)
                                 .margin(1e-9 * std::abs(march.gain) * point.amplitude * point.amplitude));
    evaluations += static_cast<double>(own.evaluations);
    of_march += static_cast<double>(march.evaluations);
  }
  CHECK(left_out < 10);
  CHECK(evaluations < 0.5 * of_march);
}

TEST_CASE("period of gms elements: the error that it states is true") {
  Random random(577215);
  for (int k = 0; k < samples(60); ++k) {
    const Element law = some_gms(random);
    const DfPoint point = some_point(random);
    INFO(k << ": " << law.kind() << ", A " << point.amplitude << ", w " << point.frequency);
    const auto rough = gms_df(law, point, DfMethod::automatic, 1e-4);
    const auto best = gms_df(law, point, DfMethod::quadrature, 1e-10);
    if (!best.answered() || !best.symmetric) continue;
    REQUIRE(rough.answered());
    CHECK(rough.error <= 1e-4);
    CHECK(apart(rough.gain, best.gain) <= rough.error + best.error);
  }
}

TEST_CASE("period of gms elements: those that never slip are springs") {
  Random random(693147);
  for (int k = 0; k < samples(20); ++k) {
    const Gms<double> law = two_elements(random.spread(1e2, 1e4), random.spread(1e2, 1e4));
    const double free = std::min(0.3 / law.k[0], 0.7 / law.k[1]);  // N/(N/m), at the level Fc
    const PrescribedMotion motion(0.99 * free, random.spread(0.1, 100.0), 0.0, true);
    const PeriodMesh mesh = graded_mesh(motion, Element(law).scales(), {.stages = 5});
    HarmonicSums sums(1);
    sums.restart();
    const auto found = GmsPeriod::of(law)->find(motion, mesh, 5, sums);
    REQUIRE(found);
    CHECK(std::abs(sums.harmonic(1, true) - (law.k[0] + law.k[1]) * 0.99 * free) <= 1e-8 * law.k[1] * free);
    for (std::size_t i = 0; i < 2; ++i) CHECK(found->state.z[i] == Approx(law.k[i] * 0.99 * free));
    CHECK(found->defect <= 1e-12);
  }
}

TEST_CASE("period of gms elements: the march takes the state to its mirror image in half a period") {
  Random random(141421);
  for (int k = 0; k < samples(20); ++k) {
    const Element law = two_elements(random.spread(1e3, 1e5), random.spread(1e3, 1e5));
    const PrescribedMotion motion(random.spread(1e-4, 1e-1), random.spread(0.1, 100.0), 0.0, true);
    const PeriodMesh mesh = graded_mesh(motion, law.scales(), {.stages = 9, .growth = 0.3, .cap = 1e-6});
    HarmonicSums sums(1);
    sums.restart();
    const auto found = GmsPeriod::of(law)->find(motion, mesh, 9, sums);
    REQUIRE(found);
    ElementMarch<PrescribedMotion> march(law, motion, 9);
    ElementState state{found->state.mode, found->state.z, {1.0, 0.0, 0.0, 1.0}};
    NoVisitor nothing;
    REQUIRE(march.march(mesh.first, state, nothing) == Status::converged);
    for (std::size_t i = 0; i < 2; ++i) CHECK(std::abs(state.z[i] + found->state.z[i]) <= 1e-9);
  }
}

TEST_CASE("period of gms elements: a finer mesh is as much better as its order says") {
  // Five stages, from panels of 1.0 to 0.5: 2^9 = 512 for a smooth integrand.
  const Element law = two_elements(1e4, 3e4);
  double coarse = 0.0, fine = 0.0;
  for (const DfPoint& point : grid(7, 5)) {
    if (point.amplitude < 1e-4) continue;
    const PrescribedMotion motion(point.amplitude, point.frequency, 0.0, true);
    QuadratureRoute route(law, motion, true, with(DfMethod::automatic, 1e-6));
    const auto on = [&](double growth) { return route.on_mesh({5, growth, 1e-3}).gain; };
    const auto exact = route.on_mesh({10, 0.2, 1e-7}).gain;
    coarse = std::max(coarse, apart(on(1.0), exact));
    fine = std::max(fine, apart(on(0.5), exact));
  }
  CAPTURE(coarse, fine);
  CHECK(fine < coarse / 30.0);
}

TEST_CASE("period of gms elements: other laws, and levels that differ by direction, are left to the march") {
  Gms<double> law = two_elements(1e3, 1e3);
  CHECK(GmsPeriod::of(law).has_value());
  law.Fs_minus = 1.6;
  CHECK_FALSE(GmsPeriod::of(law).has_value());
  CHECK_FALSE(GmsPeriod::of(dahl()).has_value());
}
