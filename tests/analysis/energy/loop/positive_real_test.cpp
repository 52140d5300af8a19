#include "limcycle/analysis/energy/loop/positive_real.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "limcycle/models/linear/dense.hpp"

using namespace limcycle;

namespace {

StateSpace ratio(const std::vector<double>& numerator, const std::vector<double>& denominator) {
  return realise(numerator, denominator);
}

/// Lowest Re H on a grid that is refined about its lowest point.
double by_sweep(const StateSpace& H, double from, double to) {
  double low = std::log(from), high = std::log(to), best = H.at({0.0, from})(0, 0).real();
  for (int level = 0; level < 8; ++level) {
    const int steps = level == 0 ? 20000 : 200;
    double at = low;
    for (int i = 0; i <= steps; ++i) {
      const double w = low + (high - low) * i / steps, value = H.at({0.0, std::exp(w)})(0, 0).real();
      if (value < best) {
        best = value;
        at = w;
      }
    }
    const double width = 2.0 * (high - low) / steps;
    low = at - width;
    high = at + width;
  }
  return best;
}

}  // namespace

TEST_CASE("least real part: closed forms") {
  const RealPart two_lags(ratio({1.0}, {1.0, 2.0, 1.0}));  // (1 - w^2)/(1 + w^2)^2
  CHECK(two_lags.least().value == Approx(-0.125).epsilon(1e-9));
  CHECK(two_lags.least().frequency == Approx(std::sqrt(3.0)).epsilon(1e-4));

  const RealPart lag(ratio({5.0}, {0.01, 1.0}));  // 5/(1 + (w/100)^2): above 0, which is its limit
  CHECK(lag.least().value == 0.0);
  CHECK(std::isinf(lag.least().frequency));
  CHECK(lag.above(0.0) == Decision::yes);
  CHECK(lag.above(1e-9) == Decision::no);

  const RealPart lead(ratio({1.0, 0.0}, {1.0, 1.0}));  // w^2/(1 + w^2): its limit at 0
  CHECK(std::abs(lead.least().value) < 1e-12);
  CHECK(lead.above(0.0) == Decision::yes);

  const RealPart constant(ratio({6.0, 3.0}, {1.0, 0.0}));  // 6 + 3/s
  CHECK(constant.least().value == 6.0);
  CHECK(constant.above(6.0) == Decision::no);
  CHECK(constant.above(std::nextafter(6.0, 0.0) - 1e-13) == Decision::yes);

  const RealPart integral(ratio({6.0, 3.0, 4.0}, {1.0, 0.0, 0.0}));  // 6 + 3/s + 4/s^2
  CHECK(integral.least().value == -std::numeric_limits<double>::infinity());
}

TEST_CASE("least real part: the same with time scales six decades apart, and hidden modes") {
  // (1/(s + 1)^2 + 1/(s/1e6 + 1)^2): the two dips are independent, to 1e-5.
  StateSpace H = ratio({1.0}, {1.0, 2.0, 1.0});
  const StateSpace fast = ratio({1.0}, {1e-12, 2e-6, 1.0});
  StateSpace sum{Eigen::MatrixXd::Zero(6, 6), Eigen::MatrixXd(6, 1), Eigen::MatrixXd(1, 6), H.D};
  sum.A.topLeftCorner(2, 2) = H.A;
  sum.A.block(2, 2, 2, 2) = fast.A;
  sum.A(4, 4) = 3.0;   // unstable, unobservable
  sum.A(5, 5) = -7.0;  // observable, unreachable
  sum.A(4, 0) = 2.0;
  sum.A(1, 5) = 1.0;
  sum.B << H.B, fast.B, 1.0, 0.0;
  sum.C << H.C, fast.C, 0.0, 1.0;
  const RealPart part(sum);
  CHECK(part.reduced().H.states() == 4);
  REQUIRE(part.reduced().hidden.size() == 2);
  CHECK(part.reduced().hidden.real().maxCoeff() == Approx(3.0).epsilon(1e-9));
  CHECK(part.reduced().hidden.real().minCoeff() == Approx(-7.0).epsilon(1e-9));
  CHECK(part.rightmost_pole() < 0.0);
  CHECK(part.least().value == Approx(-0.125).epsilon(1e-4));
  CHECK(part.least().frequency == Approx(std::sqrt(3.0) * 1e6).epsilon(1e-3));
}

TEST_CASE("least real part: random stable systems against dense sweeps") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Index n = 1 + trial % 6;
    StateSpace H{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, 1), Eigen::MatrixXd(1, n), Eigen::MatrixXd(1, 1)};
    for (auto* M : {&H.A, &H.B, &H.C, &H.D})
      for (double& entry : M->reshaped()) entry = normal(random);
    H.A -=
        (eigenvalues(H.A).real().maxCoeff() + 0.05 + 0.2 * std::abs(normal(random))) * Eigen::MatrixXd::Identity(n, n);
    if (trial % 3 == 0) H.D(0, 0) = 0.0;
    INFO("trial " << trial);
    const RealPart part(H);
    const double swept = std::min({by_sweep(H, 1e-5, 1e5), H.D(0, 0)});
    const double size = std::abs(swept) + std::abs(H.at({0.0, 1.0})(0, 0));
    CHECK(part.least().value <= swept + 1e-9 * size);
    CHECK(part.least().value >= swept - 1e-6 * size);
    CHECK(part.above(part.least().value - 1e-6 * size) == Decision::yes);
    CHECK(part.above(part.least().value + 1e-6 * size) == Decision::no);
    if (part.least().frequency > 0.0 && std::isfinite(part.least().frequency))
      CHECK(part.at(part.least().frequency) == Approx(part.least().value).epsilon(1e-9));
  }
}

TEST_CASE("positive real: what touches zero is left undecided, a hair's breadth away it is not") {
  // Re (s^2 + 1)/(s + 1)^2 = ((1 - w^2)/(1 + w^2))^2
  const auto touching = [](double lift) { return ratio({1.0 + lift, 2.0 * lift, 1.0 + lift}, {1.0, 2.0, 1.0}); };
  CHECK(positive_real(RealPart(touching(0.0))).answer.decision == Decision::undecided);
  CHECK(positive_real(RealPart(touching(1e-7))).answer.decision == Decision::yes);
  CHECK(positive_real(RealPart(touching(-1e-7))).answer.decision == Decision::no);
}

TEST_CASE("positive real: lossless parts, and poles that must not be") {
  const auto decision = [](const StateSpace& H) { return positive_real(RealPart(H)).answer.decision; };
  CHECK(decision(ratio({1.0}, {1.0, 0.0})) == Decision::yes);                            // 1/s
  CHECK(decision(ratio({-1.0}, {1.0, 0.0})) == Decision::no);                            // -1/s
  CHECK(decision(ratio({1.0, 0.0}, {1.0, 0.0, 4.0})) == Decision::yes);                  // s/(s^2 + 4)
  CHECK(decision(ratio({1.0}, {1.0, 0.0, 4.0})) == Decision::no);                        // 1/(s^2 + 4)
  CHECK(decision(ratio({1.0}, {1.0, 0.0, 0.0})) == Decision::no);                        // 1/s^2
  CHECK(decision(ratio({1.0}, {1.0, -1.0})) == Decision::no);                            // unstable
  CHECK(decision(ratio({1.0, 1.0}, {1.0, 0.0})) == Decision::yes);                       // 1 + 1/s
  const auto strict = positive_real(RealPart(ratio({1.0, 1.0, 4.0}, {1.0, 0.0, 4.0})));  // 1 + s/(s^2 + 4)
  CHECK(strict.answer.decision == Decision::yes);
  CHECK(strict.strictly);
  CHECK_FALSE(positive_real(RealPart(ratio({1.0}, {1.0, 0.0}))).strictly);
}

TEST_CASE("zeros and inverse of a transfer function") {
  // (s + 2)(s^2 + s + 5)/((s + 1)^2 (s + 3)(s + 4))
  const StateSpace H = ratio({1.0, 3.0, 7.0, 10.0}, {1.0, 9.0, 27.0, 31.0, 12.0});
  const auto found = zeros(H);
  REQUIRE(found);
  REQUIRE(found->size() == 3);
  for (const std::complex<double> s : *found) CHECK(std::abs((s + 2.0) * (s * s + s + 5.0)) < 1e-11);
  const auto turned = inverse(H);
  REQUIRE(turned);
  CHECK(turned->proper.states() == 3);
  for (const double w : {0.01, 1.0, 30.0}) {
    const std::complex<double> s(0.1, w), expected = 1.0 / H.at(s)(0, 0);
    CHECK(std::abs(turned->slope * s + turned->proper.at(s)(0, 0) - expected) < 1e-10 * std::abs(expected));
  }
  CHECK_FALSE(inverse(ratio({1.0}, {1.0, 2.0, 1.0})));  // relative degree 2
  CHECK(zeros(ratio({1.0}, {1.0, 2.0, 1.0}))->size() == 0);
}
