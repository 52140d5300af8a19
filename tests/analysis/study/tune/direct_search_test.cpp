#include "limcycle/analysis/study/tune/direct_search.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace limcycle;

namespace {

using Place = std::vector<double>;

/// Where the search ends for a cost, infinite where a place is not allowed; checks that it stays in the cube.
template <class Cost>
Place least(const Cost& cost, Place place, double last_step, std::uint64_t seed = 0) {
  double best = cost(place);
  const auto first_better = [&](std::span<const Place> places, double) -> std::optional<std::size_t> {
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (const double x : places[k]) CHECK((x >= 0.0 && x <= 1.0));
      if (!(cost(places[k]) < best)) continue;
      best = cost(places[k]);
      return k;
    }
    return std::nullopt;
  };
  DirectSearch search;
  search.last_step = last_step;
  CHECK(search.run(place, RandomStream(seed, "test"), first_better, [] { return false; }));
  return place;
}

double distance(const Place& a, const Place& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("direct search: a smooth minimum, to the last step") {
  const Place at{0.37, 0.81, 0.2};
  const auto cost = [&](const Place& x) {
    const double a = x[0] - at[0], b = x[1] - at[1], c = x[2] - at[2];
    return a * a + 4.0 * b * b + 0.5 * c * c + 0.8 * a * b;
  };
  for (const double last : {1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0})
    CHECK(distance(least(cost, {0.9, 0.1, 0.9}, last), at) < 2.0 * last);
}

TEST_CASE("direct search: the oblique edge of what is allowed does not stop it") {
  // x + 2 y is largest on the arc of radius 0.8 at the angle of (1, 2).
  const Place at{0.8 / std::sqrt(5.0), 1.6 / std::sqrt(5.0)};
  const auto cost = [](const Place& x) { return std::hypot(x[0], x[1]) > 0.8 ? INFINITY : -x[0] - 2.0 * x[1]; };
  std::vector<double> short_of;
  for (std::uint64_t seed = 0; seed < 41; ++seed)
    short_of.push_back(1.0 - cost(least(cost, {0.6, 0.1}, 1.0 / 512.0, seed)) / cost(at));
  std::ranges::sort(short_of);
  INFO(short_of[20] << " in the middle, " << short_of[36] << " at nine tenths, " << short_of[40] << " at most");
  CHECK(short_of[0] > 0.0);
  CHECK(short_of[20] < 0.005);
  CHECK(short_of[36] < 0.02);
}

TEST_CASE("direct search: a minimum in a corner lies on the bounds exactly, one number alone works, a stop ends it") {
  CHECK(least([](const Place& x) { return x[0] - x[1]; }, {0.3, 0.3}, 0.01) == Place{0.0, 1.0});
  CHECK(distance(least([](const Place& x) { return std::abs(x[0] - 0.613); }, {0.1}, 0.002), {0.613}) < 0.004);
  Place place{0.5};
  CHECK_FALSE(DirectSearch{}.run(
      place, RandomStream(0, "test"), [](auto, double) { return std::nullopt; }, [] { return true; }));
  CHECK(place == Place{0.5});
}
