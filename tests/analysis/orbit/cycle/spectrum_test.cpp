#include "limcycle/analysis/orbit/cycle/spectrum.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace limcycle;

TEST_CASE("spectrum: a square wave with its jumps as double samples is exact") {
  const std::vector<double> t{3.0, 4.0, 4.0, 5.0}, y{2.0, 2.0, -2.0, -2.0};
  const auto a = harmonic_amplitudes(t, y, 2.0, 9);
  REQUIRE(a.size() == 9);
  for (int k = 1; k <= 9; ++k) {
    const double exact = k % 2 == 1 ? 8.0 / (std::numbers::pi * k) : 0.0;
    CHECK(a[static_cast<std::size_t>(k - 1)] == Approx(exact).margin(1e-14));
  }
}

TEST_CASE("spectrum: a triangle wave is exact from its corners alone") {
  const auto a = harmonic_amplitudes({0.0, 0.5, 1.5, 2.0}, {0.0, 1.0, -1.0, 0.0}, 2.0, 7);
  for (int k = 1; k <= 7; ++k) {
    const double exact = k % 2 == 1 ? 8.0 / std::pow(std::numbers::pi * k, 2) : 0.0;
    CHECK(a[static_cast<std::size_t>(k - 1)] == Approx(exact).margin(1e-14));
  }
}

TEST_CASE("spectrum: of a sampled cosine the straight lines lose (k w h)^2/12, steps of any length") {
  std::vector<double> t, y;
  for (int i = 0; i <= 1000; ++i) {
    const double share = i / 1000.0;
    t.push_back(share + 0.05 * std::sin(2.0 * std::numbers::pi * share));
    y.push_back(std::cos(2.0 * std::numbers::pi * t.back()) + 0.1 * std::cos(6.0 * std::numbers::pi * t.back() + 1.0));
  }
  const auto a = harmonic_amplitudes(t, y, 1.0, 4);
  CHECK(a[0] == Approx(1.0).epsilon(1e-5));
  CHECK(a[1] == Approx(0.0).margin(1e-5));
  CHECK(a[2] == Approx(0.1).epsilon(1e-4));
  CHECK(std::abs(a[0] - 1.0) > 1e-7);  // the loss is there, and of the size that is stated
}

TEST_CASE("spectrum: nothing to ask") {
  CHECK(harmonic_amplitudes({}, {}, 1.0, 3).empty());
  CHECK(harmonic_amplitudes({0.0, 1.0}, {0.0}, 1.0, 3).empty());
  CHECK(harmonic_amplitudes({0.0, 1.0}, {0.0, 1.0}, 0.0, 3).empty());
}
