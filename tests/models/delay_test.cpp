#include "limcycle/models/delay.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/with_memory/delayed_relay.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;
using Eigen::Index;

namespace {

/// sum_k (2m - k)! m!/((2m)! k! (m - k)!) x^k: the denominator of the diagonal approximation of exp(-x).
Complex denominator(int m, Complex x) {
  Complex sum = 0.0, power = 1.0;
  double c = 1.0;
  for (int k = 0; k <= m; ++k) {
    sum += c * power;
    power *= x;
    c *= static_cast<double>(m - k) / (static_cast<double>(2 * m - k) * (k + 1));
  }
  return sum;
}

Complex pade(int m, Complex x) { return denominator(m, -x) / denominator(m, x); }

LoopParts delayed_servo(double delay, Element friction) {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {2.0, 0.3, 5.0}, delay};
  Pid controller = pid(3.0, 4.0, 6.0);
  parts.controller = controller;
  parts.friction = std::move(friction);
  return parts;
}

/// Rates of the inputs must be those of the signals: s X = A X + B w, v = C_v X + D_v w against s (C X + D w).
void check_rates(const Loop& loop) {
  const Complex s(0.3, 2.0);
  const Index n = loop.states();
  const Eigen::MatrixXcd resolvent = s * Eigen::MatrixXcd::Identity(n, n) - loop.A.cast<Complex>(),
                         X = solve_columns(resolvent, loop.B.cast<Complex>());
  for (const auto& port : loop.ports) {
    if (!port.D.isZero(0.0)) continue;
    const Eigen::RowVectorXcd input = port.C.cast<Complex>() * X,
                              rate = port.C_v.cast<Complex>() * X + port.D_v.cast<Complex>();
    CHECK((rate - s * input).norm() < 1e-10 * (1.0 + rate.norm()));
  }
}

}  // namespace

TEST_CASE("Pade: the ladder is the textbook quotient of polynomials") {
  for (int m = 1; m <= 12; ++m) {
    const StateSpace ladder = pade_delay(0.4, m);
    CHECK(ladder.states() == m);
    for (const Complex s : {Complex(0.0, 0.3), Complex(0.0, 9.0), Complex(1.0, 30.0), Complex(-1.5, 4.0)}) {
      const Complex expected = pade(m, 0.4 * s);
      CHECK(std::abs(ladder.at(s)(0, 0) - expected) < 1e-12 * std::abs(expected));
    }
  }
  const Complex x(0.0, 1.7);
  CHECK(std::abs(pade_delay(1.0, 1).at(x)(0, 0) - (2.0 - x) / (2.0 + x)) < 1e-15);
  CHECK(std::abs(pade_delay(1.0, 2).at(x)(0, 0) - (12.0 - 6.0 * x + x * x) / (12.0 + 6.0 * x + x * x)) < 1e-15);
}

TEST_CASE("Pade: all-pass, stable and balanced at every order") {
  for (int m = 1; m <= highest_pade_order; ++m) {
    const double L = 0.05;
    const StateSpace p = pade_delay(L, m);
    const double size = p.A.norm();
    CHECK((p.A + p.A.transpose() + p.C.transpose() * p.C / L).norm() < 1e-14 * size);
    CHECK((p.B + p.C.transpose() * p.D / L).norm() < 1e-14 * p.B.norm());
    CHECK(eigenvalues(p.A).real().maxCoeff() < 0.0);
    CHECK(std::abs(p.at(0.0)(0, 0) - 1.0) < 1e-12);
    for (const double w : {1.0, 50.0, 700.0, 1e5}) {
      CHECK(std::abs(std::abs(p.at({0.0, w})(0, 0)) - 1.0) < 1e-11);
      CHECK(std::abs(std::abs(p.at({0.0, w})(0, 0) - std::exp(Complex(0.0, -w * L))) - pade_error(w, L, m)) < 1e-11);
    }
  }
}

TEST_CASE("Pade: order 2m + 1 with the constant of the theory") {
  const double expected[] = {0.0, 1.0 / 12.0, 1.0 / 720.0, 1.0 / 100800.0, 1.0 / 25401600.0};
  for (int m = 1; m <= 4; ++m) {
    const double turn = m < 3 ? 0.05 : 0.3, order = 2.0 * m + 1.0;
    CHECK(pade_error(turn, 1.0, m) / std::pow(turn, order) == Approx(expected[m]).epsilon(5e-3));
    CHECK(std::log2(pade_error(2.0 * turn, 1.0, m) / pade_error(turn, 1.0, m)) == Approx(order).epsilon(3e-3));
  }
  CHECK(pade_error(0.7, 2.0, 1) == Approx(2.0 * std::abs(std::sin(0.7 - std::atan(0.7)))));
  CHECK(pade_error(-0.7, 2.0, 1) == pade_error(0.7, 2.0, 1));
  CHECK(pade_error(0.0, 1.0, 3) == 0.0);
  CHECK(pade_error(70.0, 1.0, highest_pade_order) < 1e-13);
  CHECK(pade_error(std::sqrt(12.0), 1.0, 2) == Approx(std::abs(std::exp(Complex(0.0, -std::sqrt(12.0))) + 1.0)));
}

TEST_CASE("Pade: what cannot be approximated is refused with its value") {
  CHECK_THROWS_WITH(pade_delay(1.0, 0), "order of the Pade approximation of a delay = 0: must be 1..60");
  CHECK_THROWS_AS(pade_delay(1.0, 61), std::invalid_argument);
  CHECK_THROWS_AS(pade_delay(0.0, 3), std::invalid_argument);
  CHECK_THROWS_AS(pade_delay(infinite, 3), std::invalid_argument);
  CHECK_THROWS_AS(pade_error(infinite, 1.0, 3), std::invalid_argument);
  CHECK_THROWS_AS(pade_error(1.0, -1.0, 3), std::invalid_argument);
}

TEST_CASE("a loop without delay, or that does not use it, is its own time-domain form") {
  const Loop loop = servo(lugre());
  const TimeDomainLoop same = in_time_domain(loop, 0);
  CHECK(same.pade_order == 0);
  CHECK(same.loop.A == loop.A);
  CHECK(same.loop.ports[0].C_v == loop.ports[0].C_v);
  auto parts = delayed_servo(0.2, coulomb(1.0, 1.0));
  parts.controller = NoController{};
  const TimeDomainLoop unused = in_time_domain(build_loop(parts), 0);
  CHECK(unused.pade_order == 0);
  CHECK(unused.loop.delay == 0.0);
  CHECK(unused.loop.states() == 2);
}

TEST_CASE("delayed loop: the frequency response with exp(-s delay) replaced by its approximation") {
  const double L = 0.2;
  const Loop exact = build_loop(delayed_servo(L, lugre()));
  for (const int m : {1, 2, 5, 8}) {
    const TimeDomainLoop t = in_time_domain(exact, m);
    CHECK(t.pade_order == m);
    CHECK(t.loop.delay == 0.0);
    CHECK(t.delay_states == 2 * m);  // the controller reads y and its rate late
    CHECK(t.loop.states() == exact.states() + 2 * m);
    CHECK(std::ssize(t.loop.state_names) == t.loop.states());
    CHECK(t.loop.state_names.back() == "delay" + std::to_string(2 * m));
    for (const double w : {0.1, 1.0, 7.0, 40.0}) {
      const Complex s(0.0, w), C = 3.0 + 4.0 / s + 6.0 * s, G = 1.0 / (2.0 * s * s + 0.3 * s + 5.0);
      const Complex expected = -G / (1.0 + G * C * pade(m, L * s)), with_delay = -G / (1.0 + G * C * std::exp(-L * s));
      CHECK(std::abs(t.loop.element_response(w)(0, 0) - expected) < 1e-11 * std::abs(expected));
      CHECK(std::abs(t.loop.output_response(w)(0) - expected) < 1e-11 * std::abs(expected));
      CHECK(std::abs(exact.element_response(w)(0, 0) - with_delay) < 1e-12 * std::abs(with_delay));
      // The error of the response is that of the approximation, times the sensitivity to it.
      const double bound = std::abs(expected * with_delay * C) * pade_error(w, L, m) + 1e-11 * std::abs(expected);
      CHECK(std::abs(t.loop.element_response(w)(0, 0) - exact.element_response(w)(0, 0)) <= 1.0000001 * bound);
    }
    check_rates(t.loop);
  }
}

TEST_CASE("delayed loop: saturation, element on the error and its rate read the late signal") {
  const double L = 0.15;
  auto parts = delayed_servo(L, coulomb(1.5, 1.0));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 20.0;
  parts.controller = controller;
  DeadZone<double> dead_zone;
  dead_zone.half_width = 0.01;
  parts.error = dead_zone;
  const Loop exact = build_loop(parts);
  REQUIRE(exact.elements.size() == 4);
  const TimeDomainLoop t = in_time_domain(exact, 6);
  CHECK(t.delay_states == 6);  // only y is read late
  const Complex s(0.0, 3.0);
  const Complex G = 1.0 / (2.0 * s * s + 0.3 * s + 5.0), C = 3.0 + 4.0 / s, P = pade(6, L * s);
  Eigen::Matrix4cd H;  // error, its rate, saturation, friction
  H << 0.0, 0.0, -P * G, P * G, 0.0, 0.0, -P * G, P * G, C, 6.0, 0.0, 0.0, 0.0, 0.0, G, -G;
  CHECK((t.loop.element_response(3.0) - H).norm() < 1e-12 * H.norm());
  check_rates(t.loop);
  CHECK(t.loop.ports[1].D_v.isZero(0.0));
  CHECK(t.loop.ports[3].C_v.tail(6).isZero(0.0));
  CHECK(t.loop.ports[3].C_v.head(3) == exact.ports[3].C_v);
}

TEST_CASE("delayed loop: states with a constant history put out what is read now") {
  const TimeDomainLoop t = in_time_domain(build_loop(delayed_servo(0.2, lugre())), 7);
  const Eigen::Vector3d X(0.4, -0.3, 2.0);
  const Eigen::VectorXd all = with_constant_history(t, X);
  CHECK(all.head(3) == X);
  CHECK((t.loop.A * all).tail(t.delay_states).norm() < 1e-10);
  const Loop undelayed = build_loop(delayed_servo(0.0, lugre()));
  CHECK(((t.loop.A * all).head(3) - undelayed.A * X).norm() < 1e-11);
  CHECK_THROWS_AS(with_constant_history(t, all), std::invalid_argument);
}

TEST_CASE("a relay takes over the delay of the plant: exact") {
  LoopParts parts;
  parts.plant = TransferFunction{{2.0, 1.0}, {1.0, 3.0, 3.0, 1.0}, 0.3};
  Pid controller = pid(2.0, 1.0, 0.5);
  controller.tf = 0.1;
  controller.lag = 0.05;
  parts.controller = controller;
  parts.element = relay(1.5, 0.1, 0.2);
  const Loop exact = build_loop(parts);
  const TimeDomainLoop t = in_time_domain(exact, 0);
  CHECK(t.pade_order == 0);
  CHECK(t.delay_states == 0);
  CHECK(t.loop.delay == 0.0);
  CHECK(t.loop.states() == exact.states());
  const auto& delayed = law_of<DelayedRelay<double>>(t.loop.elements[0]);
  CHECK(delayed.level == 1.5);
  CHECK(delayed.hysteresis == 0.1);
  CHECK(delayed.dead_zone == 0.2);
  CHECK(delayed.delay == 0.3);
  for (const double w : {0.2, 3.0, 20.0}) {
    const Complex late = std::exp(Complex(0.0, -0.3 * w)), H = exact.element_response(w)(0, 0);
    CHECK(std::abs(late * t.loop.element_response(w)(0, 0) - H) < 1e-13 * std::abs(H));
  }
  check_rates(t.loop);
}

TEST_CASE("a relay between saturation and friction takes over the delay too, not with compensation") {
  LoopParts parts = delayed_servo(0.2, coulomb(1.5, 1.0));
  Pid controller = pid(3.0, 4.0, 0.0);
  controller.saturation = 2.0;
  parts.controller = controller;
  parts.element = relay(4.0);
  const Loop exact = build_loop(parts);
  const TimeDomainLoop t = in_time_domain(exact, 0);
  REQUIRE((t.loop.elements[1].as<DelayedRelay<double>>() != nullptr));
  const Complex s(0.0, 2.5), G = 1.0 / (2.0 * s * s + 0.3 * s + 5.0), C = 3.0 + 4.0 / s;
  Eigen::Matrix3cd H;  // saturation, relay (whose output is late), friction
  H << 0.0, -C * G, C * G, 1.0, 0.0, 0.0, 0.0, G, -G;
  CHECK((t.loop.element_response(2.5) - H).norm() < 1e-13 * H.norm());
  controller.friction_compensation = 1.0;
  parts.controller = controller;
  CHECK(in_time_domain(build_loop(parts), 4).pade_order == 4);
  CHECK_THROWS_AS(in_time_domain(build_loop(parts), 0), std::invalid_argument);
}

TEST_CASE("an element that needs the rate of a late signal of relative degree 1 is refused with its reason") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0}, 0.5};
  parts.element = lugre();
  const Loop loop = build_loop(parts);
  CHECK_THROWS_WITH(in_time_domain(loop, 3), Catch::Contains("loop.plant.delay: loop.element needs the rate"));
  NoController controller;
  controller.lag = 0.01;
  parts.controller = controller;
  check_rates(in_time_domain(build_loop(parts), 3).loop);
}
