#pragma once
#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "limcycle/analysis/orbit/cycle/cycle_pieces.hpp"

namespace limcycle {

/// d(multiplier)/dp for each parameter, and in it for each of `multipliers`; see cycle_derivatives for the formula.
/// `solution` holds dx0/dp with dT/dp in the last row. Empty for a
/// multiplier that is not simple, or of less than 1e-9 of the largest: its eigenvectors are rounding. Cost: for each
/// piece and parameter two linear systems of 3n, or two matrix exponentials.
std::vector<std::vector<std::optional<std::complex<double>>>> multiplier_derivatives(
    const CyclePieces& cut, const std::vector<std::complex<double>>& multipliers, const Eigen::MatrixXd& solution,
    ParameterRates& rates);

}  // namespace limcycle
