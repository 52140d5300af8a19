// Describing functions of LuGre with a B-spline level against a plain integration of its equations.
#include "limcycle/models/friction/bristle/lugre_spline.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"
#include "limcycle/tests/analysis/frequency/one_state_reference.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

LuGreSpline<double> spline() {
  LuGreSpline<double> law;
  law.velocity = {0.0, 5e-4, 1e-3, 2e-3, 4e-3};
  law.coefficients = {1.5, 1.45, 1.2, 1.0, 1.1, 1.05, 1.2};
  law.sigma0 = 1e5;
  law.sigma1 = 316.0;
  return law;
}

OneStateReference plain(const LuGreSpline<double>& law, double A, double w, double bias, int steps) {
  // Cox and de Boor's definition of each basis function, apart from de Boor's recursion for the curve.
  std::vector<double> knots(3, 0.0);
  knots.insert(knots.end(), law.velocity.begin(), law.velocity.end());
  knots.insert(knots.end(), 3, law.velocity.back());
  const auto g = [&](double v) {
    const double x = std::abs(v);
    if (x >= law.velocity.back()) return law.coefficients.back();
    double basis[10] = {};
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) basis[i] = x >= knots[i] && x < knots[i + 1] ? 1.0 : 0.0;
    for (std::size_t p = 1; p <= 3; ++p)
      for (std::size_t i = 0; i + p + 1 < knots.size(); ++i) {
        const double left = knots[i + p] - knots[i], right = knots[i + p + 1] - knots[i + 1];
        basis[i] = (left > 0.0 ? (x - knots[i]) / left * basis[i] : 0.0) +
                   (right > 0.0 ? (knots[i + p + 1] - x) / right * basis[i + 1] : 0.0);
      }
    double sum = 0.0;
    for (std::size_t k = 0; k < law.coefficients.size(); ++k) sum += law.coefficients[k] * basis[k];
    return sum;
  };
  const auto rate = [&](double v, double z) { return v - law.sigma0 * std::abs(v) * z / g(v); };
  const auto force = [&](double, double v, double z) {
    return law.sigma0 * z + law.sigma1 * rate(v, z) + law.sigma2 * v;
  };
  return one_state_reference(A, w, bias, rate, force, bias == 0.0, steps, -0.5 / law.sigma0);
}

}  // namespace

TEST_CASE("spline LuGre describing functions are those of a plain integration", "[df][lugre-spline]") {
  const struct {
    double A, w, bias;
  } cases[] = {{5e-6, 1.0, 0.0},  {1.5e-5, 10.0, 0.0}, {1e-4, 10.0, 0.0},  {1e-3, 1.0, 0.0},
               {1e-3, 10.0, 0.0}, {1e-4, 10.0, 4e-4},  {1e-4, 10.0, 2e-3}, {3e-3, 1.0, 2e-3}};
  const auto law = spline();
  for (const auto& c : cases) {
    CAPTURE(c.A, c.w, c.bias);
    const auto coarse = plain(law, c.A, c.w, c.bias, 3000), fine = plain(law, c.A, c.w, c.bias, 6000);
    const double doubt = apart(coarse.gain, fine.gain);
    CHECK(doubt < 2e-7);
    for (const double accuracy : {1e-6, 1e-9}) {
      const auto df = quadrature(law, c.A, c.w, c.bias, accuracy);
      CHECK(df.status == Status::converged);
      CHECK(df.error <= accuracy);
      CHECK(apart(df.gain, fine.gain) <= df.error + 2.0 * doubt + 1e-12);
      CHECK(df.mean == Approx(fine.mean).epsilon(accuracy + 1e-7).margin(1e-8));
      CHECK(df.dissipation == Approx(fine.work).epsilon(accuracy + 1e-7));
    }
  }
}

TEST_CASE("spline LuGre: both routes agree", "[df][lugre-spline]") {
  for (const double A : {1.5e-5, 1e-4}) {
    CAPTURE(A);
    const PrescribedMotion motion(A, 10.0, 4e-5, true);
    const auto smooth = quadrature(spline(), A, 10.0, 4e-5, 1e-8);
    const auto fft = FftRoute(spline(), motion, false, 4e-5, with(DfMethod::fft, 1e-5)).refine(smooth);
    CHECK(fft.status == Status::converged);
    CHECK(fft.error <= 1e-5);
    CHECK(apart(fft.gain, smooth.gain) <= fft.error + smooth.error);
  }
}
