#include "limcycle/models/linear/transfer.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double negligible_part = 1e-13;

/// u such that I - 2 u u'/(u' u) maps v to a multiple of e1; zero if v is already along e1. Not normalised, so that the
/// reflection is exact if only the order of the states changes.
VectorXd reflection(const VectorXd& v) {
  const double largest = v.size() == 0 ? 0.0 : v.cwiseAbs().maxCoeff();
  if (largest == 0.0 || v.tail(v.size() - 1).isZero(0.0)) return VectorXd::Zero(v.size());
  VectorXd u = v / largest;
  const double norm = u.norm();
  u(0) += u(0) < 0.0 ? -norm : norm;
  return u;
}

/// Reflects the coordinates of the states from `first` on by I - 2 u u'/(u' u).
void reflect(StateSpace& H, Index first, const VectorXd& u) {
  const Index m = u.size();
  const double square = u.squaredNorm();
  if (square == 0.0) return;
  const double twice = 2.0 / square;
  H.A.middleRows(first, m) -= twice * u * (u.transpose() * H.A.middleRows(first, m)).eval();
  H.A.middleCols(first, m) -= (twice * (H.A.middleCols(first, m) * u)).eval() * u.transpose();
  H.B.middleRows(first, m) -= twice * u * (u.transpose() * H.B.middleRows(first, m)).eval();
  H.C.middleCols(first, m) -= (twice * (H.C.middleCols(first, m) * u)).eval() * u.transpose();
}

StateSpace block(const StateSpace& H, Index first, Index size) {
  return {H.A.block(first, first, size, size), H.B.middleRows(first, size), H.C.middleCols(first, size), H.D};
}

StateSpace transposed(const StateSpace& H) { return {H.A.transpose(), H.C.transpose(), H.B.transpose(), H.D}; }

/// Scales the states by powers of two so that their rows and columns are of equal size (Parlett and Reinsch 1969).
void balance(StateSpace& H) {
  const Index n = H.states();
  for (int sweep = 0; sweep < 20; ++sweep) {
    bool changed = false;
    for (Index i = 0; i < n; ++i) {
      const double own = std::abs(H.A(i, i));
      const double in = H.A.row(i).cwiseAbs().sum() - own + std::abs(H.B(i, 0));
      const double out = H.A.col(i).cwiseAbs().sum() - own + std::abs(H.C(0, i));
      if (!(in > 0.0 && out > 0.0)) continue;
      const double scale = std::exp2(std::round(0.5 * std::log2(in / out)));
      if (scale == 1.0) continue;
      changed = true;
      H.A.row(i) /= scale;
      H.A.col(i) *= scale;
      H.B(i, 0) /= scale;
      H.C(0, i) *= scale;
    }
    if (!changed) return;
  }
}

/// Moves the states that the input reaches to the front; returns their number.
Index staircase(StateSpace& H, double A_size) {
  const Index n = H.states();
  const double size = std::max(H.A.norm(), A_size);
  for (Index k = 0; k < n; ++k) {
    const VectorXd next = k == 0 ? VectorXd(H.B.col(0)) : VectorXd(H.A.col(k - 1).tail(n - k));
    if (next.norm() <= (k == 0 ? 0.0 : negligible_part * size)) return k;
    reflect(H, k, reflection(next));
  }
  return n;
}

/// q with A q = 0 to rounding of `size`, |q| = 1; empty if A is regular.
VectorXd null_direction(const MatrixXd& A, double size) {
  const Index n = A.rows();
  if (n == 0) return VectorXd(0);
  const PivotedQr qr = pivoted_qr(A.transpose());
  if (std::abs(qr.R(n - 1, n - 1)) > negligible_part * size) return VectorXd(0);
  return qr.Q.col(n - 1);
}

/// The part that the input reaches; the eigenvalues left out are appended to `hidden`.
StateSpace reached(StateSpace H, double A_size, Eigen::VectorXcd& hidden) {
  const Index n = H.states(), kept = staircase(H, A_size);
  if (kept == n) return H;
  const Eigen::VectorXcd lost = eigenvalues(H.A.bottomRightCorner(n - kept, n - kept));
  hidden.conservativeResize(hidden.size() + lost.size());
  hidden.tail(lost.size()) = lost;
  return block(H, 0, kept);
}

}  // namespace

Minimal minimal(const StateSpace& H, double A_size) {
  Minimal result{H, Eigen::VectorXcd(0)};
  balance(result.H);
  result.H = transposed(reached(transposed(reached(result.H, A_size, result.hidden)), A_size, result.hidden));
  return result;
}

std::optional<Eigen::VectorXcd> zeros(const StateSpace& of) {
  StateSpace H = of;
  balance(H);
  const double C_size = H.C.norm(), B_size = H.B.norm(), A_size = H.A.norm();
  double size = C_size;  // size of the terms that form the output row
  if (H.D(0, 0) != 0.0 && H.states() == 0) return Eigen::VectorXcd(0);
  if (H.D(0, 0) != 0.0) return eigenvalues(H.A - H.B * H.C / H.D(0, 0));
  while (H.states() > 0) {
    const Index n = H.states();
    if (H.C.norm() <= negligible_part * size) return std::nullopt;
    reflect(H, 0, reflection(H.C.transpose()));
    const double b = H.B(0, 0);
    const auto rest = H.B.bottomRows(n - 1);
    if (std::abs(b) > negligible_part * B_size && n == 1) return Eigen::VectorXcd(0);
    if (std::abs(b) > negligible_part * B_size)
      return eigenvalues(H.A.bottomRightCorner(n - 1, n - 1) - rest / b * H.A.topRightCorner(1, n - 1));
    const MatrixXd row = H.A.topRightCorner(1, n - 1);
    H = block(H, 1, n - 1);
    H.C = row;
    size = A_size;
  }
  return std::nullopt;
}

std::optional<Inverse> inverse(const StateSpace& of) {
  StateSpace H = of;
  const Index n = H.states();
  const double D = H.D(0, 0);
  if (D != 0.0) return Inverse{0.0, {H.A - H.B * H.C / D, H.B / D, -H.C / D, MatrixXd::Constant(1, 1, 1.0 / D)}, {}};
  if (n == 0 || H.C.isZero(0.0)) return std::nullopt;
  reflect(H, 0, reflection(H.C.transpose()));
  const double c = H.C(0, 0), b = H.B(0, 0);
  if (std::abs(b) <= negligible_part * H.B.norm()) return std::nullopt;
  // y = c x1; x1' = a11 x1 + A12 x2 + b u gives u; the rate of x2 - (b2/b) x1 contains no y'.
  const double a11 = H.A(0, 0);
  const MatrixXd A12 = H.A.topRightCorner(1, n - 1), A21 = H.A.bottomLeftCorner(n - 1, 1);
  const MatrixXd ratio = H.B.bottomRows(n - 1) / b;
  const MatrixXd Z = H.A.bottomRightCorner(n - 1, n - 1) - ratio * A12;
  const double feed = a11 + (A12 * ratio).sum();
  const double terms = std::abs(a11) + (A12.cwiseAbs() * ratio.cwiseAbs()).sum() + H.A.norm();
  const double A_made_of = H.A.norm() * (1.0 + ratio.norm());
  const double D_inverse = std::abs(feed) <= negligible_part * terms ? 0.0 : -feed / (b * c);
  return Inverse{1.0 / (b * c),
                 {Z, (Z * ratio + A21 - ratio * a11) / c, -A12 / b, MatrixXd::Constant(1, 1, D_inverse)},
                 {A_made_of, terms / std::abs(b * c)}};
}

OriginPole without_origin_pole(const StateSpace& of, double A_size) {
  OriginPole result{0, 0.0, of};
  StateSpace H = of;
  const VectorXd q = null_direction(H.A, std::max(H.A.norm(), A_size));
  if (q.size() == 0) return result;
  result.order = zero_modes(H.A, A_size).times;
  if (result.order > 1) return result;
  reflect(H, 0, reflection(q));
  StateSpace rest = block(H, 1, H.states() - 1);
  // a (s - A)^-1/s = a A^-1 ((s - A)^-1 - 1/s)
  const Index m = rest.states();
  const MatrixXd a = H.A.topRightCorner(1, m);
  const MatrixXd weight =
      m == 0 ? MatrixXd(1, 0) : MatrixXd(solve_columns_fully_pivoted(rest.A.transpose(), a.transpose()).transpose());
  result.residue = H.C(0, 0) * (H.B(0, 0) - (weight * rest.B).sum());
  rest.C += H.C(0, 0) * weight;
  result.rest = std::move(rest);
  return result;
}

MatrixXd balanced(const MatrixXd& A) {
  const Index n = A.rows();
  StateSpace H{A, MatrixXd::Zero(n, 1), MatrixXd::Zero(1, n), MatrixXd::Zero(1, 1)};
  balance(H);
  return H.A;
}

ZeroModes zero_modes(const MatrixXd& A, double A_size) {
  ZeroModes result;
  const double size = std::max(A.norm(), A_size);
  StateSpace H{A, VectorXd::Zero(A.rows()), VectorXd::Zero(A.rows()).transpose(), MatrixXd::Zero(1, 1)};
  for (VectorXd q = null_direction(H.A, size); q.size() > 0; q = null_direction(H.A, size)) {
    ++result.times;
    reflect(H, 0, reflection(q));
    H = block(H, 1, H.states() - 1);
  }
  if (A.rows() == 0) return result;
  const PivotedQr qr = pivoted_qr(A);
  for (Index i = 0; i < A.rows(); ++i)
    if (std::abs(qr.R(i, i)) <= negligible_part * size) ++result.directions;
  return result;
}

}  // namespace limcycle
