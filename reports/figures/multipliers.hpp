#pragma once
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {

/// As many of the multipliers (sorted, largest first) as fit into about 60 columns: "0.950 ± 0.0100j,
/// -0.200, 3 below 1e-06". A conjugate pair counts as one. `error`: absolute, of each; no digit smaller than it is
/// shown.
std::string multipliers_in_words(const std::vector<std::complex<double>>& multipliers, double error = 0.0);

/// One row for each cycle that has multipliers; no row if none has.
Table multiplier_table(const PredictReport& report);

/// The multipliers of all cycles about the unit circle; empty if there are none.
std::optional<Figure> multiplier_figure(const PredictReport& report);

}  // namespace limcycle
