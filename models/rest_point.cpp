#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/loop.hpp"

/// @file
/// Rest point of a loop, and the means of an oscillation.

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// Mean output and slope of an element with a restoring output; empty for any other.
std::optional<std::pair<double, double>> pull_of(const Element& element, double mean, double swing) {
  return element.pull(mean, swing);
}

/// Contribution of the restoring elements to the rates at X, and to the matrix.
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

/// True if X solves matrix X + given + pull = 0 to rounding.
bool solves(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& X, const Eigen::VectorXd& given,
            const Eigen::VectorXd& pull) {
  const double size = given.norm() + pull.norm() + (matrix.cwiseAbs() * X.cwiseAbs()).norm();
  return (matrix * X + given + pull).norm() <= 1e-12 * size;
}
bool solves(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& X, const Eigen::VectorXd& given) {
  return solves(matrix, X, given, Eigen::VectorXd::Zero(X.size()));
}

/// Best solution X of matrix X + given = 0, with rows and columns in units (powers of two) in which their largest
/// entries are about 1, so that the unit of a row cannot make it look like rounding; `exact`: it solves the equation.
Eigen::VectorXd solution_in_own_units(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& given, bool& exact) {
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
  exact = solves(scaled, found, right);
  return columns.cwiseProduct(found);
}

/// A + A_delayed times X, plus E times the external signals, in extended precision.
Eigen::VectorXd pushed(const Loop& loop, const Eigen::VectorXd& X) {
  Eigen::VectorXd out(X.size());
  for (Index i = 0; i < X.size(); ++i) {
    long double sum = 0.0L;
    for (Index k = 0; k < X.size(); ++k)
      sum += (static_cast<long double>(loop.A(i, k)) + loop.A_delayed(i, k)) * static_cast<long double>(X(k));
    for (Index k = 0; k < loop.E.cols(); ++k)
      sum += static_cast<long double>(loop.E(i, k)) * static_cast<long double>(loop.external(k));
    out(i) = static_cast<double>(sum);
  }
  return out;
}

/// Refines each component of X, large or small, to its last digit: a velocity that should be zero is zero, even next to
/// a position of kilometres. A component no larger than its last correction, or a tiny part of its first, was rounding.
void refine(const Loop& loop, Eigen::VectorXd& X) {
  Eigen::VectorXd first, step;
  for (int i = 0; i < 3; ++i) {
    bool exact = false;
    const Pull pull = pull_at(loop, X, Eigen::VectorXd::Zero(std::ssize(loop.elements)));
    step = solution_in_own_units(loop.A + loop.A_delayed + pull.slope, pushed(loop, X) + pull.force, exact);
    if (!step.allFinite()) return;
    if (i == 0) first = step;
    X += step;
  }
  for (Index i = 0; i < X.size(); ++i)
    if (std::abs(X(i)) <= std::max(8.0 * std::abs(step(i)), 1e-6 * std::abs(first(i)))) X(i) = 0.0;
}

/// Of several rest points, selects the one with the smallest inputs of the elements that do not rub: a servo with a
/// dead zone on its error rests at its reference, wherever the origin is.
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
  const Eigen::MatrixXd free = kernel(loop.A + loop.A_delayed);
  if (free.cols() == 0) return;
  const Eigen::VectorXd moved = X + free * least_squares(inputs * free, -seen);
  if (solves(loop.A + loop.A_delayed, moved, loop.E * loop.external)) X = moved;
}

/// True if the inputs of the elements that hold a loop are no larger at its rest point than at zero. A relay that holds
/// a body against its weight keeps it far from the point where it would rest on a soft spring alone.
bool nearer_to_its_elements(const Loop& loop, const Eigen::VectorXd& rest) {
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Port& port = loop.ports[i];
    if (port.rubs || pull_of(loop.elements[i], 0.0, 0.0)) continue;
    const double at_zero = port.c * loop.external, moved = (port.C + port.C_delayed) * rest;
    if (std::abs(at_zero + moved) > std::abs(at_zero) + 1e-12 * std::abs(moved)) return false;
  }
  return true;
}

}  // namespace

Eigen::VectorXd Loop::rest_point(bool& exact) const {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(std::ssize(elements));
  Eigen::VectorXd X = mean_point(none, none, exact);
  if (exact) centre(*this, X);
  if (exact && !X.isZero(0.0)) refine(*this, X);
  return X;
}

/// Newton's method, from the rest point of the tangents at 0. Under a constant torque it approaches from below, and the
/// sine bends away from its tangent: every step falls short, so that none leaves the branch near hanging.
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
    Eigen::VectorXd other = solution_in_own_units(still, given, exact);
    if (exact) return other;
  }
  return first;
}

void Loop::measure_from_rest() {
  bool exact = false;
  const Eigen::VectorXd rest = rest_point(exact);
  if (!exact || rest.isZero(0.0) || !nearer_to_its_elements(*this, rest)) return;
  const auto at_rest = [&](const Row& C, const Eigen::RowVector4d& c) {
    const double value = (C * rest + c * external).value();
    const double parts = (C.cwiseAbs() * rest.cwiseAbs() + c.cwiseAbs() * external.cwiseAbs()).value();
    return std::abs(value) <= 1e-12 * parts ? 0.0 : value;
  };
  for (Port& port : ports) {
    port.c(constant_one) = at_rest(port.C + port.C_delayed, port.c);
    port.c_v(constant_one) = at_rest(port.C_v, port.c_v);
  }
  external_origin = external;
  external_origin(constant_one) = 0.0;
  external = External::Unit(constant_one);
  origin = rest;
  output_origin = C_y.dot(rest.transpose());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(std::ssize(elements));
  E.col(constant_one) = -pull_at(*this, Eigen::VectorXd::Zero(states()), none).force;
}

Eigen::MatrixXd Loop::tangent() const {
  const auto pulls = [](const Element& element) { return pull_of(element, 0.0, 0.0).has_value(); };
  if (std::ranges::none_of(elements, pulls)) return A;
  bool exact = false;
  const Eigen::VectorXd X = rest_point(exact);
  return A + pull_at(*this, X, Eigen::VectorXd::Zero(std::ssize(elements))).slope;
}

}  // namespace limcycle
