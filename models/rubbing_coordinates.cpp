#include "limcycle/models/rubbing_coordinates.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/models/linear/balance.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();

bool is_one_state(const auto& vector) { return (vector.array() != 0.0).count() == 1; }

bool needs_change(const PlantModel& plant) {
  if (plant.A.rows() < 2 || plant.C_v.size() == 0 || plant.gravity) return false;
  if (plant.C_x.isZero(0.0)) return false;  // no state holds the displacement
  if (is_one_state(plant.C_x) && is_one_state(plant.C_v) && is_one_state(plant.B_F)) return false;
  return !does_not_reach(plant.C_v, plant.B_F) && does_not_reach(plant.C_x, plant.B_F) &&
         does_not_reach(plant.C_y, plant.B_F);
}

/// Product of matrices, with entries of rounding size set to zero.
MatrixXd product(const MatrixXd& a, const MatrixXd& b, const MatrixXd& c) {
  const MatrixXd value = a * b * c, size = a.cwiseAbs() * b.cwiseAbs() * c.cwiseAbs();
  return (value.array().abs() <= rounding * size.array()).select(0.0, value);
}

/// Rows, in the order of choice, that are independent of the previous ones; sizes are in units of the states.
class Rows {
 public:
  explicit Rows(VectorXd units) : units_(std::move(units)), rows_(0, units_.size()), basis_(0, units_.size()) {}

  /// Share of a row that is independent of the rows so far.
  double independent(const RowVectorXd& row) const {
    const RowVectorXd unit = direction(row);
    return rest(unit).norm();
  }
  void add(const RowVectorXd& row) {
    const RowVectorXd fresh = rest(rest(direction(row)).normalized()).normalized();
    rows_.conservativeResize(rows_.rows() + 1, Eigen::NoChange);
    basis_.conservativeResize(basis_.rows() + 1, Eigen::NoChange);
    rows_.bottomRows(1) = row;
    basis_.bottomRows(1) = fresh;
  }
  const MatrixXd& rows() const { return rows_; }

 private:
  RowVectorXd direction(const RowVectorXd& row) const { return row.cwiseProduct(units_.transpose()).normalized(); }
  RowVectorXd rest(const RowVectorXd& unit) const { return unit - unit * basis_.transpose() * basis_; }

  VectorXd units_;
  MatrixXd rows_, basis_;
};

constexpr double dependent = 1e-6;  ///< share below which a row is too dependent to become a state

/// The modes of a matrix as real columns: of a complex pair of eigenvectors the real and the imaginary part. In them
/// the matrix is as large as its eigenvalues, which a mixture of states may exceed by orders of magnitude. The unit
/// matrix where eigenvectors are nearly dependent.
MatrixXd modes_of(const MatrixXd& A) {
  constexpr double nearly_dependent = 1e-6;
  const Index n = A.rows();
  const auto pairs = eigen_pairs(A);
  MatrixXd V(n, n);
  for (Index k = 0; k < n; ++k) {
    const Eigen::VectorXcd vector = pairs.vectors.col(k);
    V.col(k) = pairs.values(k).imag() < 0.0 ? VectorXd(vector.imag()) : VectorXd(vector.real());
  }
  const VectorXd values = singular_values(V).values;
  if (!V.allFinite() || !(values.minCoeff() > nearly_dependent * values.maxCoeff())) return MatrixXd::Identity(n, n);
  return V;
}

/// The matrix T; empty if displacement and velocity are not independent.
MatrixXd states_that_rub(const PlantModel& plant) {
  const Index n = plant.A.rows();
  const double reach = (plant.C_v * plant.B_F).value();
  const MatrixXd takes_out = plant.B_F * plant.C_v / reach;  // a projection: scaled like A divided by a frequency
  const VectorXd units = balancing_units(plant.A + takes_out * plant.A.cwiseAbs().maxCoeff());
  Rows rows(units);
  rows.add(plant.C_x);
  if (rows.independent(plant.C_v) < dependent) return {};
  rows.add(plant.C_v);
  if (n > 2 && rows.independent(plant.C_y) > dependent) rows.add(plant.C_y);
  const Index free = n - rows.rows().rows();
  while (rows.rows().rows() < n) {
    Index best = 0;
    for (Index i = 1; i < n; ++i)
      if (rows.independent(RowVectorXd::Unit(n, i)) > rows.independent(RowVectorXd::Unit(n, best))) best = i;
    rows.add(RowVectorXd::Unit(n, best) / units(best));
  }
  MatrixXd T = rows.rows();
  for (Index i = 2; i < n; ++i) T.row(i) -= (T.row(i) * plant.B_F).value() / reach * plant.C_v;
  if (free == 0) return T;
  const MatrixXd changed = T * plant.A * solve_columns(T, MatrixXd::Identity(n, n));
  if (!changed.allFinite()) return T;
  T.bottomRows(free) = solve_columns(modes_of(changed.bottomRightCorner(free, free)), MatrixXd(T.bottomRows(free)));
  return T;
}

}  // namespace

PlantCoordinates rubbing_coordinates(PlantModel plant) {
  if (!needs_change(plant)) return {std::move(plant), {}};
  const MatrixXd T = states_that_rub(plant);
  if (T.size() == 0) return {std::move(plant), {}};
  const Index n = plant.A.rows();
  const MatrixXd back = solve_columns(T, MatrixXd::Identity(n, n)), one = MatrixXd::Identity(1, 1);
  if (!back.allFinite()) return {std::move(plant), {}};
  const RowVectorXd C_rate = plant.C_x * plant.A, size = plant.C_x.cwiseAbs() * plant.A.cwiseAbs();
  const bool is_rate = ((C_rate - plant.C_v).array().abs() <= 1e-9 * size.array()).all();
  PlantModel changed = plant;
  changed.A = product(T, plant.A, back);
  if (is_rate) changed.A.row(0) = RowVectorXd::Unit(n, 1);
  const double reach = (plant.C_v * plant.B_F).value();
  changed.B_F = reach * VectorXd::Unit(n, 1);
  changed.B_u = plant.B_u == plant.B_F ? changed.B_F : VectorXd(product(T, plant.B_u, one));
  changed.C_x = RowVectorXd::Unit(n, 0);
  changed.C_v = RowVectorXd::Unit(n, 1);
  changed.C_y = plant.C_y == plant.C_x ? changed.C_x : RowVectorXd(product(one, plant.C_y, back));
  return {std::move(changed), back};
}

}  // namespace limcycle
