#include "limcycle/models/friction/bristle/lugre_spline.hpp"

#include <gsl/gsl_bspline.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/dual.hpp"

using namespace limcycle;

namespace {

static_assert(LawOn<LuGreSpline<double>, double> && HasModes<LuGreSpline<double>, double>);
static_assert(LawOn<LuGreSpline<Dual<4>>, Dual<4>> && HasModes<LuGreSpline<Dual<4>>, Dual<4>>);

LuGreSpline<double> spline() {
  LuGreSpline<double> law;
  law.velocity = {0.0, 5e-4, 1e-3, 2e-3, 4e-3};
  law.coefficients = {1.5, 1.45, 1.2, 1.0, 1.1, 1.05, 1.2};
  law.sigma0 = 1e5;
  law.sigma1 = 316.0;
  law.sigma2 = 0.4;
  return law;
}

/// The same curve, or its first derivative, by the GNU Scientific Library.
double by_gsl(const std::vector<double>& knots, const std::vector<double>& coefficients, double x, std::size_t order) {
  auto* workspace = gsl_bspline_alloc(4, knots.size());
  auto* breaks = gsl_vector_alloc(knots.size());
  for (std::size_t i = 0; i < knots.size(); ++i) gsl_vector_set(breaks, i, knots[i]);
  gsl_bspline_knots(breaks, workspace);
  auto* basis = gsl_matrix_alloc(coefficients.size(), order + 1);
  gsl_bspline_deriv_eval(x, order, basis, workspace);
  double sum = 0.0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * gsl_matrix_get(basis, k, order);
  gsl_matrix_free(basis);
  gsl_vector_free(breaks);
  gsl_bspline_free(workspace);
  return sum;
}

}  // namespace

TEST_CASE("cubic B-splines are those of GSL, on any scalar", "[lugre-spline]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (const std::size_t count : {2u, 3u, 5u, 20u}) {
    std::vector<double> knots{0.0}, c;
    while (knots.size() < count) knots.push_back(knots.back() + 0.05 + u(random));
    while (c.size() < count + 2) c.push_back(0.1 + u(random));
    std::vector<double> points(knots);
    for (int i = 0; i < 100; ++i) points.push_back(knots.back() * u(random));
    for (const double x : points) {
      const double value = cubic_b_spline<double>(knots, c, x);
      CHECK(std::abs(value - by_gsl(knots, c, x, 0)) <= 1e-14);
      using D = Dual<1>;
      const std::vector<D> dual_knots(knots.begin(), knots.end()), dual_c(c.begin(), c.end());
      const D dual = cubic_b_spline<D>(dual_knots, dual_c, D::variable(x, 0));
      CHECK(dual.value == value);
      if (x > 0.0 && x < knots.back()) CHECK(dual.d[0] == Approx(by_gsl(knots, c, x, 1)).epsilon(1e-11).margin(1e-11));
      CHECK(value >= *std::min_element(c.begin(), c.end()));
      CHECK(value <= *std::max_element(c.begin(), c.end()));
    }
    CHECK(cubic_b_spline<double>(knots, c, -1.0) == c.front());
    CHECK(cubic_b_spline<double>(knots, c, knots.back() * 1.5) == c.back());
    const std::vector<double> ones(count + 2, 1.0);  // the basis sums to one
    for (const double x : points) CHECK(cubic_b_spline<double>(knots, ones, x) == Approx(1.0).epsilon(1e-15));
  }
}

TEST_CASE("the curve's derivative by a coefficient is that basis function", "[lugre-spline]") {
  const auto law = spline();
  using D = Dual<1>;
  const std::vector<D> knots(law.velocity.begin(), law.velocity.end());
  for (std::size_t k = 0; k < law.coefficients.size(); ++k) {
    std::vector<D> c(law.coefficients.begin(), law.coefficients.end());
    c[k].d[0] = 1.0;
    std::vector<double> unit(c.size(), 0.0);
    unit[k] = 1.0;
    for (const double x : {1e-4, 7e-4, 1.9e-3, 3e-3})
      CHECK(cubic_b_spline<D>(knots, c, D(x)).d[0] == Approx(by_gsl(law.velocity, unit, x, 0)).margin(1e-15));
  }
}

TEST_CASE("spline LuGre: even level, steady state, bound, odd", "[lugre-spline]") {
  CHECK(LuGreSpline<double>{}.states() == 1);
  const auto law = spline();
  CHECK(law.odd());
  CHECK(law.level(0.0) == 1.5);
  CHECK(law.level(1.0) == 1.2);
  for (const double v : {1e-5, 6e-4, 1e-3, 3e-3, 4e-3, 0.1, -0.02, -8e-4}) {
    CHECK(law.level(v) == law.level(-v));
    CHECK(law.level(v) > 0.0);
    const double side = v > 0.0 ? 1.0 : -1.0, z[] = {side * law.level(v) / law.sigma0}, far[] = {side * 1.5e-5};
    double dz[1], mirrored[1];
    law.rate({0.0, v, 0.0}, {}, z, dz);
    CHECK(std::abs(dz[0]) < 1e-15 * std::abs(v));
    CHECK(law.output({0.0, v, 0.0}, {}, z) == Approx(side * law.level(v) + law.sigma2 * v));
    law.rate({0.0, v, 0.0}, {}, far, dz);
    CHECK(side * dz[0] <= 0.0);
    const double back[] = {-far[0]};
    law.rate({0.0, -v, 0.0}, {}, back, mirrored);
    CHECK(mirrored[0] == -dz[0]);
    CHECK(law.output({0.0, -v, 0.0}, {}, back) == -law.output({0.0, v, 0.0}, {}, far));
  }
}

TEST_CASE("spline LuGre: passive with the stated sigma2", "[lugre-spline]") {
  auto law = spline();
  law.sigma2 = law.sigma1 * 0.5;  // (max g - min g)/min g <= (1.5 - 1)/1
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const double v = 6e-3 * u(random), z[] = {1.5e-5 * u(random)};
    double dz[1];
    law.rate({0.0, v, 0.0}, {}, z, dz);
    const double supplied = law.output({0.0, v, 0.0}, {}, z) * v;
    CHECK(supplied - law.sigma0 * z[0] * dz[0] >= -1e-14 * std::abs(supplied));
  }
}

TEST_CASE("spline LuGre: the mode is the span of the speed", "[lugre-spline]") {
  const auto law = spline();
  Mode mode = law.start({0.0, 0.0, 1.0}, {});
  CHECK(mode.value == 0);
  int switches = 0;
  const auto follow = [&](double v) {
    double g[2];
    law.guard({0.0, v, 0.0}, mode, {}, g);
    for (int k = 0; k < law.guards(mode); ++k) {
      if (g[k] >= 0.0) continue;
      mode = law.next({0.0, v, 0.0}, mode, {}, k);
      ++switches;
      law.guard({0.0, v, 0.0}, mode, {}, g);
      for (int j = 0; j < law.guards(mode); ++j) CHECK(g[j] >= 0.0);
      return;
    }
  };
  for (double v = 0.0; v < 5e-3; v += 3e-6) follow(v);
  CHECK(mode == law.start({0.0, 5e-3, 0.0}, {}));
  CHECK(mode.value == 4);
  for (double v = 5e-3; v > -5e-3; v -= 3e-6) follow(v);
  CHECK(mode.value == 4);
  CHECK(switches == 12);
}

TEST_CASE("spline LuGre: what is refused", "[lugre-spline]") {
  CHECK_FALSE(spline().validate());
  auto law = spline();
  law.velocity[0] = 1e-5;
  CHECK(law.validate()->key == "velocity");
  law = spline();
  law.velocity[2] = law.velocity[1];
  CHECK(law.validate()->key == "velocity");
  law = spline();
  law.velocity = {0.0};
  CHECK(law.validate()->key == "velocity");
  law = spline();
  law.coefficients.pop_back();
  CHECK(law.validate()->key == "coefficients");
  law = spline();
  law.coefficients[3] = 0.0;
  CHECK(law.validate()->key == "coefficients");
}
