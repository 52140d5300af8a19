#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/element/memoryless/gravity.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/plants.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double weight = 5.0 * 9.81 * 0.2;  // N m

}  // namespace

TEST_CASE("Froude pendulum: gravity and friction are its two elements, friction last") {
  const Loop loop = build_loop(parts_of(froude_pendulum(4.0)));
  REQUIRE(loop.elements.size() == 2);
  CHECK(loop.ports[0].path == "loop.plant.gravity");
  CHECK(loop.ports[1].path == "loop.friction");
  CHECK(loop.ports[1].rubs);
  CHECK(loop.A == (Eigen::Matrix2d() << 0.0, 1.0, 0.0, -0.02).finished());
  CHECK((loop.B - (Eigen::Matrix2d() << 0.0, 0.0, -4.0, -0.08).finished()).norm() < 1e-15);
  CHECK(loop.ports[0].C == Eigen::RowVector2d(1.0, 0.0));
  CHECK(loop.ports[1].C == Eigen::RowVector2d(0.02, 0.0));
  CHECK(loop.ports[1].C_v == Eigen::RowVector2d(0.0, 0.02));
  CHECK(loop.ports[1].c_v(constant_one) == Approx(-0.08));
  const auto& gravity = law_of<Gravity<double>>(loop.elements[0]);
  CHECK(gravity.output({0.3, 0.0, 0.0}, {}, {}) == Approx(weight * std::sin(0.3)));
}

TEST_CASE("Froude pendulum: without gravity it is a wheel on a shaft, with one element") {
  FroudePendulum p = froude_pendulum(4.0);
  p.gravity = 0.0;
  CHECK(build_loop(parts_of(p)).elements.size() == 1);
}

TEST_CASE("Froude pendulum: a shaft that turns drives the way it turns") {
  // shaft_radius F(shaft_radius (shaft_speed - dy/dt)) of the odd law is - shaft_radius F(v).
  const double r = 0.02, speed = 4.0, rate = 1.5;
  const auto law = coulomb(1.5, 1.0, 3.0);
  const Mode slips_back = law.start({0.0, r * (rate - speed), 0.0}, {});
  const Mode slips_on = law.start({0.0, r * (speed - rate), 0.0}, {});
  const double opposing = -r * law.output({0.0, r * (rate - speed), 0.0}, slips_back, {});
  const double driving = r * law.output({0.0, r * (speed - rate), 0.0}, slips_on, {});
  CHECK(opposing == driving);
  CHECK(driving > 0.0);
}

TEST_CASE("Froude pendulum: at rest gravity holds the load where the sine says, and no more than its own torque") {
  auto parts = parts_of(froude_pendulum(0.0));
  for (const double share : {0.0, 0.1, -0.7, 0.999, 0.9999999}) {
    parts.load = share * weight;
    bool exact = false;
    const Loop loop = build_loop(parts);
    const Eigen::VectorXd rest = in_the_case(loop, loop.rest_point(exact));
    CAPTURE(share);
    CHECK(exact);
    CHECK(rest(0) == Approx(std::asin(share)).margin(1e-15).epsilon(1e-6));
    CHECK(weight * std::sin(rest(0)) == Approx(parts.load).margin(1e-15).epsilon(1e-12));
    CHECK(std::abs(rest(1)) < 1e-12);
  }
  parts.load = 1.001 * weight;
  bool exact = true;
  CHECK(build_loop(parts).rest_point(exact).allFinite());
  CHECK_FALSE(exact);
}

TEST_CASE("Froude pendulum: the mean of a swing is where the mean of the sine balances") {
  auto parts = parts_of(froude_pendulum(0.0));
  parts.load = 1.0;
  const Loop loop = build_loop(parts);
  for (const double swing : {0.0, 0.5, 1.5}) {
    bool exact = false;
    const Eigen::VectorXd X =
        in_the_case(loop, loop.mean_point(Eigen::Vector2d(0.0, 20.0), Eigen::Vector2d(swing, 0.0), exact));
    CHECK(exact);
    double mean = 0.0;  // of the torque over the swing, by the trapezoidal rule
    for (int i = 0; i < 64; ++i) mean += weight * std::sin(X(0) + swing * std::sin(2.0 * M_PI * i / 64)) / 64.0;
    CHECK(mean == Approx(1.0 - 0.02 * 20.0).epsilon(1e-12));
  }
}

TEST_CASE("gravity: describing function against sums over a period") {
  Gravity<double> gravity;
  gravity.mass = 5.0;
  gravity.gravity = 9.81;
  gravity.arm = 0.2;
  for (const double A : {1e-3, 0.5, 2.0, 4.0})
    for (const double bias : {0.0, 0.4}) {
      double sine = 0.0, mean = 0.0;
      constexpr int n = 128;
      for (int i = 0; i < n; ++i) {
        const double s = std::sin(2.0 * M_PI * i / n), y = weight * std::sin(bias + A * s);
        sine += 2.0 * s * y / n;
        mean += y / n;
      }
      CHECK(gravity.exact_describing_function(A, 3.0, bias)->real() == Approx(sine / A).epsilon(1e-12));
      CHECK(gravity.mean_output(bias, A) == Approx(mean).margin(1e-13));
      const double slope = (gravity.mean_output(bias + 1e-6, A) - gravity.mean_output(bias - 1e-6, A)) / 2e-6;
      CHECK(gravity.mean_slope(bias, A) == Approx(slope).epsilon(1e-8));
    }
}

TEST_CASE("Froude pendulum: poles are those of the hanging pendulum, and of a servo that holds it") {
  auto parts = parts_of(froude_pendulum(4.0));
  const Eigen::VectorXcd poles = eigenvalues(build_loop(parts).tangent());
  CHECK(poles.cwiseAbs().maxCoeff() == Approx(std::sqrt(weight / 0.25)));
  parts.controller = pid(20.0, 30.0, 5.0);
  parts.reference = 0.5;
  const Loop servo = build_loop(parts);
  bool exact = false;
  const Eigen::VectorXd rest = in_the_case(servo, servo.rest_point(exact));
  CHECK(exact);
  CHECK(rest(0) == Approx(0.5));
  CHECK(30.0 * rest(2) == Approx(weight * std::sin(0.5)));  // the integrator carries the weight
  const Eigen::MatrixXd moved = servo.tangent() - servo.A;
  CHECK(moved(1, 0) == Approx(-weight * std::cos(0.5) / 0.25));
}

TEST_CASE("Froude pendulum: a loop refuses clearance and says where it is treated") {
  FroudePendulum p = froude_pendulum(4.0);
  p.clearance = 1e-4;
  const auto broken = validate(parts_of(p));
  REQUIRE(broken);
  CHECK(broken->key == "loop.plant.clearance");
  CHECK(broken->rule.find("limcycle experiment froude-pendulum") != std::string::npos);
}
