#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/return_map.hpp"
#include "limcycle/analysis/orbit/settle/watch/rest_watch.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

/// Results must not depend on the units in which a loop is written, nor on its own speed and size.

namespace {

/// m = 1 kg under PID (3, 4, 6) with a command limited to 4 N, with the unit of time 1/T s and that of length 1/L m.
Loop weak_servo(double L, double T, double reference = 0.0) {
  LoopParts parts;
  parts.plant = Mass{T * T / L, 0.0, 0.0};
  auto controller = pid(3.0 / L, 4.0 / (L * T), 6.0 * T / L);
  controller.saturation = 4.0;
  parts.controller = controller;
  parts.friction = coulomb(1.5, 1.0);
  parts.reference = reference;
  return build_loop(parts);
}

/// A relay with hysteresis and an integrator: all poles are at the origin.
Loop relay_integrator(double level, double hysteresis, double gain) {
  return forward(relay(level, hysteresis), {gain}, {1.0, 0.0});
}

Loop fast_pole() {
  LoopParts parts;
  parts.plant = ZeroPoleGain{{}, {15.1443, -83.6762, -26.2122, -8367619.999999999}, 384625184157.99994, 0.0};
  parts.element = saturation(0.0117056);
  return build_loop(parts);
}

}  // namespace

TEST_CASE("units: the default search box of a servo with a limited command is that of the servo") {
  const SearchBox box = default_search_box(weak_servo(1.0, 1.0));
  for (const auto& [L, T] : {std::pair(1e-4, 0.01), std::pair(1e3, 1e-6), std::pair(1.0, 1e4)}) {
    const SearchBox other = default_search_box(weak_servo(L, T));
    CHECK(other.amplitude_max == Approx(L * box.amplitude_max).epsilon(1e-6));
    CHECK(other.frequency_min == Approx(box.frequency_min / T).epsilon(1e-6));
    CHECK(other.frequency_max == Approx(box.frequency_max / T).epsilon(1e-6));
  }
}

TEST_CASE("units: small hunting is found however far away the limit of the command is") {
  LoopParts parts;
  parts.plant = Mass{5.0, 0.01, 0.0};
  Pid controller = pid(2000.0, 8000.0, 150.0);
  controller.tf = 0.001;
  parts.friction = coulomb(8.1, 8.0);
  for (const double limit : {1e2, 1e4, 1e6, infinite}) {
    controller.saturation = limit;
    parts.controller = controller;
    const PredictReport report = predict(build_loop(parts));
    CAPTURE(limit);
    const auto hunting = std::ranges::find(report.cycles, std::optional(true), &Cycle::stable);
    REQUIRE(hunting != report.cycles.end());
    CHECK(hunting->amplitude == Approx(2.616e-5).epsilon(1e-3));
    CHECK(hunting->period == Approx(154.1).epsilon(1e-3));
  }
}

TEST_CASE("units: a servo with a limited command hunts alike however fast and small it is") {
  for (const auto& [L, T] : {std::pair(1.0, 1.0), std::pair(1e-4, 0.01), std::pair(100.0, 1e3)}) {
    const auto report = predict(weak_servo(L, T));
    const auto stable = std::ranges::find(report.cycles, std::optional<bool>(true), &Cycle::stable);
    REQUIRE(stable != report.cycles.end());
    CHECK(stable->period == Approx(23.36927 * T).epsilon(1e-6));
    CHECK(stable->amplitude == Approx(0.0672401 * L).epsilon(1e-5));
  }
}

TEST_CASE("units: typical sizes, slow time and rubbing speed scale with the loop") {
  const Loop one = weak_servo(1.0, 1.0), other = weak_servo(1e-4, 0.01);
  CHECK(slow_time(other) == Approx(0.01 * slow_time(one)));
  CHECK(typical_rubbing_velocity(other) == Approx(0.01 * typical_rubbing_velocity(one)));
  CHECK(rubbing_speed(other) == Approx(0.01 * rubbing_speed(one)));
  const State sizes = typical_sizes(one), others = typical_sizes(other);
  CHECK(others[0] == Approx(1e-4 * sizes[0]));
  CHECK(others[1] == Approx(0.01 * sizes[1]));
}

TEST_CASE("units: where all poles are at the origin the elements give the time of a loop") {
  // From -h to h at the slope gain*level: 2 h/(gain level) between two switches.
  CHECK(slow_time(relay_integrator(1.0, 0.1, 2.0)) == Approx(0.05));
  CHECK(slow_time(relay_integrator(1e3, 1e-4, 2e5)) == Approx(5e-13));
}

TEST_CASE("units: a moved set-point moves the point of rest, and leaves the loop symmetric") {
  for (const double reference : {0.0, 1.0, -3e4, 2e-7}) {
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    DeadZone<double> zone;
    zone.half_width = 0.1;
    auto controller = pid(3.0, 4.0, 0.0);
    parts.controller = controller;
    parts.error = zone;
    parts.reference = reference;
    const Loop loop = build_loop(parts);
    bool exact = false;
    const Eigen::VectorXd rest = in_the_case(loop, loop.rest_point(exact));
    CHECK(exact);
    CHECK(rest(0) == Approx(reference));
    CHECK(symmetry(loop).has_value());
  }
}

TEST_CASE("displaced: a start moves the motion, not a state that is back at once") {
  const Loop loop = fast_pole();
  const LoopState start = displaced(loop, 0.01);
  const Eigen::Map<const Eigen::VectorXd> x(start.x.data(), loop.states());
  CHECK((loop.C_y * x).value() == Approx(0.01));
  // Remainder of y after the fast pole has decayed: s Y(s) between slow and fast.
  const double s = 2e4;
  const Eigen::MatrixXd M = s * Eigen::MatrixXd::Identity(4, 4) - loop.A;
  CHECK(s * (loop.C_y * solve(M, Eigen::VectorXd(x))).value() == Approx(0.01).epsilon(0.01));
  const auto report = predict(loop);
  CHECK(report.outcomes.front().outcome == Outcome::divergence);
}

TEST_CASE("a slow pole beside the loop: where every start of the box diverges, smaller ones are tried") {
  // A conditionally stable loop: motions within the limit of the command come to rest, larger ones wind up.
  const auto loop_of = [](const Eigen::MatrixXd& A, double seen) {
    LoopParts parts;
    Pid controller = pid(2618.64, 63021.8, 13.6862);
    controller.lag = 2.31547e-4;
    controller.saturation = 2680.45;
    parts.controller = controller;
    StateSpacePlant plant;
    plant.A = A;
    plant.B = Eigen::MatrixXd::Zero(A.rows(), 1);
    plant.B(1, 0) = 44.4522;
    plant.C = Eigen::MatrixXd::Zero(1, A.rows());
    plant.C(0, 0) = 1.0;
    if (A.rows() > 2) plant.C(0, 2) = seen;
    parts.plant = plant;
    parts.friction = coulomb(190.534, 190.534, 0.0);
    return build_loop(parts);
  };
  const Eigen::MatrixXd slow{{0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, -0.1}};
  const auto alone = predict(loop_of(Eigen::MatrixXd{{0.0, 1.0}, {0.0, 0.0}}, 0.0));
  const auto unseen = predict(loop_of(slow, 0.0)), beside = predict(loop_of(slow, 1e-9));
  for (const PredictReport* report : {&alone, &unseen, &beside})
    for (const Outcome wanted : {Outcome::divergence, Outcome::rest})
      CHECK(std::ranges::count(report->outcomes, wanted, &OutcomeOfStart::outcome) > 0);
  const auto extended = [](const std::string& note) { return note.find("was extended down") != std::string::npos; };
  CHECK(std::ranges::any_of(beside.notes, extended));
  CHECK_FALSE(std::ranges::any_of(alone.notes, extended));
  CHECK(beside.search.amplitude_min ==
        Approx(1e-6 * default_search_box(loop_of(slow, 1e-9)).amplitude_min).margin(0.0));
  // One that nothing sees changes nothing.
  CHECK_FALSE(std::ranges::any_of(unseen.notes, extended));
  CHECK(unseen.search.amplitude_max == Approx(alone.search.amplitude_max).epsilon(1e-9));
  CHECK(unseen.search.frequency_min == Approx(alone.search.frequency_min).epsilon(1e-9));
}

TEST_CASE("units: typical sizes of a stiff drive are those of a slow one in another unit of time") {
  const auto drive = [](double T) {
    TwoMass plant;
    plant.motor_mass = 15.779 * T * T;
    plant.load_mass = 4.17122 * T * T;
    plant.stiffness = 45275800.0;
    plant.damping = 2268.16 * T;
    plant.friction_on.index = plant.measured.index = 0;
    LoopParts parts;
    parts.plant = plant;
    parts.controller = pid(170117.0, 5532580.0 / T, 1991.82 * T);
    parts.friction = coulomb(404.438, 300.665, 146.49 * T);
    return build_loop(parts);
  };
  const State sizes = typical_sizes(drive(1.0)), fast = typical_sizes(drive(0.0023));
  for (const std::size_t position : {0u, 2u}) CHECK(fast[position] == Approx(sizes[position]).epsilon(1e-6));
  for (const std::size_t velocity : {1u, 3u}) CHECK(0.0023 * fast[velocity] == Approx(sizes[velocity]).epsilon(1e-6));
  CHECK(fast[4] / 0.0023 == Approx(sizes[4]).epsilon(1e-6));
}

TEST_CASE("units: a free drive of two masses has no slowest pole by the root of rounding") {
  for (const double T : {1.0, 1e-3, 1e4}) {
    TwoMass plant;
    plant.motor_mass = 0.000460727 * T * T;
    plant.load_mass = 0.00060315 * T * T;
    plant.stiffness = 71557.2;
    plant.damping = 0.543673 * T;
    plant.friction_on.index = plant.measured.index = 1;
    LoopParts parts;
    parts.plant = plant;
    auto controller = pid(436.788, 15668.1 / T, 1.76729 * T);
    controller.saturation = 69570.6;
    parts.controller = controller;
    parts.friction = coulomb(6272.59, 3539.38);
    // The slowest is that of the integral action, near ki/kp.
    CHECK(pole_moduli(build_loop(parts)).front() * T == Approx(15668.1 / 436.788).epsilon(0.3));
  }
}
