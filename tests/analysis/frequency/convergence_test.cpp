// Measured orders of the two routes to the harmonics, bounded from both sides: not less than stated, and not more by
// accident.
#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

/// The same number of equal panels in each half period, no layer graded.
PeriodMesh equal_panels(const PrescribedMotion& motion, int count) {
  PeriodMesh mesh;
  mesh.virgin.push_back({1, -motion.origin(), 0.0});
  for (int k = 0; k < count; ++k)
    mesh.first.push_back({1, motion.first_length() * k / count, motion.first_length() * (k + 1) / count});
  for (int k = 0; k < count; ++k)
    mesh.second.push_back({2, motion.second_length() * k / count, motion.second_length() * (k + 1) / count});
  return mesh;
}

template <template <class> class Kind>
std::complex<double> gain_on(const Kind<double>& element, const PrescribedMotion& motion, const PeriodMesh& mesh,
                             int stages) {
  ElementMarch<> march(element, motion, stages);
  HarmonicSums sums(1);
  PeriodicStateSearch<> search(march, mesh, true, 1e-15);
  const PeriodicState periodic = search.find(sums, nullptr);
  REQUIRE(periodic.status == Status::converged);
  REQUIRE(periodic.symmetric);
  return sums.harmonic(1, true) / motion.amplitude();
}

std::complex<double> dahl_closed_form(double A, double l, double Fc) {
  const double a = A / l;
  return {2.0 * Fc * std::cyl_bessel_i(1.0, a) / (A * std::cosh(a)), 4.0 * Fc / (pi * A) * (1.0 - std::tanh(a) / a)};
}

template <class Error>
double measured_order(Error error, int coarse, int doublings) {
  return std::log2(error(coarse) / error(coarse << doublings)) / doublings;
}

}  // namespace

TEST_CASE("collocation quadrature converges with order 2 s - 1", "[df][order]") {
  const double A = 1e-4;
  const auto law = dahl();
  const PrescribedMotion motion(A, 1.0, 0.0, true);
  const auto exact = dahl_closed_form(A, 1e-5, 1.0);
  const struct {
    int stages, coarse, doublings;  // between pre-asymptotic and rounding
  } ranges[] = {{2, 64, 2}, {3, 32, 2}, {4, 32, 1}, {5, 16, 1}};
  for (const auto& range : ranges) {
    const auto error = [&](int panels) {
      return apart(gain_on(law, motion, equal_panels(motion, panels), range.stages), exact);
    };
    const double order = measured_order(error, range.coarse, range.doublings);
    CAPTURE(range.stages, order, error(range.coarse));
    CHECK(order > 2 * range.stages - 1 - 0.3);
    CHECK(order < 2 * range.stages - 1 + 0.5);
  }
}

TEST_CASE("FFT route converges algebraically across kinks and jumps", "[df][order][fft]") {
  const DfOptions options = with(DfMethod::fft, 1e-12);
  SECTION("a kink at each reversal: LuGre, order 2") {
    const auto law = lugre();
    const PrescribedMotion motion(1e-3, 1.0, 0.0, true);
    FftRoute route(law, motion, true, 0.0, options);
    const auto exact = describing_function(law, {1e-3, 1.0, 0.0}, with(DfMethod::quadrature, 1e-12)).gain;
    const auto error = [&](int samples) { return apart(route.on_samples(samples).gain, exact); };
    const double order = measured_order(error, 256, 4);
    CAPTURE(order);
    CHECK(order > 1.9);
    CHECK(order < 2.1);
  }
  SECTION("dz/dt is continuous at each reversal: Dahl, order 4") {
    const double A = 3e-5;
    const auto law = dahl();
    const PrescribedMotion motion(A, 1.0, 0.0, true);
    FftRoute route(law, motion, true, 0.0, options);
    const auto error = [&](int samples) {
      return apart(route.on_samples(samples).gain, dahl_closed_form(A, 1e-5, 1.0));
    };
    const double order = measured_order(error, 256, 4);
    CAPTURE(order);
    CHECK(order > 3.8);
    CHECK(order < 4.2);
  }
  SECTION("a jump at a sample: Coulomb") {
    const auto law = coulomb(1.0, 1.0);
    const PrescribedMotion motion(1.0, 1.0, 0.0, true);
    FftRoute route(law, motion, true, 0.0, options);
    const auto error = [&](int samples) { return apart(route.on_samples(samples).gain, {0.0, 4.0 / pi}); };
    const double order = measured_order(error, 256, 4);
    CAPTURE(order);
    CHECK(order > 1.9);
    CHECK(order < 2.1);
  }
  SECTION("jumps between samples: Coulomb with a mean velocity") {
    const auto law = coulomb(1.0, 1.0);
    const double bias = 0.3137;
    const PrescribedMotion motion(1.0, 1.0, bias, true);
    FftRoute route(law, motion, false, bias, options);
    const std::complex<double> exact(0.0, 4.0 / pi * std::sqrt(1.0 - bias * bias));
    // The position of the jump between the samples changes from one count to the next, and so does the error.
    const auto error = [&](int samples) {
      double worst = 0.0;
      for (int more = 0; more < 32; more += 4)
        worst = std::max(worst, apart(route.on_samples(samples + more).gain, exact));
      return worst;
    };
    const double order = measured_order(error, 128, 7);
    CAPTURE(order, error(128));
    CHECK(order > 1.8);
    CHECK(order < 2.2);
  }
}

TEST_CASE("Radau IIA tables satisfy what defines them", "[df][radau]") {
  for (int s = 2; s <= RadauIIA::most_stages; ++s) {
    const RadauIIA& table = radau_iia(s);
    CAPTURE(s);
    CHECK(table.c[static_cast<std::size_t>(s - 1)] == 1.0);
    // b integrates powers up to 2 s - 2 and no further; row i of a integrates powers up to s - 1 over [0, c_i].
    for (int power = 0; power <= 2 * s - 1; ++power) {
      double sum = 0.0;
      for (std::size_t j = 0; j < static_cast<std::size_t>(s); ++j) sum += table.b[j] * std::pow(table.c[j], power);
      const double defect = std::abs(sum - 1.0 / (power + 1));
      if (power <= 2 * s - 2)
        CHECK(defect < 1e-15);
      else if (s <= 8)
        CHECK(defect > 1e-12);
    }
    for (int i = 0; i < s; ++i) {
      for (int power = 0; power < s; ++power) {
        double sum = 0.0;
        for (int j = 0; j < s; ++j)
          sum += table.coefficient(i, j) * std::pow(table.c[static_cast<std::size_t>(j)], power);
        CHECK(sum == Approx(std::pow(table.c[static_cast<std::size_t>(i)], power + 1) / (power + 1)).margin(1e-15));
      }
    }
    // The interpolation reproduces a polynomial of degree s.
    std::array<double, RadauIIA::most_stages + 1> weights;
    table.interpolation(0.37, weights);
    double value = 0.0;
    for (std::size_t j = 1; j <= static_cast<std::size_t>(s); ++j) value += weights[j] * std::pow(table.c[j - 1], s);
    CHECK(value == Approx(std::pow(0.37, s)).epsilon(1e-9));
  }
  CHECK_THROWS_AS(radau_iia(1), std::invalid_argument);
  CHECK_THROWS_AS(radau_iia(13), std::invalid_argument);
  // Two stages, Hairer and Wanner (1996), table IV.5.5.
  const RadauIIA& two = radau_iia(2);
  CHECK(two.c[0] == Approx(1.0 / 3.0));
  CHECK(two.coefficient(0, 0) == Approx(5.0 / 12.0));
  CHECK(two.coefficient(0, 1) == Approx(-1.0 / 12.0));
  CHECK(two.b[0] == Approx(0.75));
}

TEST_CASE("the motion keeps its relative accuracy at a reversal", "[df][motion]") {
  for (const double bias : {0.0, 3.0, -9.99}) {
    const PrescribedMotion motion(2.0, 5.0, bias, true);
    REQUIRE(motion.reverses());
    CHECK(motion.first_length() + motion.second_length() == Approx(2.0 * pi).epsilon(1e-15));
    for (const double phase : {1e-12, 1e-6, 1e-2}) {
      // v = A w (cos(t0 + p) - cos t0) by its Taylor series at the reversal.
      const double cosine = -bias / 10.0, sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
      const double series = 10.0 * (-sine * phase - cosine * phase * phase / 2.0 + sine * std::pow(phase, 3) / 6.0 +
                                    cosine * std::pow(phase, 4) / 24.0);
      CHECK(motion.at(1, phase).in.v == Approx(series).epsilon(1e-13 + std::pow(phase, 4)));
    }
    const MotionNode node = motion.at(2, 0.7);
    const double theta = motion.origin() + motion.position(2, 0.7);
    CHECK(node.sine == Approx(std::sin(theta)));
    CHECK(node.cosine == Approx(std::cos(theta)));
    CHECK(node.in.v == Approx(bias + 10.0 * std::cos(theta)));
    CHECK(node.in.x == Approx(bias * theta / 5.0 + 2.0 * std::sin(theta)));
  }
}
