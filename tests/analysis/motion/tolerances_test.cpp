#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"

#include <catch2/catch.hpp>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;

TEST_CASE("moduli of the poles: sorted, complex ones by their natural frequency, those at the origin left out") {
  // s^2 (s + 7) (s^2 + 2 s + 25): 0, 0, -7, -1 +- j sqrt(24).
  const auto moduli = pole_moduli(test::forward(test::relay(1.0), {1.0}, {1.0, 9.0, 39.0, 175.0, 0.0, 0.0}));
  REQUIRE(moduli.size() == 3);
  CHECK(moduli[0] == Approx(5.0).epsilon(1e-12));
  CHECK(moduli[1] == Approx(5.0).epsilon(1e-12));
  CHECK(moduli[2] == Approx(7.0).epsilon(1e-12));
  CHECK(pole_moduli(test::forward(test::relay(1.0), {1.0}, {1.0, 0.0})).empty());
}

TEST_CASE("moduli of the poles: those at the origin are left out whatever their order") {
  // s^k (s + 7) (s^2 + 2 s + 2500): the k poles are computed as small ones, of the kth root of rounding.
  std::vector<double> denominator{1.0, 9.0, 2514.0, 17500.0};
  for (int k = 1; k <= 4; ++k) {
    denominator.push_back(0.0);
    CAPTURE(k);
    const auto moduli = pole_moduli(test::forward(test::relay(1.0), {1.0}, denominator));
    REQUIRE(moduli.size() == 3);
    CHECK(moduli[0] == Approx(7.0).epsilon(1e-9));
    CHECK(moduli[2] == Approx(50.0).epsilon(1e-9));
  }
  // A pole that is slow, though not at the origin, stays.
  CHECK(pole_moduli(test::forward(test::relay(1.0), {1.0}, {1.0, 100.0001, 0.01, 0.0})).front() ==
        Approx(1e-4).epsilon(1e-6));
}

TEST_CASE("moduli of the poles: a part of the plant that nothing sees has none, however slow or fast it is") {
  for (const double pole : {-1e-3, -1.0, -1e4}) {
    LoopParts parts = test::servo_parts(test::coulomb(1.5, 1.0));
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
    A(0, 1) = 1.0;
    A(2, 2) = pole;
    A(2, 0) = 0.7;  // driven by the position, but seen by nobody
    StateSpacePlant plant;
    plant.A = A;
    plant.B = plant.B_friction = Eigen::Vector3d(0.0, 1.0, 0.0);
    plant.C = Eigen::RowVector3d(1.0, 0.0, 0.0);
    plant.C_velocity = Eigen::RowVector3d(0.0, 1.0, 0.0);
    parts.plant = plant;
    const auto with = pole_moduli(build_loop(parts)), without = pole_moduli(test::servo(test::coulomb(1.5, 1.0)));
    CAPTURE(pole);
    REQUIRE(with.size() == without.size());
    for (std::size_t i = 0; i < with.size(); ++i) CHECK(with[i] == Approx(without[i]).epsilon(1e-9));
  }
}

TEST_CASE("rtol out of range is refused with its value") {
  const Loop loop = test::servo(test::coulomb(1.5, 1.0));
  CHECK_THROWS_WITH(loop_weights(loop, 0.2), Catch::Matchers::Contains("0.2"));
  CHECK_THROWS_AS(loop_weights(loop, 0.0), std::invalid_argument);
}
