#pragma once
#include <Eigen/Core>

#include "limcycle/analysis/orbit/cycle_pieces.hpp"

namespace limcycle {

/// What the march that was cut does to deviations of its start and to parameters.
struct PeriodMap {
  Eigen::MatrixXd whole;    ///< dP/dx0
  Eigen::MatrixXd columns;  ///< dP/dp, a column each
};
PeriodMap period_map(const CyclePieces& cut);

/// The matrix of the equations  (I - dP/dx0) dx0 - f dT = dP/dp dp,  f . dx0 = 0  of a cycle, in units of the sizes of
/// the states and with the period in units of 1/|f|. At a fold it is singular.
Eigen::MatrixXd cycle_matrix(const CyclePieces& cut, const Eigen::MatrixXd& whole);

/// Does the march come back to its start, in the modes of the start?
bool closes(const CyclePieces& cut, const LoopState& start);

}  // namespace limcycle
