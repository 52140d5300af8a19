#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"
#include "limcycle/models/friction/dry/stribeck_table.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using limcycle::test::quadrature;
using std::numbers::pi;

namespace {

StribeckTable<double> measured_law() {
  StribeckTable<double> law;
  law.velocities = {5e-4, 1e-3, 2e-3, 5e-3, 0.02};
  law.forces = {1.35, 1.2, 1.05, 1.0, 1.04};
  law.velocities_minus = {6e-4, 1e-3, 4e-3, 0.01};
  law.forces_minus = {1.2, 1.1, 0.95, 0.9};
  law.Fs = 1.5;
  law.Fs_minus = 1.3;
  return law;
}

/// (2/T) times the integral of F cos over a period, by Simpson's rule between the points of the curve.
double in_phase_with_rate(const StribeckTable<double>& law, double peak, double drift) {
  std::vector<double> ends{0.0, pi, 2.0 * pi};
  const PrescribedMotion motion(1.0, peak, drift, true);
  for (const double v : law.knots())
    for (const double rate : {v, -v, 0.0})
      for (const double at : motion.positions_of_rate(rate)) ends.push_back(std::fmod(at + motion.origin(), 2.0 * pi));
  std::ranges::sort(ends);
  const auto force = [&](double phase, double inwards) {
    const double v = drift + peak * std::cos(phase);
    const double sign = drift + peak * std::cos(phase + inwards) < 0.0 ? -1.0 : 1.0;
    return sign * law.level(std::abs(v), sign > 0.0) * std::cos(phase);
  };
  double sum = 0.0;
  constexpr int pieces = 400;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double h = (ends[i] - ends[i - 1]) / pieces;
    for (int k = 0; k < pieces; ++k) {
      const double from = ends[i - 1] + k * h;
      sum += h / 6.0 * (force(from, 0.1 * h) + 4.0 * force(from + 0.5 * h, 0.0) + force(from + h, -0.1 * h));
    }
  }
  return sum / pi;
}

}  // namespace

TEST_CASE("measured curve: describing functions are accurate across its points, where it is not smooth") {
  const StribeckTable<double> law = measured_law();
  constexpr double accuracy = 1e-9;
  for (const double drift : {0.0, 1.8e-3, -3e-3})
    for (const double peak : {1.2e-3, 4.5e-3, 0.05}) {
      INFO("drift " << drift << ", peak " << peak);
      const double A = 1e-4;
      const DescribingFunction df = quadrature(law, A, peak / A, drift, accuracy);
      CHECK(df.status == Status::converged);
      CHECK(df.error <= accuracy);
      const double exact = in_phase_with_rate(law, peak, drift);
      CHECK(df.gain.imag() * A == Approx(exact).epsilon(1e-7).margin(1e-9));
    }
}

TEST_CASE("measured curve: panels end where the motion has a speed of a point, and cover the period as before") {
  const PrescribedMotion motion(1e-4, 30.0, 1.8e-3, true);
  const Scales scales{.velocity = 4e-4};
  PeriodMesh mesh = graded_mesh(motion, scales, {});
  const auto length = [&](const PeriodMesh& of) {
    double sum = 0.0;
    for (const auto* panels : {&of.first, &of.second})
      for (const Panel& one : *panels) sum += one.to - one.from;
    return sum;
  };
  const double before = length(mesh);
  const std::vector<double> speeds{5e-4, 1e-3, 2e-3};
  split_at_speeds(mesh, motion, speeds);
  CHECK(length(mesh) == Approx(before).epsilon(1e-14));
  int met = 0;
  for (const auto* panels : {&mesh.virgin, &mesh.first, &mesh.second})
    for (const Panel& one : *panels) {
      const double begin = motion.at(one.anchor, one.from).in.v, end = motion.at(one.anchor, one.to).in.v;
      for (const double v : speeds)
        for (const double rate : {v, -v}) {
          if (std::abs(end - rate) < 1e-12) ++met;
          CHECK_FALSE((std::min(begin, end) < rate - 1e-8 && std::max(begin, end) > rate + 1e-8));
        }
    }
  CHECK(met >= 8);  // v from -1.2 to 4.8 mm/s: two times each of four rates
}
