#include <catch2/catch.hpp>

#include "limcycle/models/delay.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/measured.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;
using Complex = std::complex<double>;

namespace {

constexpr double from_w = 0.1, to_w = 300.0, shaft_damping = 12.0;

/// The masses of two_masses(), friction and sensor at the motor.
TwoMass known_masses() {
  TwoMass plant;
  plant.motor_mass = plant.load_mass = 0.5;
  plant.stiffness = 200.0;
  plant.damping = shaft_damping;
  plant.friction_on.index = plant.measured.index = 0;
  return plant;
}

/// A plant of the same data with a fit that is much too simple: the frequency domain must not see it.
MeasuredPlant roughly_fitted(int points = 100) {
  MeasuredPlant plant = measured_plant(sampled_response(two_masses(shaft_damping), from_w, to_w, points));
  plant.order = 3.0;
  plant.poles_at_zero.index = 3;
  plant.relative_degree.index = 2;
  return plant;
}

double largest_difference(const Loop& one, const Loop& other, const std::vector<double>& frequencies) {
  double largest = 0.0;
  for (const double w : frequencies) {
    const Eigen::MatrixXcd a = one.element_response(w), b = other.element_response(w);
    const Eigen::RowVectorXcd y = one.output_response(w), z = other.output_response(w);
    largest = std::max({largest, (a - b).norm() / b.norm(), (y - z).norm() / z.norm()});
  }
  return largest;
}

LoopParts servo_with(Plant plant) {
  LoopParts parts;
  parts.plant = std::move(plant);
  Pid controller = pid(30.0, 40.0, 6.0);
  controller.saturation = 50.0;
  controller.friction_compensation = 0.4;
  parts.controller = controller;
  parts.friction = coulomb(1.5, 1.0);
  return parts;
}

}  // namespace

TEST_CASE("measured plant: at its frequencies a loop has the response of the data, however rough the fit") {
  const MeasuredPlant plant = roughly_fitted();
  REQUIRE(plant.measured()->fit().error.largest > 0.05);
  const auto& points = plant.data->frequency;
  SECTION("with friction, compensation and a limited command: matrices of three elements") {
    const Loop known = build_loop(servo_with(known_masses())), loop = build_loop(servo_with(plant));
    REQUIRE(loop.elements.size() == 3);
    CHECK(largest_difference(loop, known, points) < 1e-9);
    CHECK(largest_difference(with_fits(loop), known, points) > 0.01);
  }
  SECTION("with an actuator, an element in series, and no friction") {
    LoopParts parts;
    Pid controller = pid(3.0, 0.0, 0.5);
    controller.lag = 0.02;
    controller.tf = 0.01;
    parts.controller = controller;
    parts.element = relay(1.0);
    parts.plant = known_masses();
    const Loop known = build_loop(parts);
    parts.plant = plant;
    CHECK(largest_difference(build_loop(parts), known, points) < 1e-9);
  }
  SECTION("with a sampled controller: its hold and pulse transfer function before the data") {
    LoopParts parts = servo_with(known_masses());
    std::get<Pid>(parts.controller).sample_time = 1e-3;
    std::get<Pid>(parts.controller).tf = 0.01;
    const Loop known = build_loop(parts);
    REQUIRE(known.delay > 0.0);
    parts.plant = plant;
    CHECK(largest_difference(build_loop(parts), known, points) < 1e-9);
  }
}

TEST_CASE("measured plant: of two in a diagram each has its own data") {
  const auto diagram = [](const Plant& one, const Plant& other) {
    LoopParts parts;
    Diagram all;
    all.output = {1.0, "b", "y"};
    all.blocks.push_back({"a", "diagram.a", one, {{{1.0, "r", ""}, {-0.5, "b", "y"}, {-20.0, "a", "y"}}}});
    all.blocks.push_back({"b", "diagram.b", other, {{{3.0, "a", "y"}, {-20.0, "b", "y"}}}});
    all.blocks.push_back({"f", "diagram.f", Element(coulomb(1.0, 1.0)), {}, Contact::opposes, "a", "b"});
    parts.diagram = all;
    return build_loop(parts);
  };
  const Loop known = diagram(known_masses(), Mass{2.0, 0.3, 1.0});
  MeasuredPlant second = measured_plant(
      sampled_response([](Complex s) { return 1.0 / (2.0 * s * s + 0.3 * s + 1.0); }, from_w, to_w, 100));
  second.order = 2.0;
  second.relative_degree.index = 2;
  const MeasuredPlant first = roughly_fitted();
  const Loop loop = diagram(first, second);
  REQUIRE(loop.measured.size() == 2);
  CHECK(largest_difference(loop, known, first.data->frequency) < 1e-8);
  CHECK(in_time_domain(loop, 3).loop.measured.empty());
}

TEST_CASE("measured plant: between its frequencies the ratio of data and fit is interpolated, beyond them it is 1") {
  const auto at = [](int points) {
    const MeasuredPlant plant = roughly_fitted(points);
    const auto response = plant.measured();
    double largest = 0.0;
    for (double w = 0.15; w < 250.0; w *= 1.01) {
      const Complex G = response->ratio(w) * response_of(response->fit().model, w);
      largest = std::max(largest, std::abs(G / two_masses({0.0, w}, shaft_damping) - 1.0));
    }
    CHECK(response->ratio(0.5 * from_w) == 1.0);
    CHECK(response->ratio(2.0 * to_w) == 1.0);
    return largest;
  };
  const double coarse = at(100), fine = at(200);
  CHECK(coarse / fine == Approx(4.0).epsilon(0.3));  // straight lines: second order
}

TEST_CASE("measured plant: a gap is not interpolated over") {
  FrequencyData data = sampled_response(two_masses(shaft_damping), from_w, to_w, 100);
  data.frequency.erase(data.frequency.begin() + 40, data.frequency.begin() + 50);
  data.response.erase(data.response.begin() + 40, data.response.begin() + 50);
  MeasuredPlant plant = measured_plant(data);
  plant.order = 3.0;
  plant.poles_at_zero.index = 3;
  const auto response = plant.measured();
  const double below = data.frequency[39], above = data.frequency[40];
  const auto ranges = response->ranges();
  REQUIRE(ranges.size() == 2);
  CHECK(ranges[0] == std::pair(data.frequency.front(), below));
  CHECK(ranges[1] == std::pair(above, data.frequency.back()));
  CHECK(response->ratio(std::sqrt(below * above)) == 1.0);
  for (const std::size_t i : {39U, 40U})
    CHECK(std::abs(response->ratio(data.frequency[i]) * response_of(response->fit().model, data.frequency[i]) /
                       data.response[i] -
                   1.0) < 1e-12);
}

TEST_CASE("measured plant: a dead time is kept out of the fit") {
  const ResponseOf G = [](Complex s) { return std::exp(-0.2 * s) / (s + 1.0); };
  MeasuredPlant plant = measured_plant(sampled_response(G, 0.01, 50.0, 100));
  plant.delay = 0.2;
  CHECK(plant.measured()->fit().shape.order == 1);
  CHECK(plant.measured()->fit().error.largest < 1e-9);
  CHECK(plant.model().delay == 0.2);
  LoopParts parts;
  parts.element = relay(1.0);
  parts.plant = plant;
  const Loop loop = build_loop(parts);
  parts.plant = FirstOrder{1.0, 1.0, 0.2};
  CHECK(largest_difference(loop, build_loop(parts), {0.02, 0.5, 3.0, 40.0}) < 1e-9);
}

TEST_CASE("measured plant: its gain is a factor, and a changed order makes a new fit") {
  MeasuredPlant plant = measured_plant(sampled_response(two_masses(shaft_damping), from_w, to_w, 100));
  plant.response = plant.measured();
  CHECK(plant.measured() == plant.response);
  const PlantModel one = plant.model();
  plant.gain = -3.0;
  CHECK(plant.model().B_u == -3.0 * one.B_u);
  CHECK(plant.model().B_F == -3.0 * one.B_F);
  plant.order = 6.0;
  CHECK(plant.measured()->fit().shape.order == 6);
  CHECK(plant.model().A.rows() == 6);
}

TEST_CASE("measured plant: what cannot be fitted is refused with the reason") {
  const auto refusal = [](const MeasuredPlant& plant) {
    const auto broken = plant.validate();
    return broken ? broken->key + ": " + broken->rule : "";
  };
  const ResponseOf unstable = [](Complex s) { return 1.0 / ((s - 1.0) * (s + 3.0)); };
  CHECK_THAT(refusal(measured_plant(sampled_response(unstable, 0.1, 50.0, 100))),
             Contains("file: is fitted by no stable function") && Contains("% (rms)"));
  CHECK_THAT(refusal(measured_plant(sampled_response(two_masses(shaft_damping), 1.0, 200.0, 3))),
             Contains("holds 3 points: too few"));
  MeasuredPlant plant = measured_plant(sampled_response(two_masses(shaft_damping), 1.0, 200.0, 100));
  CHECK(refusal(plant).empty());
  plant.order = 2.5;
  CHECK(refusal(plant) == "order: must be a whole number");
  plant.order = 1.0;
  plant.poles_at_zero.index = 3;
  CHECK_THAT(refusal(plant), Contains("order: must be at least 2"));
  LoopParts parts;
  parts.friction = coulomb(1.0, 1.0);
  MeasuredPlant lag = measured_plant(sampled_response([](Complex s) { return 1.0 / (s + 1.0); }, 0.1, 50.0, 60));
  parts.plant = lag;
  const auto broken = validate(parts);
  REQUIRE(broken);
  CHECK_THAT(broken->rule, Contains("relative_degree"));
}
