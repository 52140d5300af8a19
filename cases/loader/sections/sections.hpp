#pragma once
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/text/section.hpp"

namespace limcycle::case_file {

// Readers of the sections of a case file; each throws InputError.

/// [loop]: either all parts of a loop, or one lone element.
void read_loop(const Section& section, Case& into);

/// [diagram]: blocks joined by the names of their signals, as the file is after name_blocks().
void read_diagram(const Section& section, Case& into);

/// Reads the files that hold the points of measured friction curves (curve = "table" with `file`), and puts the points
/// in their place.
std::vector<CurveFile> read_curves(Document& document);

/// Reads the MAT-files that hold matrices of plants and controllers, and puts these in their place.
std::vector<MatrixFile> read_matrices(Document& document);

/// The reference of a loop: a number or {kind = "ramp", rate = ...}.
void read_reference(const Place& place, LoopParts& parts);

/// Checks the parts of a loop together; `key`: "loop" or "diagram".
void check_together(const Section& section, const std::string& key, const LoopParts& parts);

/// The parts joined; empty if they do not fit together and read_loop() would reject them.
std::optional<Loop> finite_loop(const LoopParts& parts);

SearchBox read_search(const Section& section);
OutputUnit read_units(const Section& section);
DfSection read_df(const Section& section);
void read_predict(const Section& section, Case& into);
DissipativitySection read_dissipativity(const Section& section);

/// [simulate]; `states`: valid names in `initial`.
SimulateOptions read_simulate(const Section& section, const std::vector<std::string>& states);

/// [sensitivity]; `from`: the case, whose loop is already read.
ParameterSpread read_sensitivity(const Section& section, const Case& from);

/// A list of {path, distribution, ...}: the distributions of some of these numbers.
std::vector<SpreadParameter> read_spread_list(const Place& list, const std::vector<CaseNumber>& numbers);

/// [identify]; the files of its records are not read.
IdentifySection read_identify(const Section& section);

/// [[claim]]; `from`: the case, whose loop is already read.
std::vector<UserClaim> read_claims(const Place& list, const Case& from);

/// A signal in time: a number (constant) or {kind = "step"|"ramp"|"sine"|"zigzag"|"table", ...}.
Signal read_signal(const Place& place);

}  // namespace limcycle::case_file
