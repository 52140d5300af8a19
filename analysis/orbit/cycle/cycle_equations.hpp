#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "limcycle/analysis/orbit/cycle/cycle_pieces.hpp"

namespace limcycle {

/// Effect of the cut march on deviations of its start and on parameters, including the reflection if it covers half a
/// period.
struct PeriodMap {
  Eigen::MatrixXd whole;    ///< dP/dx0
  Eigen::MatrixXd columns;  ///< dP/dp, a column each
};
PeriodMap period_map(const CyclePieces& cut);

/// Reflects deviations at the end of half a period: whole <- S whole, columns <- S columns + (I - S) dc/dp. Does
/// nothing for a whole period.
void reflect(const CyclePieces& cut, PeriodMap& map);

/// The reflection of a half-wave symmetric cycle, if the neighbours are symmetric too.
std::optional<CycleMirror> common_mirror(const Loop& loop, const Cycle& cycle,
                                         std::span<const ParameterNeighbours> neighbours);

/// cut_cycle over the period of a cycle, or with a mirror over half of it.
CyclePieces cut_period(const Loop& loop, const Cycle& cycle, const std::optional<CycleMirror>& mirror,
                       ParameterRates& rates, const CutOptions& options);

/// The matrix of the equations  (I - dP/dx0) dx0 - f dT = dP/dp dp,  f . dx0 = 0  of a cycle, in units of the sizes of
/// the states and with the period in units of 1/|f|. At a fold it is singular.
Eigen::MatrixXd cycle_matrix(const CyclePieces& cut, const Eigen::MatrixXd& whole);

/// True if the march returns to its start, in the modes of the start.
bool closes(const CyclePieces& cut, const LoopState& start);

}  // namespace limcycle
