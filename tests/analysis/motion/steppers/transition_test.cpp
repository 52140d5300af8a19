#include "limcycle/analysis/motion/steppers/transition.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// State and variational matrix together, by the Runge-Kutta method of order 4 in many steps.
void integrate(LoopField& field, State& x, MatrixXd& V, double duration, int steps) {
  const double h = duration / steps;
  const auto size = std::ssize(x);
  State dx, time;
  MatrixXd J;
  const auto slope = [&](const State& at, const MatrixXd& W, State& k, MatrixXd& K) {
    field.rate(at, k, 0.0);
    field.jacobian(at, J, 0.0, time);
    K = J * W;
  };
  const auto shifted = [&](const State& k, double part) {
    State y = x;
    for (Index i = 0; i < size; ++i) y[static_cast<std::size_t>(i)] += part * h * k[static_cast<std::size_t>(i)];
    return y;
  };
  for (int s = 0; s < steps; ++s) {
    State k1, k2, k3, k4;
    MatrixXd K1, K2, K3, K4;
    slope(x, V, k1, K1);
    slope(shifted(k1, 0.5), V + 0.5 * h * K1, k2, K2);
    slope(shifted(k2, 0.5), V + 0.5 * h * K2, k3, K3);
    slope(shifted(k3, 1.0), V + h * K3, k4, K4);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    V += h / 6.0 * (K1 + 2.0 * (K2 + K3) + K4);
  }
}

/// Product of the transitions over `steps` equal steps along the motion from x, minus the variational matrix.
double error_over(const Loop& loop, const State& from, double duration, int steps) {
  LoopField field(loop);
  const auto size = std::ssize(from);
  MatrixXd product = MatrixXd::Identity(size, size), reference = product;
  Step step;
  step.x0 = from;
  for (int i = 0; i < steps; ++i) {
    step.t0 = duration * i / steps;
    step.t1 = duration * (i + 1) / steps;
    step.x1 = step.x0;
    integrate(field, step.x1, reference, duration / steps, 4096 / steps);
    field.rate(step.x0, step.dx0, 0.0);
    field.rate(step.x1, step.dx1, 0.0);
    product = (transition(field, step) * product).eval();
    step.x0 = step.x1;
  }
  return (product - reference).norm();
}

/// Transition over one step of a loop whose Jacobian is constant, from rest.
MatrixXd linear_transition(const Loop& loop, double h, MatrixXd& J) {
  LoopField field(loop);
  field.modes().assign(loop.elements.size(), Mode{1});
  Step step;
  step.t1 = h;
  step.x0.assign(field.size(), 0.0);
  step.x1 = step.x0;
  field.rate(step.x0, step.dx0, 0.0);
  field.rate(step.x1, step.dx1, 0.0);
  State time;
  field.jacobian(step.x0, J, 0.0, time);
  return transition(field, step);
}

}  // namespace

TEST_CASE("transition: order 5 where the Jacobian is constant") {
  const Loop loop = forward(relay(1.0), {1.0}, {1.0, 0.4, 1.2, 0.2});
  const auto error = [&](int steps) {
    MatrixXd J;
    const MatrixXd one = linear_transition(loop, 4.0 / steps, J);
    MatrixXd product = MatrixXd::Identity(3, 3);
    for (int i = 0; i < steps; ++i) product = (one * product).eval();
    return (product - (4.0 * J).exp()).norm();
  };
  for (const int steps : {8, 16, 32}) {
    const double order = std::log2(error(steps) / error(2 * steps));
    CHECK(order > 4.8);
    CHECK(order < 5.3);
  }
}

TEST_CASE("transition: order of the whole along a curved motion, where the cubic between the ends counts too") {
  const Loop loop = van_der_pol(1.0);
  const State from{0.4, 1.1};
  for (const int steps : {32, 64, 128}) {
    const double order = std::log2(error_over(loop, from, 4.0, steps) / error_over(loop, from, 4.0, 2 * steps));
    CHECK(order > 3.7);
    CHECK(order < 5.5);
  }
  CHECK(error_over(loop, from, 4.0, 256) < 1e-6);
}

TEST_CASE("transition: what contracts within a step is gone, whatever the step (L-stable)") {
  // Poles at -1 and -1/a.
  double before = 1.0;
  for (const double a : {1e-3, 1e-6, 1e-9}) {
    MatrixXd J;
    const MatrixXd step = linear_transition(forward(relay(1.0), {1.0}, {a, 1.0 + a, 1.0}), 0.01, J);
    const Eigen::VectorXd sizes = step.eigenvalues().cwiseAbs();
    CHECK(sizes.maxCoeff() == Approx(std::exp(-0.01)).epsilon(1e-6));
    // R(z) tends to 3/|z| (stability function of Radau IIA with three stages), z = -0.01/a.
    CHECK(sizes.minCoeff() < 3.5 * a / 0.01);
    CHECK(sizes.minCoeff() < before);
    before = sizes.minCoeff();
  }
}
