#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace limcycle;

TEST_CASE(
    "turning points: a small oscillation after a large first swing is found, also one that repeats itself exactly") {
  for (const bool exactly : {true, false}) {
    CAPTURE(exactly);
    TurningPoints turning;
    for (int k = 0; k < 4000; ++k) {
      const double small = exactly ? 0.01 * ((k % 8 < 4) ? k % 8 : 8 - k % 8) / 4.0 : 0.01 * std::sin(0.8 * k);
      turning.feed(k, 70.0 * std::exp(-0.1 * k) + small);
    }
    CHECK(turning.points().size() > 100);
    CHECK(turning.swing(0) < 0.03);
  }
}

TEST_CASE("turning points: a slow approach without reversals has none") {
  TurningPoints turning;
  for (int k = 0; k < 1000; ++k) turning.feed(k, 1.0 - std::exp(-0.01 * k));
  CHECK(turning.points().size() == 1);
}
