#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>

#include "limcycle/analysis/study/sensitivity/global/bootstrap.hpp"

using namespace limcycle;

TEST_CASE("random stream: SplitMix64 gives the published numbers") {
  std::uint64_t state = 1234567;
  for (const std::uint64_t published :
       {6457827717110365317U, 3203168211198807973U, 9817491932198370423U, 4593380528125082431U, 16408922859458223821U})
    CHECK(splitmix64(state) == published);
}

TEST_CASE("random stream: seed, purpose and number each give another stream, always the same one") {
  std::set<std::uint64_t> first;
  for (const std::uint64_t seed : {0U, 1U, 2U})
    for (const char* purpose : {"", "a", "b", "ab", "ba"})
      for (const std::uint64_t number : {0U, 1U, 2U}) {
        CHECK(RandomStream(seed, purpose, number).bits() == RandomStream(seed, purpose, number).bits());
        first.insert(RandomStream(seed, purpose, number).bits());
      }
  CHECK(first.size() == 3 * 5 * 3);
  RandomStream pinned(1, "Sobol design");  // computed independently; another number changes every study
  CHECK(pinned.bits() == 5742265081142985220U);
}

TEST_CASE("random stream: uniform numbers have the moments of the unit interval, and whole ones are equally likely") {
  RandomStream random(3, "test");
  double sum = 0.0, squares = 0.0, neighbours = 0.0, before = 0.5;
  constexpr int count = 100000;
  for (int k = 0; k < count; ++k) {
    const double u = random.uniform();
    REQUIRE((u > 0.0 && u < 1.0));
    sum += u, squares += u * u, neighbours += (u - 0.5) * (before - 0.5), before = u;
  }
  // Four standard deviations of each.
  CHECK(sum / count == Approx(0.5).margin(4 * 0.289 / 316));
  CHECK(squares / count == Approx(1.0 / 3.0).margin(4 * 0.298 / 316));
  CHECK(neighbours / count == Approx(0.0).margin(4 * (1.0 / 12) / 316));
  std::array<int, 7> drawn{};
  for (int k = 0; k < 70000; ++k) ++drawn.at(random.below(7));
  for (const int one : drawn) CHECK(one == Approx(10000).margin(4 * 93));
  CHECK(random.below(1) == 0);
  CHECK_THROWS_AS(random.below(0), std::invalid_argument);
}

namespace {

/// Mean of numbers with an interval by bootstrap.
Estimate mean_of(const std::vector<double>& numbers, std::uint64_t seed) {
  return bootstrap(numbers.size(), 400, RandomStream(seed, "test"), [&](std::span<const double> weights) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 0; k < numbers.size(); ++k) sum += weights[k] * numbers[k], count += weights[k];
    return std::vector<std::optional<double>>{sum / count};
  })[0];
}

}  // namespace

TEST_CASE("bootstrap: the interval holds the mean in 95 of 100 samples, also of few numbers") {
  for (const std::size_t count : {10U, 20U, 100U}) {
    int held = 0;
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      RandomStream random(seed, "numbers");
      std::vector<double> numbers;
      for (std::size_t k = 0; k < count; ++k) numbers.push_back(random.uniform() + random.uniform());
      const Estimate mean = mean_of(numbers, seed);
      REQUIRE(mean.bounded());
      held += mean.low <= 1.0 && mean.high >= 1.0 ? 1 : 0;
    }
    INFO(count << " numbers: " << held << " of 500");
    CHECK(held >= 460);
    CHECK(held <= 490);
  }
}

TEST_CASE("bootstrap: what cannot be told has no interval") {
  const Estimate few = mean_of(std::vector<double>(7, 2.0), 1);
  CHECK((few.known && !few.bounded() && few.value == 2.0));
  CHECK(mean_of(std::vector<double>(8, 2.0), 1).bounded());
  // Known only where unit 0 was drawn: in 64 % of the resamples.
  const auto rarely = bootstrap(100, 400, RandomStream(1, "test"), [](std::span<const double> weights) {
    return std::vector<std::optional<double>>{weights[0] > 0.0 ? std::optional(weights[0]) : std::nullopt, {}};
  });
  CHECK((rarely[0].known && !rarely[0].bounded()));
  CHECK((!rarely[1].known && !rarely[1].bounded() && rarely[1].value == 0.0));
  CHECK(bootstrap(0, 400, RandomStream(1, "test"), [](std::span<const double>) {
          return std::vector<std::optional<double>>{std::nullopt};
        }).size() == 1);
}
