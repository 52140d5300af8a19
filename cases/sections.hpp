#pragma once
#include "limcycle/cases/case.hpp"
#include "limcycle/cases/section.hpp"

namespace limcycle::case_file {

// Readers of the sections of a case file; each throws InputError.

/// [loop]: either all parts of a loop, or one lone element.
void read_loop(const Section& section, Case& into);

SearchBox read_search(const Section& section);
DfSection read_df(const Section& section);
void read_predict(const Section& section, Case& into);

/// [simulate]; `states`: the names that `initial` may use.
SimulateOptions read_simulate(const Section& section, const std::vector<std::string>& states);

/// [sensitivity]; `from`: the case, of which the loop has been read.
ParameterSpread read_sensitivity(const Section& section, const Case& from);

/// A signal of time: a number (constant) or {kind = "step"|"ramp"|"sine"|"zigzag"|"table", ...}.
Signal read_signal(const Place& place);

}  // namespace limcycle::case_file
