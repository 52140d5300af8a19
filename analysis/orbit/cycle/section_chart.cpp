#include "limcycle/analysis/orbit/cycle/section_chart.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd vector_of(const State& x) { return Eigen::Map<const VectorXd>(x.data(), std::ssize(x)); }

}  // namespace

SectionChart::SectionChart(const Section& section, const State& largest, const State& typical)
    : scale(vector_of(largest)) {
  for (Index i = 0; i < scale.size(); ++i)
    scale(i) = std::max({scale(i), 1e-6 * typical[static_cast<std::size_t>(i)], 1e-300});
  VectorXd normal = VectorXd::Zero(scale.size());
  normal.head(section.C.size()) = section.C.transpose();
  normal.array() *= scale.array();
  // The reflection that takes the normal to an axis takes the other axes to a basis of the plane.
  VectorXd mirror = normal;
  mirror(0) += normal(0) < 0.0 ? -normal.norm() : normal.norm();
  const VectorXd twice = 2.0 / mirror.squaredNorm() * mirror;
  basis = MatrixXd::Identity(scale.size(), scale.size()).rightCols(scale.size() - 1);
  for (Index j = 0; j < basis.cols(); ++j) basis.col(j) -= twice(j + 1) * mirror;
}

State SectionChart::lift(const State& origin, const VectorXd& u) const {
  State x = origin;
  const VectorXd step = scale.cwiseProduct(basis * u);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += step(static_cast<Index>(i));
  return x;
}

VectorXd SectionChart::coordinates(const State& x, const State& origin) const {
  return basis.transpose() * (vector_of(x) - vector_of(origin)).cwiseQuotient(scale);
}

MatrixXd SectionChart::scaled(const MatrixXd& derivative) const {
  return scale.cwiseInverse().asDiagonal() * derivative * scale.asDiagonal();
}

MatrixXd SectionChart::restricted(const MatrixXd& derivative) const {
  return basis.transpose() * scaled(derivative) * basis;
}

}  // namespace limcycle
