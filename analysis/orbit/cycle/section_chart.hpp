#pragma once
#include <Eigen/Core>

#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// Coordinates on a section: x = origin + scale * (basis u), basis orthonormal and tangent to the section.
struct SectionChart {
  Eigen::VectorXd scale;
  Eigen::MatrixXd basis;

  SectionChart() = default;
  /// `largest`: sizes of the states on the orbit; those that vanish there count as 1e-6 of their `typical` size.
  SectionChart(const Section& section, const State& largest, const State& typical);
  State lift(const State& origin, const Eigen::VectorXd& u) const;
  Eigen::VectorXd coordinates(const State& x, const State& origin) const;
  /// A derivative over all states in units of their scales.
  Eigen::MatrixXd scaled(const Eigen::MatrixXd& derivative) const;
  /// Derivative of a map of the section to itself, in coordinates, from that over all states.
  Eigen::MatrixXd restricted(const Eigen::MatrixXd& derivative) const;
};

}  // namespace limcycle
