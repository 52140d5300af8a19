#include "limcycle/analysis/motion/field/element_slopes.hpp"

#include <algorithm>

namespace limcycle {
namespace {

using Eigen::Index;
using D = Dual<4>;

constexpr Index batch = 4;  ///< variables at a time

/// Value seeded as variable k of a batch that begins at `first`.
D seeded(double value, Index k, Index first) {
  return k >= first && k < first + batch ? D::variable(value, static_cast<int>(k - first)) : D(value);
}

/// Writes the derivatives of one row computed in a batch.
void write(ElementSlopes::Table& table, Index row, const D& value, Index first) {
  const Index end = std::min(table.cols(), first + batch);
  for (Index k = first; k < end; ++k) table(row, k) = value.d[static_cast<std::size_t>(k - first)];
}

}  // namespace

ElementSlopes::ElementSlopes(const Element& element)
    : element_(element.on<D>()), states_(element.states()), z_(static_cast<std::size_t>(states_)), dz_(z_.size()) {}

const ElementSlopes::Table& ElementSlopes::response(const Input<double>& in, Mode mode, const double* z, bool by_drive,
                                                    bool output) {
  const Index drive = 2 + states_, count = drive + (by_drive ? 1 : 0);
  table_.resize(1 + states_, count);
  for (Index first = 0; first < count; first += batch) {
    const Input<D> at{seeded(in.x, 0, first), seeded(in.v, 1, first),
                      by_drive ? seeded(in.drive, drive, first) : D(in.drive)};
    for (Index k = 0; k < states_; ++k) z_[static_cast<std::size_t>(k)] = seeded(z[k], 2 + k, first);
    D w(0.0);
    if (output)
      w = element_.respond(at, mode, z_, dz_);
    else if (states_ > 0)
      element_.rate(at, mode, z_, dz_);
    write(table_, 0, w, first);
    for (Index j = 0; j < states_; ++j) write(table_, 1 + j, dz_[static_cast<std::size_t>(j)], first);
  }
  return table_;
}

const ElementSlopes::Table& ElementSlopes::guard(const Input<double>& in, Mode mode, const double* z,
                                                 std::size_t guard) {
  table_.setZero(1, 3 + states_);
  guards_.resize(static_cast<std::size_t>(element_.guards(mode)));
  for (Index first = 0; first < table_.cols(); first += batch) {
    const Input<D> at{seeded(in.x, 0, first), seeded(in.v, 1, first), seeded(in.drive, 2, first)};
    for (Index k = 0; k < states_; ++k) z_[static_cast<std::size_t>(k)] = seeded(z[k], 3 + k, first);
    element_.guard(at, mode, std::span<const D>(z_), guards_);
    write(table_, 0, guards_[guard], first);
  }
  return table_;
}

const ElementSlopes::Table& ElementSlopes::reset(const Input<double>& in, Mode mode, const double* z,
                                                 std::size_t guard) {
  table_.setZero(states_, 2 + states_);
  table_.rightCols(states_).setIdentity();
  for (Index first = 0; first < table_.cols() && states_ > 0; first += batch) {
    const Input<D> at{seeded(in.x, 0, first), seeded(in.v, 1, first), D(in.drive)};
    for (Index k = 0; k < states_; ++k) z_[static_cast<std::size_t>(k)] = seeded(z[k], 2 + k, first);
    element_.next(at, mode, std::span<D>(z_), static_cast<int>(guard));
    for (Index j = 0; j < states_; ++j) write(table_, j, z_[static_cast<std::size_t>(j)], first);
  }
  return table_;
}

}  // namespace limcycle
