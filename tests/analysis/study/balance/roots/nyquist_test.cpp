#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/study/balance/roots/nyquist.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

TEST_CASE("Nyquist picture: a narrow resonance is no polygon") {
  // Damping 1e-4: the resonance is 2e-4 of its frequency wide, a hundredth of the grid's step.
  const auto loop = test::forward(test::relay(1.0), {1.0}, {1.0, 2e-4, 1.0});
  const auto picture = nyquist_picture(loop, FirstHarmonicBalance(loop), {1e-3, 10.0, 0.01, 100.0});
  REQUIRE(picture.frequency.size() == picture.G.size());
  double highest = 0.0;
  for (std::size_t i = 0; i < picture.G.size(); ++i) {
    const std::complex<double> s(0.0, picture.frequency[i]), right = 1.0 / (s * s + 2e-4 * s + 1.0);
    REQUIRE(std::abs(picture.G[i] - right) < 1e-9 * std::abs(right));
    highest = std::max(highest, std::abs(right));
    if (i == 0) continue;
    REQUIRE(picture.frequency[i] > picture.frequency[i - 1]);
    REQUIRE(std::abs(picture.G[i] - picture.G[i - 1]) < 0.5 * highest);
  }
  CHECK(highest > 0.9 / 2e-4);
  CHECK(picture.G.size() < 1000);
}

TEST_CASE("Nyquist picture: both curves have points at a root, and 1 + N G = 0 holds there") {
  const auto loop = test::servo(test::coulomb(1.0, 1.0));
  const SearchBox box{1e-4, 1.0, 0.1, 100.0};
  const SearchPoint root{0.012345, 3.21};
  const auto picture = nyquist_picture(loop, FirstHarmonicBalance(loop), box, {root});
  const auto place = [](const std::vector<double>& list, double value) {
    const auto at = std::find(list.begin(), list.end(), value);
    REQUIRE(at != list.end());
    return static_cast<std::size_t>(at - list.begin());
  };
  place(picture.frequency, root.frequency);
  const auto column = place(picture.family_amplitude, root.amplitude);
  const auto member = place(picture.family_frequency, root.frequency);
  REQUIRE(picture.minus_inverse_N.size() == picture.family_frequency.size());
  for (const auto& one : picture.minus_inverse_N) REQUIRE(one.size() == picture.family_amplitude.size());
  const auto N = FirstHarmonicBalance(loop).gain(root.amplitude, root.frequency, 1e-6);
  CHECK(std::abs(1.0 + N * picture.minus_inverse_N[member][column]) < 1e-3);
  CHECK(std::is_sorted(picture.family_amplitude.begin(), picture.family_amplitude.end()));
  CHECK(std::is_sorted(picture.frequency.begin(), picture.frequency.end()));
}

TEST_CASE("Nyquist picture: one member where N does not depend on frequency, and interrupted it ends early") {
  const auto loop = test::forward(test::relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0});
  const SearchBox box{1e-3, 10.0, 0.01, 100.0};
  CHECK(nyquist_picture(loop, FirstHarmonicBalance(loop), box).minus_inverse_N.size() == 1);
  const auto stopped = nyquist_picture(loop, FirstHarmonicBalance(loop), box, {}, [] { return true; });
  CHECK(stopped.minus_inverse_N.front().empty());
}
