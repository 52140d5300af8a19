#pragma once
#include <string>
#include <vector>

#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Table of kinds, grouped: kind, states, equation.
std::string laws_text(const std::vector<CatalogueEntry>& entries);

/// All facts about the entries of one kind: equation, states, features of a friction law, source, parameters with unit,
/// default, range and meaning. (A kind such as "state-space" is both a plant and a controller.)
std::string law_text(const std::vector<CatalogueEntry>& entries);

/// {"laws": [{"group", "kind", "states", "most_states", "states_per_entry", "states_beside", "equation", "source",
/// "features": {"memory", "drifts", "drift", "rate", "passivity", "evidence"}, "parameters": [{"key", "unit", "type",
/// "required", "default", "default_from", "range": {"low", "high", "low_open", "high_open"}, "choices", "meaning"}]}]};
/// null if there is no such number or text; "features" for friction laws only.
std::string laws_json(const Provenance& provenance, const std::vector<CatalogueEntry>& entries);

/// One line a parameter: group,kind,key,unit,type,required,default,low,high,meaning, then, the same on every line of a
/// kind, states,memory,drifts,drift,rate,passivity,evidence. A kind without parameters has one line with these empty.
std::string laws_csv(const std::vector<CatalogueEntry>& entries);

/// The friction laws among the entries as a page of documentation (docs/laws.md): their table against features, then a
/// section for each.
std::string laws_markdown(const std::vector<CatalogueEntry>& entries);

/// Number of continuous states in few characters: "1", "1-3", "N", "N+1" (N: length of the lists), "any".
std::string states_text(const CatalogueEntry& entry);

/// Text of a parameter in a listing: "required" or its default, and its valid values.
std::string default_text(const ParameterEntry& parameter);
std::string range_text(const ParameterEntry& parameter);

}  // namespace limcycle
