#include "limcycle/reports/figures/nyquist_window.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

using namespace limcycle;

namespace {

NyquistPicture picture_of(const std::function<std::complex<double>(std::complex<double>)>& G) {
  NyquistPicture picture;
  for (int i = 0; i <= 200; ++i) {
    const double w = 1e-3 * std::pow(10.0, 6.0 * i / 200.0);
    picture.frequency.push_back(w);
    picture.G.push_back(G({0.0, w}));
  }
  picture.family_frequency = {1.0};
  picture.minus_inverse_N.emplace_back();
  for (int i = 0; i <= 100; ++i) {
    picture.family_amplitude.push_back(1e-3 * std::pow(10.0, 6.0 * i / 100.0));
    picture.minus_inverse_N[0].push_back(-std::numbers::pi * picture.family_amplitude.back() / 4.0);
  }
  return picture;
}

std::complex<double> integrating(std::complex<double> s) { return 1.0 / (s * (s + 1.0) * (s + 1.0)); }

bool contains(const NyquistWindow& box, std::complex<double> z) {
  return box.re_from < z.real() && z.real() < box.re_to && box.im_from < z.imag() && z.imag() < box.im_to;
}

}  // namespace

TEST_CASE("the window holds origin and root, and not the far end of an integrator") {
  const auto picture = picture_of(integrating);
  for (const auto& roots : {std::vector<std::complex<double>>{{-0.5, 0.0}}, std::vector<std::complex<double>>{}}) {
    const auto box = nyquist_window(picture, roots);
    CHECK(contains(box, 0.0));
    CHECK(contains(box, -0.5));
    CHECK(box.re_to - box.re_from < 5.0);  // |G| reaches 1000
    CHECK(box.im_to - box.im_from < 5.0);
    CHECK(box.im_to - box.im_from > 0.1);
  }
}

TEST_CASE("a bounded curve is shown whole") {
  const auto picture = picture_of([](std::complex<double> s) { return s / (s * s * s + 6.0 * s * s + 3.0 * s + 4.0); });
  const auto box = nyquist_window(picture, {});
  for (const auto& G : picture.G) REQUIRE(contains(box, G));
  CHECK(box.re_to - box.re_from < 2.0);  // the family reaches -785
}

TEST_CASE("a window is finite whatever the curve") {
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  for (const auto& G : {std::vector<std::complex<double>>{}, {{nan_value, 0.0}}, {{0.0, 0.0}, {0.0, 0.0}}}) {
    NyquistPicture picture;
    picture.G = G;
    const auto box = nyquist_window(picture, {});
    CHECK(box.re_from < box.re_to);
    CHECK(box.im_from < box.im_to);
    CHECK(std::isfinite(box.re_to - box.re_from + box.im_to - box.im_from));
  }
}

TEST_CASE("G between the samples") {
  const auto picture = picture_of(integrating);
  const auto G = response_at(picture, 1.0123);
  REQUIRE(G);
  CHECK(std::abs(*G - integrating({0.0, 1.0123})) < 1e-2);
  CHECK_FALSE(response_at(picture, 1e-4));
  CHECK_FALSE(response_at(picture, 1e4));
}
