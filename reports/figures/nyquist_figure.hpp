#pragma once
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// G(jw), the family -1/N(A,w) as computed (all amplitudes at all frequencies, of which a few are drawn), the roots at
/// their -1/N, and the error discs. The page lets its reader choose A and w among the computed ones. The text states if
/// G, which is that of small motions, does not pass through a root since other elements or gravity vary with amplitude.
Figure nyquist_figure(const PredictReport& report, const Units& units);

}  // namespace limcycle
