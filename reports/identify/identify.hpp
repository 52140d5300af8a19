#pragma once
#include <string>

#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// For a terminal: the answer, the ranking of the laws, the numbers of the chosen one with their intervals, what the
/// records do not determine, how each record is fitted.
std::string identify_text(const std::string& title, const IdentifyReport& report);
Document identify_document(const std::string& title, const IdentifyReport& report);  ///< the same, with its tables

/// Numbers are named by their path, "loop.friction.Fs". The value of one that is not identifiable is null.
std::string identify_json(const Provenance& provenance, const IdentifyReport& report);

/// One row a number of a law.
std::string identify_csv(const IdentifyReport& report);

/// Measured and fitted forces of the chosen law (else of the first), one panel a record: over velocity, position or
/// time; of free motions positions and velocities over time. Readable on light and dark backgrounds.
std::string identify_picture(const IdentifyReport& report);

/// "free, position"; only the kind where the force was measured.
std::string record_label(const PreparedRecord& record);
/// What shares are shares of: "the largest force", "the largest displacement or speed".
std::string largest_measured(const IdentifyReport& report);

/// The law to show: the chosen one, else the first with records; null if there is none.
const IdentifiedLaw* shown_law(const IdentifyReport& report);

/// A case with the fitted law in the place of [loop.friction], without [identify] and with a [sensitivity] section that
/// spreads each identifiable number over its interval. `text`: the case that was identified; if it has no [loop], the
/// result holds the law alone. Throws std::invalid_argument if its friction does not stand in a table [loop.friction].
std::string fitted_case(const std::string& text, const std::string& title, const IdentifiedLaw& law);

/// A record as a CSV file with a header, and the section [identify] for these records.
std::string record_csv(const FrictionRecord& record);
std::string identify_section(const std::string& law, const std::vector<FrictionRecord>& records,
                             const std::vector<std::string>& files);

}  // namespace limcycle
