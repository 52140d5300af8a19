#pragma once
#include <string>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A prediction as one self-contained HTML page: it makes no network requests (its own policy forbids them) and
/// contains the case file, so that the result can be reproduced. The verdict in words comes first. For tests the root
/// element has data-figures="drawn/total" and data-errors. `case_text`: the case file as read; empty: left out.
std::string predict_page(const PredictReport& report, const Provenance& provenance, const std::string& case_text,
                         const Units& units);

}  // namespace limcycle
