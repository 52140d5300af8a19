#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/energy/loop/audit.hpp"
#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/cycle/agreement.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// JSON documents of schema "limcycle/1". Each begins with schema, command, case and provenance; no time stamp, so that
/// the same run gives the same bytes. A number that does not exist is null, indices count from 0, text that is not
/// UTF-8 is replaced. One line a key, and one line an element of a list of objects or rows; numbers in shortest exact
/// form.

/// `df`: results of the first points (fewer than points if the work was interrupted). Throws std::invalid_argument if
/// there are more results than points.
std::string df_json(const Provenance& provenance, const std::vector<DfPoint>& points,
                    const std::vector<DescribingFunction>& results);

std::string predict_json(const Provenance& provenance, const PredictReport& report);

/// `second`: agreement with a run at other tolerances, `energy`: energy balance; null in the document without them.
std::string simulate_json(const Provenance& provenance, const Simulation& run,
                          const std::optional<Agreement>& second = std::nullopt,
                          const std::optional<EnergyBalance>& energy = std::nullopt);

}  // namespace limcycle
