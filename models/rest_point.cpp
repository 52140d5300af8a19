#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/loop.hpp"

/// @file
/// Where a loop rests, and the means of an oscillation.

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// Mean output and slope of an element that pulls back; nothing of another.
std::optional<std::pair<double, double>> pull_of(const Element<double>& element, double mean, double swing) {
  return std::visit(
      [&]<class E>(const E& e) -> std::optional<std::pair<double, double>> {
        if constexpr (PullsBack<E>) return std::pair(e.mean_output(mean, swing), e.mean_slope(mean, swing));
        return std::nullopt;
      },
      element);
}

/// What the elements that pull back add to the rates at X, and to the matrix.
struct Pull {
  Eigen::VectorXd force;
  Eigen::MatrixXd slope;
  bool any = false;
};
Pull pull_at(const Loop& loop, const Eigen::VectorXd& X, const Eigen::VectorXd& swings) {
  Pull sum{Eigen::VectorXd::Zero(X.size()), Eigen::MatrixXd::Zero(X.size(), X.size()), false};
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Port& port = loop.ports[i];
    const auto k = static_cast<Index>(i);
    const double input = ((port.C + port.C_delayed) * X + port.c * loop.external).value();
    const auto pull = pull_of(loop.elements[i], input, swings(k));
    if (!pull) continue;
    sum.any = true;
    sum.force += loop.B.col(k) * pull->first;
    sum.slope += loop.B.col(k) * pull->second * (port.C + port.C_delayed);
  }
  return sum;
}

/// Whether X solves matrix X + given + pull = 0 but for rounding.
bool solves(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& X, const Eigen::VectorXd& given,
            const Eigen::VectorXd& pull) {
  const double size = given.norm() + pull.norm() + (matrix.cwiseAbs() * X.cwiseAbs()).norm();
  return (matrix * X + given + pull).norm() <= 1e-12 * size;
}
bool solves(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& X, const Eigen::VectorXd& given) {
  return solves(matrix, X, given, Eigen::VectorXd::Zero(X.size()));
}

/// The solution of matrix X + given = 0 with rows and columns in units (powers of two) in which their largest entries
/// are about 1, so that no row is taken for rounding because of the unit it is written in; empty if there is none.
std::optional<Eigen::VectorXd> solution_in_own_units(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& given) {
  Eigen::MatrixXd scaled = matrix;
  Eigen::VectorXd rows = Eigen::VectorXd::Ones(matrix.rows()), columns = Eigen::VectorXd::Ones(matrix.cols());
  const auto unit = [](double largest) { return largest > 0.0 ? std::exp2(-std::round(std::log2(largest))) : 1.0; };
  for (int sweep = 0; sweep < 3; ++sweep) {
    for (Index i = 0; i < matrix.rows(); ++i) {
      const double by = unit(scaled.row(i).cwiseAbs().maxCoeff());
      scaled.row(i) *= by;
      rows(i) *= by;
    }
    for (Index k = 0; k < matrix.cols(); ++k) {
      const double by = unit(scaled.col(k).cwiseAbs().maxCoeff());
      scaled.col(k) *= by;
      columns(k) *= by;
    }
  }
  const Eigen::VectorXd right = rows.cwiseProduct(given), found = least_squares(scaled, -right);
  if (!solves(scaled, found, right)) return std::nullopt;
  return columns.cwiseProduct(found);
}

/// Of several points of rest, the one at which the elements that do not rub see the least: a servo with a dead zone on
/// its error rests at its reference, wherever the origin is.
void centre(const Loop& loop, Eigen::VectorXd& X) {
  Eigen::MatrixXd inputs(0, loop.states());
  Eigen::VectorXd seen(0);
  bool off = false;
  for (const Port& port : loop.ports) {
    const Row C = port.C + port.C_delayed;
    if (port.rubs || C.isZero(0.0)) continue;
    const double size = C.norm(), input = (C * X + port.c * loop.external).value();
    const double parts = (C.cwiseAbs() * X.cwiseAbs() + port.c.cwiseAbs() * loop.external.cwiseAbs()).value();
    off = off || std::abs(input) > 1e-12 * parts;
    inputs.conservativeResize(inputs.rows() + 1, Eigen::NoChange);
    inputs.bottomRows(1) = C / size;
    seen.conservativeResize(seen.size() + 1);
    seen(seen.size() - 1) = input / size;
  }
  if (!off) return;
  const Eigen::FullPivLU<Eigen::MatrixXd> still(loop.A + loop.A_delayed);
  if (still.dimensionOfKernel() == 0) return;
  const Eigen::MatrixXd free = still.kernel();
  const Eigen::VectorXd moved = X + free * least_squares(inputs * free, -seen);
  if (solves(loop.A + loop.A_delayed, moved, loop.E * loop.external)) X = moved;
}

}  // namespace

Eigen::VectorXd Loop::rest_point(bool& exact) const {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(std::ssize(elements));
  Eigen::VectorXd X = mean_point(none, none, exact);
  if (exact) centre(*this, X);
  return X;
}

/// Newton's method, from the rest point of the tangents at 0. Under a constant torque it comes from below, and the sine
/// bends away from its tangent: every step falls short, so that none leaves the branch near hanging.
Eigen::VectorXd Loop::mean_point(const Eigen::VectorXd& mean_outputs, const Eigen::VectorXd& swings,
                                 bool& exact) const {
  Eigen::VectorXd given = E * external;
  for (Index i = 0; i < mean_outputs.size(); ++i)
    if (!pull_of(elements[static_cast<std::size_t>(i)], 0.0, 0.0)) given += B.col(i) * mean_outputs(i);
  const Eigen::MatrixXd still = A + A_delayed;
  Eigen::VectorXd X = Eigen::VectorXd::Zero(states()), first;
  for (int i = 0; i < 60 && X.allFinite(); ++i) {
    const Pull pull = pull_at(*this, X, swings);
    const Eigen::VectorXd rate = still * X + given + pull.force;
    const Eigen::VectorXd step = least_squares(still + pull.slope, -rate);
    X += step;
    if (i == 0) first = X;
    if (!pull.any || step.norm() <= 1e-15 * X.norm()) break;
  }
  const Pull last = pull_at(*this, X, swings);
  exact = solves(still, X, given, last.force);
  if (exact) return X;
  if (!last.any) {
    const auto other = solution_in_own_units(still, given);
    exact = other.has_value();
    if (other) return *other;
  }
  return first;
}

Eigen::MatrixXd Loop::tangent() const {
  const auto pulls = [](const Element<double>& element) { return pull_of(element, 0.0, 0.0).has_value(); };
  if (std::ranges::none_of(elements, pulls)) return A;
  bool exact = false;
  const Eigen::VectorXd X = rest_point(exact);
  return A + pull_at(*this, X, Eigen::VectorXd::Zero(std::ssize(elements))).slope;
}

}  // namespace limcycle
