#pragma once
#include <string>

#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A prediction as one self-contained HTML page: it asks nothing of the network (its own policy forbids it) and holds
/// the case file, so that the result can be made again. The verdict in words stands first. The page tells a test how it
/// fared by data-figures="drawn/total" and data-errors on its root element. `case_text`: the case file as read; empty:
/// left out.
std::string predict_page(const PredictReport& report, const Provenance& provenance, const std::string& case_text,
                         const Units& units);

}  // namespace limcycle
