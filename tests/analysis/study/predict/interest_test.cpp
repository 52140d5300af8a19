#include "limcycle/analysis/study/predict/interest.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace limcycle;

namespace {

Cycle cycle_of(double amplitude, double period) {
  Cycle cycle;
  cycle.amplitude = amplitude;
  cycle.period = period;
  return cycle;
}

constexpr SearchBox asked_box{1e-6, 1.0, 0.01, 100.0};

}  // namespace

TEST_CASE("interest: a cycle below the least amplitude, or of a frequency outside, is not what was asked for") {
  CHECK(is_of_interest(asked_box, cycle_of(1e-3, 10.0)));
  CHECK_FALSE(is_of_interest(asked_box, cycle_of(8e-9, 10.0)));
  CHECK_FALSE(is_of_interest(asked_box, cycle_of(1e-3, 1733.0)));
  CHECK_FALSE(is_of_interest(asked_box, cycle_of(1e-3, 0.01)));
  CHECK(is_of_interest(asked_box, cycle_of(50.0, 10.0)));  // larger than the box is of interest
}

TEST_CASE("interest: a box of the user stays, a default box is widened") {
  const std::vector<Cycle> cycles{cycle_of(1e-3, 10.0), cycle_of(8e-9, 1733.0)};
  SearchBox given = asked_box;
  auto notes = compare_with_interest(cycles, true, given);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("cycle 1") != std::string::npos);
  CHECK(given.amplitude_min == asked_box.amplitude_min);
  SearchBox own = asked_box;
  notes = compare_with_interest(cycles, false, own);
  REQUIRE(notes.size() == 1);
  CHECK(is_of_interest(own, cycles[1]));
  CHECK(own.frequency_min < 2.0 * std::numbers::pi / 1733.0);
}
