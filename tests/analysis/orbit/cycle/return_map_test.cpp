#include "limcycle/analysis/orbit/cycle/return_map.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

ReturnMap::Options tight(double rtol) {
  ReturnMap::Options options;
  options.rtol = rtol;
  options.extremes = options.trace = true;
  return options;
}

}  // namespace

TEST_CASE("extremes along a return map are those of its motion, however long the steps") {
  for (const Loop& loop : {servo(lugre()), van_der_pol(5.0), servo(coulomb(1.5, 1.0))}) {
    const Section section{loop.C_y, 0.02, 1};
    ReturnMap map(loop, section, std::nullopt, tight(1e-10));
    const auto at = map.approach(displaced(loop, 1.0));
    REQUIRE(at.status == Status::converged);
    const auto result = map(at.state);
    REQUIRE(result.status == Status::converged);
    Trace fine;
    REQUIRE(record(loop, at.state, result.time, 1e-12, 20000, fine) == Status::converged);
    const auto [low, high] = extremes(fine);
    CHECK(result.extremes.low == Approx(low).epsilon(3e-9));
    CHECK(result.extremes.high == Approx(high).epsilon(3e-9));
    CHECK(2 * result.trace.t.size() < fine.t.size());
    CHECK(result.trace.t.back() == result.time);
  }
}

TEST_CASE("gradients of the time and of the extremes of a return map against differences") {
  for (const Loop& loop : {servo(lugre()), van_der_pol(2.0)}) {
    const Section section{loop.C_y, 0.02, 1};
    const auto half = symmetry(loop);
    REQUIRE(half);
    ReturnMap map(loop, section, half, tight(1e-12));
    auto at = map.approach(displaced(loop, 1.0));
    for (int i = 0; i < 4; ++i) at = map(at.state);
    REQUIRE(at.status == Status::converged);
    map.set_derivative(true);
    const auto centre = map(at.state);
    map.set_derivative(false);
    REQUIRE(centre.derivative.size() > 0);
    for (std::size_t i = 0; i < at.state.x.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (i < static_cast<std::size_t>(loop.states()) && loop.C_y(k) != 0.0) continue;  // it leaves the section
      const double step = 1e-5 * centre.largest[i];
      LoopState plus = at.state, minus = at.state;
      plus.x[i] += step;
      minus.x[i] -= step;
      const auto ahead = map(plus), behind = map(minus);
      const auto slope = [&](double a, double b) { return (a - b) / (2.0 * step); };
      const double unit_time = centre.time / centre.largest[i], unit = centre.extremes.high / centre.largest[i];
      CAPTURE(i, unit_time, unit);
      CHECK(centre.time_gradient(k) == Approx(slope(ahead.time, behind.time)).margin(1e-5 * unit_time).epsilon(1e-4));
      CHECK(centre.high_gradient(k) ==
            Approx(slope(ahead.extremes.high, behind.extremes.high)).margin(1e-5 * unit).epsilon(2e-3));
      CHECK(centre.low_gradient(k) ==
            Approx(slope(ahead.extremes.low, behind.extremes.low)).margin(1e-5 * unit).epsilon(2e-3));
    }
  }
}
