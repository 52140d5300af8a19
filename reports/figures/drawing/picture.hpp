#pragma once
#include <string>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// The answer as one small SVG, for a README: two periods of y and of the element's output, and the orbit in the phase
/// plane with stuck parts marked; without a cycle the last swings of an irregular motion. Readable on light and dark
/// backgrounds. Coordinates are rounded to 0.1 px. Without either it contains the answer in words only.
std::string predict_picture(const PredictReport& report, const Units& units);

}  // namespace limcycle
