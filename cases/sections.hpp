#pragma once
#include "limcycle/cases/case.hpp"
#include "limcycle/cases/case_numbers.hpp"
#include "limcycle/cases/section.hpp"

namespace limcycle::case_file {

// Readers of the sections of a case file; each throws InputError.

/// [loop]: either all parts of a loop, or one lone element.
void read_loop(const Section& section, Case& into);

/// The parts joined; empty where they do not fit together, as read_loop() would refuse them.
std::optional<Loop> finite_loop(const LoopParts& parts);

SearchBox read_search(const Section& section);
DfSection read_df(const Section& section);
void read_predict(const Section& section, Case& into);
DissipativitySection read_dissipativity(const Section& section);

/// [simulate]; `states`: the names that `initial` may use.
SimulateOptions read_simulate(const Section& section, const std::vector<std::string>& states);

/// [sensitivity]; `from`: the case, of which the loop has been read.
ParameterSpread read_sensitivity(const Section& section, const Case& from);

/// A list of {path, distribution, ...}: how some of these numbers are distributed.
std::vector<SpreadParameter> read_spread_list(const Place& list, const std::vector<CaseNumber>& numbers);

/// [[claim]]; `from`: the case, of which the loop has been read.
std::vector<UserClaim> read_claims(const Place& list, const Case& from);

/// A signal of time: a number (constant) or {kind = "step"|"ramp"|"sine"|"zigzag"|"table", ...}.
Signal read_signal(const Place& place);

}  // namespace limcycle::case_file
