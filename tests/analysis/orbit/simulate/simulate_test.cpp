#include "limcycle/analysis/orbit/simulate/simulate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

std::vector<double> column(const Simulation& run, const std::string& name) {
  const auto at = std::ranges::find(run.columns, name);
  REQUIRE(at != run.columns.end());
  std::vector<double> values;
  for (const auto& row : run.rows) values.push_back(row[static_cast<std::size_t>(at - run.columns.begin())]);
  return values;
}

}  // namespace

TEST_CASE("step to the set-point: error swings of claim B7, the same by every stepper") {
  SimulateOptions options;
  options.duration = 60.0;
  options.reference = Signal{.kind = Signal::Kind::constant, .value = 1.0};
  options.rtol = 1e-9;
  const auto reference = simulate(servo(lugre()), options);
  REQUIRE(reference.status == Status::converged);
  CHECK(reference.stepper == "rodas5p");
  const auto y = column(reference, "y");
  CHECK(reference.rows.size() == 1001);
  double late = 0.0;
  for (std::size_t i = 700; i < y.size(); ++i) late = std::max(late, std::abs(y[i] - 1.0));
  CHECK(late == Approx(0.0639).epsilon(0.03));
  options.stepper = "dopri5";
  options.rtol = 1e-8;
  const auto explicit_run = simulate(servo(lugre()), options);
  const auto other = column(explicit_run, "y");
  for (std::size_t i = 0; i < y.size(); i += 100) CHECK(other[i] == Approx(y[i]).margin(1e-6));
}

TEST_CASE("forced mass with Coulomb friction under a step: sticks below break-away, moves exactly above it") {
  LoopParts parts;
  parts.plant = Mass{2.0, 0.0, 0.0};
  parts.friction = coulomb(1.5, 1.0);
  const Loop loop = build_loop(parts);
  SimulateOptions options;
  options.duration = 4.0;
  options.force = Signal{.kind = Signal::Kind::step, .value = 1.4, .start = 1.0};
  CHECK(column(simulate(loop, options), "y").back() == 0.0);
  options.force->value = 3.0;
  const auto run = simulate(loop, options);
  CHECK(column(run, "y").back() == Approx(0.5 * (3.0 - 1.0) / 2.0 * 9.0).epsilon(1e-9));
  REQUIRE(run.events.size() == 1);
  CHECK(run.events[0].t == Approx(1.0).margin(1e-9));
  CHECK(run.events[0].what == "loop.friction");
}

TEST_CASE("signals: values, slopes and breaks") {
  const Signal zigzag{.kind = Signal::Kind::zigzag, .value = 2.0, .start = 1.0, .rate = 4.0};
  CHECK(zigzag.at(0.5) == 0.0);
  CHECK(zigzag.at(1.25) == Approx(1.0));
  CHECK(zigzag.at(1.5) == Approx(2.0));
  CHECK(zigzag.at(2.5) == Approx(-2.0));
  CHECK(zigzag.slope(1.2) == 4.0);
  CHECK(zigzag.slope(2.0) == -4.0);
  CHECK(zigzag.breaks(3.0) == std::vector<double>{1.0, 1.5, 2.5});
  const Signal table{.kind = Signal::Kind::table, .times = {0.0, 1.0, 3.0}, .values = {0.0, 2.0, -2.0}};
  CHECK(table.at(0.5) == Approx(1.0));
  CHECK(table.at(2.0) == Approx(0.0).margin(1e-15));
  CHECK(table.at(9.0) == -2.0);
  CHECK(table.slope(2.0) == Approx(-2.0));
  const Signal sine{.kind = Signal::Kind::sine, .value = 2.0, .frequency = 3.0};
  CHECK(sine.at(0.5) == Approx(2.0 * std::sin(1.5)));
  CHECK(sine.slope(0.5) == Approx(6.0 * std::cos(1.5)));
}

TEST_CASE("what cannot be simulated is refused with the reason") {
  SimulateOptions options;
  const Loop loop = servo(lugre());
  CHECK_THROWS_AS(simulate(loop, options), std::invalid_argument);  // no duration
  options.duration = 1.0;
  options.initial["velocity"] = 1.0;
  CHECK_THROWS_WITH(simulate(loop, options), Catch::Contains("the states are y, v, I, z"));
  options.initial.clear();
  options.stepper = "euler";
  CHECK_THROWS_AS(simulate(loop, options), std::invalid_argument);
}
