#include "limcycle/analysis/frequency/describing_function/gain_surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/tests/analysis/frequency/random_points.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

ElastoPlastic<double> elasto_plastic() {
  auto law = with_levels<ElastoPlastic<double>>(1.5, 1.0);
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = 10.0;
  law.sigma2 = 0.4;
  return law;
}

/// Largest relative error of the interpolated values at random points; REQUIREs that most have one.
double worst(const Element& law, double bias, double accuracy, int points) {
  GainSurface surface(law, bias, accuracy);
  Random random(4711);
  double largest = 0.0;
  int found = 0;
  for (int k = 0; k < points; ++k) {
    const double A = random.spread(1e-7, 0.1), w = random.spread(0.1, 1e3);
    const auto value = surface.at(A, w);
    if (!value) continue;
    ++found;
    largest = std::max(largest, apart(*value, describing_function(law, {A, w, bias}, asking(1e-8)).gain));
  }
  REQUIRE(found > 0.8 * points);
  return largest;
}

}  // namespace

TEST_CASE("gain surface: as accurate as was asked, on smooth laws and on laws with kinks") {
  const int points = samples(1500);
  for (const double accuracy : {1e-3, 1e-4, 1e-5}) {
    INFO("accuracy " << accuracy);
    CHECK(worst(lugre(), 0.0, accuracy, points) < accuracy);
    CHECK(worst(dahl(0.7), 0.0, accuracy, points) < accuracy);
    CHECK(worst(stribeck(1.5, 1.0, 1e-3), 0.0, accuracy, points) < accuracy);
    CHECK(worst(elasto_plastic(), 0.0, accuracy, points) < accuracy);
  }
  CHECK(worst(lugre(), 5e-4, 1e-4, samples(500)) < 1e-4);
  CHECK(worst(stribeck(1.5, 1.0, 1e-3), 5e-4, 1e-4, samples(500)) < 1e-4);
}

TEST_CASE("gain surface: a value does not depend on those asked for before") {
  const Element law = elasto_plastic();
  GainSurface forwards(law, 0.0, 1e-4), backwards(law, 0.0, 1e-4);
  std::vector<std::optional<std::complex<double>>> there, back(200);
  const auto at = [](GainSurface& surface, std::size_t k) {
    return surface.at(1e-6 * std::pow(1.06, k), 0.3 * std::pow(1.03, k));
  };
  for (std::size_t k = 0; k < back.size(); ++k) there.push_back(at(forwards, k));
  for (std::size_t k = back.size(); k-- > 0;) back[k] = at(backwards, k);
  CHECK(there == back);
}

TEST_CASE("gain surface: a law of one variable needs a row of values, not a plane") {
  // Along this line in the plane of ln A and ln w, does each new point need new values of the law?
  const auto more_along = [](const Element& law, double growth_of_A, double growth_of_w) {
    GainSurface surface(law, 0.0, 1e-4);
    surface.at(1e-3, 1.0);
    const long first = surface.evaluations();
    REQUIRE(first > 0);
    for (int k = 1; k < 10; ++k) surface.at(1e-3 * std::pow(growth_of_A, k), std::pow(growth_of_w, k));
    return surface.evaluations() > first;
  };
  CHECK_FALSE(more_along(dahl(0.7), 1.0, 3.0));  // rate-independent: a function of A
  CHECK(more_along(dahl(0.7), 3.0, 1.0));
  CHECK_FALSE(more_along(stribeck(1.5, 1.0, 1e-3), 3.0, 1.0 / 3.0));  // without states: a function of A w
  CHECK(more_along(stribeck(1.5, 1.0, 1e-3), 1.0, 3.0));
  CHECK(more_along(lugre(), 1.0, 3.0));
  CHECK(more_along(lugre(), 3.0, 1.0));
}

TEST_CASE("gain surface: none where the gain does not exist") {
  // Without a bias the output is not symmetric: a symmetric loop has no use for such a gain.
  auto uneven = lugre();
  uneven.Fs_minus = 2.0;
  GainSurface surface(uneven, 0.0, 1e-4);
  CHECK_FALSE(surface.at(1e-3, 2.0));
  CHECK(surface.evaluations() > 0);
}
