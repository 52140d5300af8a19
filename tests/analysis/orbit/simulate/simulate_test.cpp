#include "limcycle/analysis/orbit/simulate/simulate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/with_memory/rate_limit.hpp"
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

TEST_CASE("simulate: an ideal derivative makes a kick of a step of the reference, a limited command none") {
  LoopParts parts;
  parts.plant = Mass{2.0, 0.0, 0.0};
  parts.friction = coulomb(0.6, 0.5);
  Pid controller = pid(30.0, 0.0, 6.0);
  parts.controller = controller;
  SimulateOptions options;
  options.rtol = 1e-9;
  options.duration = 0.75;
  options.sample = 0.25;
  const auto velocity = [&](double start) {
    options.reference = Signal{.kind = Signal::Kind::step, .value = 0.1, .start = start};
    return column(simulate(build_loop(parts), options), "state.v");
  };
  // The body rests until then; v jumps by 6*0.1/2, and moves under 2 v' = 30 (0.1 - y) - 6 v - 0.5 from there.
  double y = 0.0, v = 0.3;
  constexpr int steps = 200'000;
  for (int i = 0; i < steps; ++i) {
    constexpr double h = 0.25 / steps;
    const double middle = v + 0.5 * h * (1.25 - 15.0 * y - 3.0 * v);
    v += h * (1.25 - 15.0 * (y + 0.5 * h * v) - 3.0 * middle);
    y += h * middle;
  }
  for (const double start : {0.5, 0.25, 0.0}) {
    const auto seen = velocity(start);
    REQUIRE(seen.size() == 4);
    CHECK(seen[static_cast<std::size_t>(start / 0.25) + 1] == Approx(v).epsilon(1e-6));
  }
  controller.tf = 1e-6;
  parts.controller = controller;
  CHECK(velocity(0.5).back() == Approx(v).epsilon(1e-4));
  controller.tf = 0.0;
  controller.saturation = 4.0;
  parts.controller = controller;
  const double limited = velocity(0.5).back();
  controller.tf = 1e-6;
  parts.controller = controller;
  CHECK(velocity(0.5).back() == Approx(limited).epsilon(1e-4));
  CHECK(limited < 0.8 * v);
  CHECK(simulate(build_loop(parts), options).notes.empty());
  // Of what an element passes on, nothing is computed, and it is said.
  DeadZone<double> dead;
  dead.half_width = 0.01;
  controller.saturation = infinite;
  controller.tf = 0.0;
  parts.controller = controller;
  parts.error = dead;
  const auto notes = simulate(build_loop(parts), options).notes;
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("impulse") != std::string::npos);
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

namespace {

/// y' = r - y(t - delay) behind an integrator with a dead time, or its sign with a relay.
LoopParts late_integrator(Element element) {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 0.0}, 0.5};
  parts.element = std::move(element);
  return parts;
}

/// The largest distance of y from a function of time.
double distance_from(const Simulation& run, const std::function<double(double)>& y) {
  const auto column = static_cast<std::size_t>(std::ranges::find(run.columns, std::string("y")) - run.columns.begin());
  double largest = 0.0;
  for (const auto& row : run.rows) largest = std::max(largest, std::abs(row[column] - y(row[0])));
  return largest;
}

}  // namespace

TEST_CASE("simulate: a dead time is that of the method of steps, the more exactly the wider the band") {
  const Loop loop = build_loop(late_integrator(saturation(10.0)));
  SimulateOptions options;
  options.duration = 2.0;
  options.rtol = 1e-10;
  options.initial["x1"] = 1.0;
  // y is a polynomial of one degree more in every interval of 0.5 s.
  const auto exact = [](double t) {
    double sum = 1.0, factorial = 1.0;
    for (int k = 1; t - 0.5 * (k - 1) > 0.0; ++k) {
      factorial *= -k;
      sum += std::pow(t - 0.5 * (k - 1), k) / factorial;
    }
    return sum;
  };
  double wide = 0.0;
  for (const double band : {5.0, 20.0, 60.0}) {
    options.delay_band = band;
    const Simulation run = simulate(loop, options);
    REQUIRE(run.status == Status::converged);
    CHECK(std::ranges::none_of(run.columns, [](const std::string& name) { return name.find("delay") < name.size(); }));
    const double error = distance_from(run, exact);
    INFO(band << ": " << error);
    if (wide > 0.0) CHECK(error < 0.5 * wide);
    wide = error;
  }
  CHECK(wide < 2e-5);
}

TEST_CASE("simulate: a relay with dead time overshoots by the way of that time, exactly") {
  const Loop loop = build_loop(late_integrator(relay(1.0, 0.1)));
  SimulateOptions options;
  options.duration = 6.0;
  options.initial["x1"] = 0.4;
  // Down from 0.4 by 1 m/s; the relay sees -0.1 at 0.5 s, and acts at 1 s; then swings of 0.6 in 2.4 s.
  const auto exact = [](double t) {
    if (t < 1.0) return 0.4 - t;
    const double phase = std::fmod(t - 1.0, 2.4);
    return phase < 1.2 ? -0.6 + phase : 0.6 - (phase - 1.2);
  };
  const Simulation run = simulate(loop, options);
  REQUIRE(run.status == Status::converged);
  CHECK(distance_from(run, exact) < 1e-9);
}

TEST_CASE("simulate: the states of each element stand in columns of their own") {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.integral_reset = 0.3;
  parts.controller = controller;
  RateLimit<double> actuator;
  actuator.limit = 50.0;
  actuator.tau = 0.01;
  parts.element = actuator;
  SimulateOptions options;
  options.duration = 2.0;
  options.initial["y"] = 1.0;
  const Simulation run = simulate(build_loop(parts), options);
  REQUIRE(run.status == Status::converged);
  const auto integral = column(run, "loop.controller.integral_reset.output");
  int same = 0, shared = 0;
  for (std::size_t i = 0; i < run.columns.size(); ++i) {
    if (!run.columns[i].starts_with("state.z_")) continue;
    ++shared;
    bool equal = true;
    for (std::size_t k = 0; k < run.rows.size(); ++k) equal = equal && run.rows[k][i] == integral[k];
    if (equal) ++same;
  }
  CHECK(shared == 2);
  CHECK(std::set<std::string>(run.columns.begin(), run.columns.end()).size() == run.columns.size());
  CHECK(same == 1);
}
