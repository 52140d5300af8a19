#include "limcycle/analysis/study/tune/tune_space.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace limcycle;

namespace {

const std::vector<TuneNumber> three{
    {"a", "1", 0.0, 1.0, 100.0}, {"b", "1", 0.0, 0.0, 7.0}, {"c", "1", 0.0, -3.0, -1.0 / 3.0}};

}  // namespace

TEST_CASE("tune space: even in the logarithm of bounds of one sign, else in the number, four digits, bounds exact") {
  const TuneSpace space(three);
  CHECK(space.values(std::vector{0.5, 0.5, 0.5}) == std::vector{10.0, 3.5, -1.0});
  CHECK(space.values(std::vector{0.0, 0.0, 0.0}) == std::vector{1.0, 0.0, -3.0});
  CHECK(space.values(std::vector{1.7, 1.0, 1.0}) == std::vector{100.0, 7.0, -1.0 / 3.0});
  CHECK(space.values(std::vector{0.123456, 0.123456, -1.0}) == std::vector{1.766, 0.8642, -3.0});
  const auto place = space.place(std::vector{10.0, 3.5, -1.0});
  for (const double share : place) CHECK(share == Approx(0.5));
  CHECK(space.contains(std::vector{1.0, 7.0, -1.0 / 3.0}));
  CHECK_FALSE(space.contains(std::vector{1.0, 7.0, -0.3333}));
  CHECK_FALSE(space.contains(std::vector{1.0, std::nan(""), -1.0}));
  CHECK(with_four_digits(-0.00123456) == -0.001235);
  CHECK(with_four_digits(0.0) == 0.0);
}

TEST_CASE("tune space: values beside a point, as far as the bounds reach") {
  const auto beside = TuneSpace(three).beside(std::vector{100.0, 0.0, -1.0}, 0.01, 0.02);
  REQUIRE(beside.size() == 6);
  CHECK(beside[0] == std::vector{99.0, 0.0, -1.0});
  CHECK(beside[1].empty());
  CHECK(beside[2].empty());
  CHECK(beside[3] == std::vector{100.0, 0.14, -1.0});
  CHECK(beside[4] == std::vector{100.0, 0.0, -1.01});
  CHECK(TuneSpace(three).beside(std::vector{50.0, 0.0, -1.0}, 0.01, 0.0)[3].empty());
  CHECK(beside[5] == std::vector{100.0, 0.0, -0.99});
}

TEST_CASE("tune space: rounding does not lead beyond a bound") {
  const TuneSpace narrow(std::vector<TuneNumber>{{"a", "1", 0.0, 1.00004, 1.00006}});
  for (const double share : {0.01, 0.3, 0.5, 0.99}) {
    const auto values = narrow.values(std::vector{share});
    CHECK(values[0] >= 1.00004);
    CHECK(values[0] <= 1.00006);
  }
}

TEST_CASE("tune space: the design meets every bound, stays within them, and is the same for one seed") {
  const TuneSpace space(three);
  const auto design = space.design(64, 5);
  REQUIRE(design.size() == 64);
  CHECK(design == space.design(64, 5));
  CHECK(design != space.design(64, 6));
  for (std::size_t i = 0; i < 3; ++i) {
    int low = 0, high = 0;
    for (const auto& place : design) {
      CHECK(place[i] >= 0.0);
      CHECK(place[i] <= 1.0);
      low += place[i] == 0.0;
      high += place[i] == 1.0;
    }
    CHECK(low == 4);  // a sixteenth of a net
    CHECK(high == 4);
  }
}
