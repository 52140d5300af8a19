#pragma once
#include <string>
#include <vector>

#include "limcycle/reports/catalogue.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Table of kinds, grouped: kind, states, equation.
std::string laws_text(const std::vector<CatalogueEntry>& entries);

/// All about the entries of one kind: equation, source, parameters with unit, default, range and meaning. (A kind such
/// as "state-space" is both a plant and a controller.)
std::string law_text(const std::vector<CatalogueEntry>& entries);

/// {"laws": [{"group", "kind", "states", "most_states", "equation", "source", "parameters": [{"key", "unit", "type",
/// "required", "default", "default_from", "range": {"low", "high", "low_open", "high_open"}, "choices", "meaning"}]}]};
/// null where there is no such number or text.
std::string laws_json(const Provenance& provenance, const std::vector<CatalogueEntry>& entries);

/// One line a parameter: group,kind,key,unit,type,required,default,low,high,meaning. A kind without parameters has one
/// line with these empty.
std::string laws_csv(const std::vector<CatalogueEntry>& entries);

}  // namespace limcycle
