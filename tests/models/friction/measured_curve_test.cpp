#include "limcycle/models/friction/measured_curve.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/lugre_table.hpp"
#include "limcycle/models/friction/dry/stribeck_table.hpp"

using namespace limcycle;

namespace {

MeasuredCurve<double> through(double Fs, std::vector<double> velocities, std::vector<double> forces) {
  MeasuredCurve<double> curve;
  curve.velocities = curve.velocities_minus = std::move(velocities);
  curve.forces = curve.forces_minus = std::move(forces);
  curve.Fs = curve.Fs_minus = Fs;
  REQUIRE_FALSE(curve.validate_curve());
  return curve;
}

/// The largest error on (0, 1) of a curve through n points of a function.
double error_of(int n, const std::function<double(double)>& function) {
  std::vector<double> v, f;
  for (int i = 1; i <= n; ++i) {
    v.push_back(static_cast<double>(i) / n);
    f.push_back(function(v.back()));
  }
  const auto curve = through(function(0.0), v, f);
  double worst = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double x = 0.1 + 0.8 * i / 1000.0;  // the slopes at the ends are of lower order
    worst = std::max(worst, std::abs(curve.level(x) - function(x)));
  }
  return worst;
}

}  // namespace

TEST_CASE("measured curve: it passes its points, and is what the published formulas give between them") {
  // pchip of SciPy 1.10.1 through (0, 35), (0.001, 31), (0.003, 27.5), (0.01, 21), (0.05, 22).
  const auto curve = through(35.0, {0.001, 0.003, 0.01, 0.05}, {31.0, 27.5, 21.0, 22.0});
  CHECK(curve.level(0.0) == 35.0);
  CHECK(curve.level(0.003) == 27.5);
  CHECK(curve.level(0.0005) == Approx(32.72443181818181).epsilon(1e-13));
  CHECK(curve.level(0.002) == Approx(28.935233222275105).epsilon(1e-13));
  CHECK(curve.level(0.006) == Approx(23.681556332330988).epsilon(1e-13));
  CHECK(curve.level(0.03) == Approx(21.125).epsilon(1e-13));
  CHECK(curve.level(-0.006) == curve.level(0.006));
}

TEST_CASE("measured curve: it rises and falls only where its points do, and its slope is continuous") {
  const auto curve = through(3.0, {1.0, 1.1, 2.0, 5.0, 6.0}, {1.0, 1.0, 0.5, 4.0, 4.1});
  const std::vector<double> v{0.0, 1.0, 1.1, 2.0, 5.0, 6.0};
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double from = curve.level(v[i - 1]), to = curve.level(v[i]);
    double before = from;
    for (int k = 1; k <= 200; ++k) {
      const double here = curve.level(v[i - 1] + (v[i] - v[i - 1]) * k / 200.0);
      CHECK((here - before) * (to - from) >= -1e-12);
      before = here;
    }
    if (i + 1 == v.size()) break;  // level beyond the last point
    const double h = 1e-6, left = (curve.level(v[i]) - curve.level(v[i] - h)) / h,
                 right = (curve.level(v[i] + h) - curve.level(v[i])) / h;
    CHECK(left == Approx(right).margin(2e-4));
  }
  CHECK(curve.level(7.0) == 4.1);
  CHECK(curve.highest_level() == 4.1);
  CHECK(curve.lowest_level() == 0.5);
  CHECK(curve.velocity_scale() == Approx(0.1));
}

TEST_CASE("measured curve: of a smooth monotone function its error falls with the third power of the distance") {
  const auto falls = [](double x) { return 1.0 + std::exp(-2.0 * x); };
  const double order = std::log2(error_of(20, falls) / error_of(40, falls));
  CHECK(order > 2.7);
  CHECK(error_of(40, falls) < 1e-5);
}

TEST_CASE("measured curve: derivatives with respect to its points are those of differences") {
  StribeckTable<double> law;
  law.velocities = law.velocities_minus = {0.001, 0.003, 0.01};
  law.forces = law.forces_minus = {31.0, 27.5, 21.0};
  law.Fs = law.Fs_minus = 35.0;
  for (std::size_t i = 0; i < 3; ++i) {
    auto dual = recast<StribeckTable, Dual<1>>(law);
    dual.forces[i] = Dual<1>::variable(law.forces[i], 0);
    const double exact = dual.level(Dual<1>(0.0045), true).d[0];
    auto up = law, down = law;
    up.forces[i] += 1e-5;
    down.forces[i] -= 1e-5;
    CHECK(exact == Approx((up.level(0.0045, true) - down.level(0.0045, true)) / 2e-5).margin(1e-8));
  }
}

TEST_CASE("measured curve: each direction has its own points") {
  MeasuredCurve<double> both = through(35.0, {0.001, 0.003, 0.01}, {31.0, 27.5, 21.0});
  const auto forward = through(35.0, both.velocities, both.forces);
  const auto backward = through(33.0, {0.002, 0.004}, {30.0, 20.0});
  both.velocities_minus = backward.velocities;
  both.forces_minus = backward.forces;
  both.Fs_minus = backward.Fs;
  REQUIRE_FALSE(both.validate_curve());
  CHECK_FALSE(both.symmetric());
  for (const double v : {0.0005, 0.0017, 0.0035, 0.2}) {
    CHECK(both.level(v) == forward.level(v));
    CHECK(both.level(-v) == backward.level(v));
  }
  CHECK(both.knots() == std::vector<double>{0.001, 0.002, 0.003, 0.004, 0.01});
  CHECK(both.velocity_scale() == 0.001);
  both.forces_minus.pop_back();
  CHECK(both.validate_curve()->key == "forces_minus");
}

TEST_CASE("lugre-table: with many points of a Stribeck curve it is lugre") {
  LuGre<double> formula;
  formula.Fs = formula.Fs_minus = 1.5;
  formula.Fc = formula.Fc_minus = 1.0;
  formula.vs = 1e-3;
  formula.sigma0 = 1e5;
  formula.sigma1 = 316.0;
  LuGreTable<double> table;
  table.Fs = table.Fs_minus = 1.5;
  table.sigma0 = formula.sigma0;
  table.sigma1 = formula.sigma1;
  for (int i = 1; i <= 200; ++i) {
    table.velocities.push_back(2e-5 * i);
    table.forces.push_back(formula.level(table.velocities.back()));
  }
  table.velocities_minus = table.velocities;
  table.forces_minus = table.forces;
  const double z[] = {4e-6};
  for (const double v : {3.3e-5, -7.1e-4, 2.2e-3}) {
    CHECK(table.output({0.0, v}, {}, z) == Approx(formula.output({0.0, v}, {}, z)).epsilon(1e-5));
    CHECK(table.level(v) == Approx(formula.level(v)).epsilon(1e-4));
  }
}
