#include "limcycle/analysis/motion/field/loop_field.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Largest difference between the exact Jacobian and central differences of the field, relative to the column's size.
double jacobian_error(LoopField& field, const State& x, const State& steps) {
  Eigen::MatrixXd J;
  State dfdt, plus, minus;
  field.jacobian(x, J, 0.3, dfdt);
  double worst = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    State moved = x;
    moved[k] = x[k] + steps[k];
    field.rate(moved, plus, 0.3);
    moved[k] = x[k] - steps[k];
    field.rate(moved, minus, 0.3);
    const auto column = J.col(static_cast<Eigen::Index>(k));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double difference = (plus[i] - minus[i]) / (2.0 * steps[k]);
      worst = std::max(
          worst, std::abs(difference - column(static_cast<Eigen::Index>(i))) / (1.0 + column.cwiseAbs().maxCoeff()));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("field of the servo is its equations of motion, written out") {
  const auto law = lugre();
  const Loop loop = servo(law);
  LoopField field(loop);
  const double y = 0.03, v = -0.02, I = 0.4, z = -7e-6;
  State dx;
  field.rate({y, v, I, z}, dx, 0.0);
  const double dz = v - law.sigma0 * std::abs(v) * z / law.level(v);
  const double F = law.sigma0 * z + law.sigma1 * dz + law.sigma2 * v;
  CHECK(dx[0] == v);
  CHECK(dx[1] == Approx(-3.0 * y - 6.0 * v + 4.0 * I - F));
  CHECK(dx[2] == Approx(-y));
  CHECK(dx[3] == Approx(dz));
  CHECK(field.output(0) == Approx(F));
}

TEST_CASE("exact Jacobian agrees with differences: bristle, static curve, stick, two elements") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const Loop bristle = servo(lugre());
    LoopField field(bristle);
    const double v = (u(random) > 0 ? 1 : -1) * std::pow(10.0, -5.0 + 3.0 * std::abs(u(random)));
    CHECK(jacobian_error(field, {0.1 * u(random), v, u(random), 1e-5 * u(random)},
                         {1e-6, 1e-4 * std::abs(v), 1e-6, 1e-10}) < 1e-6);

    auto parts = servo_parts(stribeck(1.5, 1.0, 0.05));
    auto limited = pid(3.0, 4.0, 6.0);
    limited.saturation = 2.0;
    limited.lag = 0.1;
    parts.controller = limited;
    const Loop two = build_loop(parts);
    LoopField both(two);
    State x{u(random), 0.1 * std::abs(u(random)) + 1e-3, u(random), u(random)};
    both.start(x, 0.0);
    CHECK(jacobian_error(both, x, {1e-6, 1e-7, 1e-6, 1e-6}) < 1e-6);
    State rest{0.02 * u(random), 0.0, 0.1 * u(random), 0.1 * u(random)};
    both.start(rest, 0.0);
    CHECK(both.modes()[1] == Mode{0});
    CHECK(jacobian_error(both, rest, {1e-6, 1e-7, 1e-6, 1e-6}) < 1e-6);
  }
}

TEST_CASE("exact Jacobian agrees with differences where a compensation follows the friction") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int stuck = 0, sliding = 0, saturated = 0;
  for (int i = 0; i < 120; ++i) {
    const bool lags = i % 2 == 1, limited = i % 3 == 2;
    auto parts = servo_parts(i % 4 < 2 ? Element(coulomb(1.5, 1.0, 0.4)) : stribeck(1.5, 1.0, 0.05));
    auto controller = pid(3.0, 4.0, 6.0);
    controller.friction_compensation = 0.7;
    if (lags) controller.lag = 0.05;
    if (limited) controller.saturation = 1.0;
    parts.controller = controller;
    const Loop loop = build_loop(parts);
    const auto v = static_cast<std::size_t>(std::ranges::find(loop.state_names, "v") - loop.state_names.begin());
    const std::size_t friction = loop.elements.size() - 1;
    LoopField field(loop);
    State x(field.size());
    for (auto& value : x) value = 0.2 * u(random);
    if (i % 5 < 2) x[v] = 0.0;
    if (x[v] != 0.0) x[v] += std::copysign(0.01, x[v]);
    field.start(x, 0.0);
    (field.modes()[friction] == Mode{0} ? stuck : sliding) += 1;
    for (std::size_t e = 0; e < loop.elements.size(); ++e)
      if (loop.ports[e].path == "loop.controller.saturation" && field.modes()[e] != Mode{0}) ++saturated;
    CAPTURE(i, lags, limited);
    CHECK(jacobian_error(field, x, State(x.size(), 1e-7)) < 1e-6);
  }
  CHECK(stuck > 20);
  CHECK(sliding > 20);
  CHECK(saturated > 5);
}

TEST_CASE("stuck: velocity has no rate, friction equals the drive") {
  const Loop loop = servo(coulomb(1.5, 1.0));
  LoopField field(loop);
  State x{0.1, 0.0, 0.2}, dx;
  field.start(x, 0.0);
  field.rate(x, dx, 0.0);
  CHECK(dx[1] == Approx(0.0).margin(1e-15));
  CHECK(field.output(0) == Approx(-0.3 + 0.8));
  CHECK(field.guard_count() == 2);
  std::vector<double> g;
  field.guards(x, 0.0, g);
  CHECK(g[0] == Approx(1.0));
  CHECK(g[1] == Approx(2.0));
}

TEST_CASE("an ideal relay before a first-order plant can be held at zero input, before a third-order one it cannot") {
  const Loop first = forward(relay(1.0), {1.0}, {1.0, -0.5});  // unstable pole: sliding needs u = 0.5 x = 0
  LoopField field(first);
  State x{0.0};
  field.start(x, 0.0);
  CHECK(field.modes()[0] == Mode{2});
  const Loop third = forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0});
  LoopField other(third);
  State origin{0.0, 0.0, 0.0};
  other.start(origin, 0.0);
  CHECK(other.modes()[0] != Mode{2});
}

TEST_CASE("a body that sticks does not creep: the rate of its velocity is exactly zero, whatever holds it") {
  // Forces of 1e3 N that balance leave 1e-13 N of rounding, which moves 1 kg by metres in 1e7 s.
  for (const auto& law : {Element(coulomb(1e4, 1e3)), Element(stribeck(1e4, 1e3, 1e-3))}) {
    LoopParts parts = servo_parts(law);
    parts.plant = Mass{0.37, 0.0, 0.0};
    const Loop loop = build_loop(parts);
    LoopField field(loop);
    for (int i = 1; i < 50; ++i) {
      State x{0.1 * i, 0.0, 31.7 / i}, dx;
      field.start(x, 0.0);
      REQUIRE(field.holds(loop.elements.size() - 1));
      field.rate(x, dx, 0.0);
      CHECK(dx[1] == 0.0);
    }
  }
}
