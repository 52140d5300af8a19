#include "limcycle/analysis/study/balance/quasi_linear.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// m = 1/44.45 kg on Coulomb friction under a PID controller whose command may be limited; the command's loop is a
/// million times as fast as the slowest motions of interest.
Loop fast_servo(double limit) {
  LoopParts parts = servo_parts(coulomb(4.3, 4.3));
  Pid controller = pid(2618.64, 63021.8, 13.6862);
  controller.lag = 2.3e-4;
  controller.saturation = limit;
  parts.controller = controller;
  parts.plant = Mass{.mass = 1.0 / 44.4522};
  return build_loop(parts);
}

Loop behind_dead_time() {
  LoopParts parts;
  parts.plant = TransferFunction{{100.0}, {1.0, 20.0, 0.0}, 2e-3};
  parts.element = relay(1.0);
  return build_loop(parts);
}

double distance(const Eigen::MatrixXcd& one, const Eigen::MatrixXcd& other) {
  return (one - other).norm() / other.norm();
}

}  // namespace

TEST_CASE("quasi-linear response: without gains that of the elements, with them the algebraic one") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (const Loop& loop : {fast_servo(100.0), behind_dead_time()}) {
    const auto ne = std::ssize(loop.elements);
    const Eigen::MatrixXcd I = Eigen::MatrixXcd::Identity(ne, ne);
    for (const double w : {30.0, 300.0, 3000.0}) {
      const Eigen::MatrixXcd H = loop.element_response(w);
      CHECK(distance(quasi_linear_response(loop, Eigen::VectorXcd::Zero(ne), w), H) < 1e-12);
      for (int i = 0; i < 20; ++i) {
        Eigen::VectorXcd gains(ne);
        for (Eigen::Index k = 0; k < ne; ++k) gains(k) = std::complex(part(random), part(random)) / std::abs(H(k, k));
        const Eigen::MatrixXcd algebraic = (I - H * gains.asDiagonal()).inverse() * H;
        CHECK(distance(quasi_linear_response(loop, gains, w), algebraic) < 1e-9);
      }
    }
  }
}

TEST_CASE("balance of two elements: a command that is not limited changes nothing, however slow the oscillation") {
  const Loop free = fast_servo(infinite);
  const FirstHarmonicBalance alone(free);
  for (const double w : {1e-2, 0.1, 1.0, 100.0, 1e4})
    for (const double A : {1e-6, 1e-4, 1e-2}) {
      INFO("A " << A << ", w " << w);
      // The command is the response to the friction, of first harmonic 4 Fc/pi.
      const std::complex<double> s(0.0, w), C = 2618.64 + 63021.8 / s + 13.6862 * s / (1.0 + 2.3e-4 * s);
      const std::complex<double> returned = 44.4522 * C / (s * s);
      const double command = 4.0 / std::numbers::pi * 4.3 * std::abs(returned / (1.0 + returned));
      const Loop limited = fast_servo(3.0 * command);
      REQUIRE(limited.elements.size() == free.elements.size() + 1);
      const std::complex<double> want = alone(A, w, 1e-9), got = FirstHarmonicBalance(limited)(A, w, 1e-9);
      CHECK(std::abs(got - want) < 1e-7 * (1.0 + std::abs(want)));
    }
}
