#include "limcycle/models/linear/integral_action.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/linear/dense.hpp"

using namespace limcycle;

namespace {

std::complex<double> value_at(const Rational& of, std::complex<double> s) {
  std::complex<double> above = 0.0, below = 0.0;
  for (const double one : of.numerator) above = above * s + one;
  for (const double one : of.denominator) below = below * s + one;
  return above / below;
}

/// The same system in other states: a matrix without structure, and one state that nothing reads.
StateSpace rewritten(const StateSpace& of) {
  const Eigen::Index n = of.states() + 1;
  StateSpace more{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Ones(n, 1), Eigen::MatrixXd::Zero(1, n), of.D};
  more.A.topLeftCorner(n - 1, n - 1) = of.A;
  more.A(n - 1, n - 1) = -0.3;
  more.B.topRows(n - 1) = of.B;
  more.C.leftCols(n - 1) = of.C;
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) T(i, k) += 0.4 * std::sin(3.0 * double(i) + 1.7 * double(k));
  const Eigen::MatrixXd back = solve_columns(T, Eigen::MatrixXd::Identity(n, n));
  return {T * more.A * back, T * more.B, more.C * back, more.D};
}

}  // namespace

TEST_CASE("integral action: taken from a PID, a PI behind a lag and a double integrator, in polynomials") {
  const auto pd = without_integral_action({{6.0, 3.0, 4.0}, {1.0, 0.0}});
  REQUIRE(pd);
  CHECK(pd->numerator == std::vector<double>{6.0, 3.0});
  CHECK(pd->denominator == std::vector<double>{1.0});
  const auto lag = without_integral_action({{12500.0, 12500.0}, {1.0, 0.5, 0.0}});
  REQUIRE(lag);
  CHECK(lag->numerator == std::vector<double>{12500.0});
  CHECK(lag->denominator == std::vector<double>{1.0, 0.5});
  const auto twice = without_integral_action({{2.0, 3.0, 4.0}, {1.0, 0.0, 0.0}});
  REQUIRE(twice);
  CHECK(twice->numerator == std::vector<double>{2.0});
  CHECK(twice->denominator == std::vector<double>{1.0});
  const auto nothing = without_integral_action({{4.0}, {1.0, 0.0}});
  REQUIRE(nothing);
  CHECK(nothing->numerator == std::vector<double>{0.0});
  CHECK_FALSE(without_integral_action({{1.0, 2.0}, {1.0, 3.0}}));
  CHECK_FALSE(without_integral_action({{1.0}, {1.0}}));
}

TEST_CASE("integral action: polynomials of a state space in any states and units are its transfer function") {
  const std::vector<double> cases[][2] = {{{6.0, 3.0, 4.0}, {0.01, 1.0, 0.0}},
                                          {{12500.0, 12500.0}, {1.0, 0.5, 0.0}},
                                          {{2.0, 3.0, 4.0, 1.0}, {1.0, 0.7, 0.0, 0.0}},
                                          {{1.0, 2.0}, {1.0, 3.0, 7.0}},
                                          {{2.0, 1e3, 4e7}, {1.0, 2e4, 0.0}}};
  for (const auto& [numerator, denominator] : cases) {
    const StateSpace own = realise(numerator, denominator);
    for (const StateSpace& of : {own, rewritten(own)}) {
      const Rational found = rational_of(of);
      REQUIRE(found.denominator.size() == denominator.size());
      const auto rest = without_integral_action(found), exact = without_integral_action({numerator, denominator});
      REQUIRE(rest.has_value() == exact.has_value());
      for (const double w : {0.03, 1.0, 400.0}) {
        const std::complex<double> s(0.0, w);
        CHECK(std::abs(value_at(found, s) / of.at(s)(0, 0) - 1.0) < 1e-7);
        if (rest) CHECK(std::abs(value_at(*rest, s) / value_at(*exact, s) - 1.0) < 1e-7);
      }
    }
  }
}
