#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "limcycle/models/dual.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Derivatives of an element's functions, exact, by dual numbers, four variables at a time. One object serves one
/// thread; a result is valid until the next call. Cost: one evaluation on Dual<4> for every four variables.
class ElementSlopes {
 public:
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit ElementSlopes(const Element& element);

  Eigen::Index states() const { return states_; }

  /// Derivatives of the output (first row; zero unless `output`) and of the rate of each state (a row each) by x, v,
  /// its own states and, if `by_drive`, the drive: a column each.
  const Table& response(const Input<double>& in, Mode mode, const double* z, bool by_drive = false, bool output = true);
  /// Derivatives of the value of guard `guard` by x, v, the drive and its own states, in one row.
  const Table& guard(const Input<double>& in, Mode mode, const double* z, std::size_t guard);
  /// Derivatives of each state after the switch of guard `guard` (a row each) by x, v and the states before it.
  const Table& reset(const Input<double>& in, Mode mode, const double* z, std::size_t guard);

 private:
  using D = Dual<4>;
  using Index = Eigen::Index;

  ElementOn<D> element_;
  Index states_;
  std::vector<D> z_, dz_, guards_;
  Table table_;
};

}  // namespace limcycle
