#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;

namespace {

Complex at(const StateSpace& g, Complex s) { return g.at(s)(0, 0); }

Complex polynomial(const std::vector<double>& p, Complex s) {
  Complex sum = 0.0;
  for (const double c : p) sum = sum * s + c;
  return sum;
}

}  // namespace

TEST_CASE("realisations have the transfer function they were made from") {
  const std::vector<double> num{2.0, -1.0, 30.0}, den{1e-6, 2e-3, 1.0, 40.0};
  const StateSpace g = realise(num, den);
  for (const double w : {0.01, 1.0, 40.0, 1000.0, 1e5}) {
    const Complex s(0.0, w), expected = polynomial(num, s) / polynomial(den, s);
    CHECK(std::abs(at(g, s) - expected) < 1e-12 * std::abs(expected));
  }
  CHECK(realise(std::vector<double>{0.0, 3.0}, std::vector<double>{0.0, 2.0}).D(0, 0) == 1.5);
  CHECK_THROWS_AS(realise(std::vector<double>{1.0, 0.0, 0.0}, std::vector<double>{1.0, 1.0}), std::invalid_argument);
  CHECK_THROWS_AS(realise(std::vector<double>{1.0}, std::vector<double>{}), std::invalid_argument);
}

TEST_CASE("zeros, poles and gain: pairs, real ones, and a pair of zeros over real poles") {
  const std::vector<Complex> zeros{{-1.0, 5.0}, {-1.0, -5.0}, {3.0, 0.0}};
  const std::vector<Complex> poles{{-1.0, 0.0}, {-2.0, 0.0}, {-0.1, 30.0}, {-0.1, -30.0}, {0.0, 0.0}};
  for (const auto& denominators : {poles, std::vector<Complex>{{-1.0, 0.0}, {-2.0, 0.0}, {-3.0, 0.0}, {-4.0, 0.0}}}) {
    const StateSpace g = realise_zpk(zeros, denominators, 7.0);
    CHECK(g.states() == std::ssize(denominators));
    for (const double w : {0.1, 4.0, 29.0, 500.0}) {
      const Complex s(0.0, w);
      Complex expected = 7.0;
      for (const auto& z : zeros) expected *= s - z;
      for (const auto& p : denominators) expected /= s - p;
      CHECK(std::abs(at(g, s) - expected) < 1e-11 * std::abs(expected));
    }
  }
  CHECK_THROWS_AS(realise_zpk({{-1.0, 5.0}}, poles, 1.0), std::invalid_argument);
}

TEST_CASE("process plants: a lag and a second order with dead time have the response of their formula") {
  const FirstOrder lag{3.0, 2.5, 0.4};
  const double T1 = 0.5, T2 = 8.0, T = std::sqrt(T1 * T2);
  const SecondOrder lags{-2.0, T, (T1 + T2) / (2.0 * T), 1.5}, resonance{4.0, 0.1, 0.05};
  for (const double w : {0.01, 1.0, 20.0}) {
    const Complex s(0.0, w);
    const auto response = [&](const PlantModel& plant) {
      return at(StateSpace{plant.A, plant.B_u, plant.C_y, Eigen::MatrixXd::Zero(1, 1)}, s);
    };
    const auto near = [](Complex found, Complex expected) { return std::abs(found / expected - 1.0) < 1e-13; };
    CHECK(near(response(lag.model()), 3.0 / (2.5 * s + 1.0)));
    CHECK(near(response(lags.model()), -2.0 / ((T1 * s + 1.0) * (T2 * s + 1.0))));
    CHECK(near(response(resonance.model()), 4.0 / (0.01 * s * s + 0.01 * s + 1.0)));
  }
  CHECK(lag.model().delay == 0.4);
  CHECK(lags.model().delay == 1.5);
  CHECK(resonance.model().delay == 0.0);
  CHECK(lag.model().state_names.size() == 1);
}

TEST_CASE("servo: response from friction to position is s/(s^3 + 6 s^2 + 3 s + 4) with the sign of the Lur'e form") {
  const Loop loop = servo(lugre());
  for (const double w : {0.05, 1.0, 30.0}) {
    const Complex s(0.0, w), G = s / (s * s * s + 6.0 * s * s + 3.0 * s + 4.0);
    CHECK(std::abs(loop.element_response(w)(0, 0) + G) < 1e-13);
    CHECK(std::abs(loop.output_response(w)(0) + G) < 1e-13);
  }
  CHECK(loop.state_names == std::vector<std::string>{"y", "v", "I"});
}

TEST_CASE("controllers: filtered derivative, transfer function, lag and saturation are where they should be") {
  Pid filtered = pid(3.0, 4.0, 6.0);
  filtered.tf = 0.01;
  filtered.lag = 0.02;
  auto parts = servo_parts(coulomb(1.0, 1.0));
  parts.controller = filtered;
  const Complex s(0.0, 7.0);
  const Complex C = (3.0 + 4.0 / s + 6.0 * s / (0.01 * s + 1.0)) / (0.02 * s + 1.0);
  const Complex expected = -1.0 / (s * s + C);
  CHECK(std::abs(build_loop(parts).element_response(7.0)(0, 0) - expected) < 1e-13);

  TransferFunctionController same;
  same.numerator = {0.01 * 3.0 + 6.0, 3.0 + 0.04, 4.0};
  same.denominator = {0.01, 1.0, 0.0};
  same.lag = 0.02;
  parts.controller = same;
  CHECK(std::abs(build_loop(parts).element_response(7.0)(0, 0) - expected) < 1e-13);

  filtered.saturation = 2.0;
  parts.controller = filtered;
  const Loop saturated = build_loop(parts);
  REQUIRE(saturated.elements.size() == 2);
  CHECK(saturated.ports[0].path == "loop.controller.saturation");
  // Closing the saturation with gain 1 gives the loop without it.
  const auto H = saturated.element_response(7.0);
  CHECK(std::abs(H(1, 1) + H(1, 0) * H(0, 1) / (1.0 - H(0, 0)) - expected) < 1e-12);
}

TEST_CASE("delay is exact in the frequency domain") {
  LoopParts parts;
  parts.plant = TransferFunction{{2.0}, {1.0, 1.0}, 0.3};
  parts.element = relay(1.0);
  const Complex s(0.0, 4.0);
  CHECK(std::abs(build_loop(parts).element_response(4.0)(0, 0) + 2.0 * std::exp(-0.3 * s) / (s + 1.0)) < 1e-14);
}

TEST_CASE("two masses: response to friction at the load against the hand-made matrix") {
  TwoMass plant;
  plant.motor_mass = 0.5;
  plant.load_mass = 2.0;
  plant.stiffness = 300.0;
  plant.damping = 0.7;
  plant.friction_on.index = 1;
  LoopParts parts;
  parts.plant = plant;
  parts.controller = pid(10.0, 0.0, 3.0);
  parts.friction = coulomb(1.0, 1.0);
  const Complex s(0.0, 9.0), k = 300.0 + 0.7 * s, C = 10.0 + 3.0 * s;
  Eigen::Matrix2cd M;
  M << 0.5 * s * s + k, -k + C, -k, 2.0 * s * s + k;
  const Eigen::Vector2cd y = M.partialPivLu().solve(Eigen::Vector2cd(0.0, -1.0));
  CHECK(std::abs(build_loop(parts).element_response(9.0)(0, 0) - y(1)) < 1e-13);
}

TEST_CASE("combinations that make no loop are refused with their reason") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  REQUIRE(validate(parts));
  CHECK(validate(parts)->key == "loop");
  parts.friction = coulomb(1.0, 1.0);
  CHECK_FALSE(validate(parts));
  parts.plant = TransferFunction{{1.0, 2.0}, {1.0, 1.0, 1.0}, 0.0};
  CHECK(validate(parts)->key == "loop.plant");  // relative degree 1 with friction
  parts.friction.reset();
  parts.element = relay(1.0);
  CHECK_FALSE(validate(parts));
  parts.controller = pid(1.0, 0.0, 1.0);
  CHECK(validate(parts)->key == "loop.controller.tf");
  CHECK_THROWS_AS(build_loop(parts), std::invalid_argument);
}

TEST_CASE("a ramp reference moves the loop along: the friction rubs at the rate of the ramp") {
  auto parts = servo_parts(lugre());
  parts.reference_rate = 0.02;
  const Loop loop = build_loop(parts);
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  CHECK(exact);
  CHECK((loop.ports[0].C_v * rest + loop.ports[0].c_v * loop.external).value() == Approx(0.02));
  CHECK(loop.ramp_output_rate == Approx(0.02));
  parts.controller = NoController{};
  parts.plant = Mass{1.0, 0.0, 5.0};
  CHECK_FALSE(validate(parts));  // the reference is not used at all: rest
}
