#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// CSV documents (RFC 4180, but lines end with a newline only): a line of column names, which are the keys of the JSON
/// document, then the rows. Numbers in shortest exact form; a value that does not exist is an empty field.

/// amplitude,frequency,bias,gain_re,gain_im,mean,harmonic_1_sine,harmonic_1_cosine,...,dissipation,error,method,status
std::string df_csv(const std::vector<DfPoint>& points, const std::vector<DescribingFunction>& results);

/// One row a cycle, prediction, missed cycle and start, distinguished by the first column `kind`.
std::string predict_csv(const PredictReport& report);

/// The columns of the run.
std::string simulate_csv(const Simulation& run);

}  // namespace limcycle
