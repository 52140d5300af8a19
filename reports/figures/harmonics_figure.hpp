#pragma once
#include <optional>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Amplitudes of the first 15 harmonics of y and of the element's output over the cycle drawn in the time domain (the
/// first stable one, else the first). Harmonics below 1e-5 of the largest are left out: the samples do not distinguish
/// them from zero. Empty without a cycle.
std::optional<Figure> harmonics_figure(const PredictReport& report, const Units& units);

}  // namespace limcycle
