#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/claims/run_claims.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// "63 claims: 60 hold, 3 fail; all as expected": the results in a sentence.
std::string claims_answer(const std::vector<TestedClaim>& tested);

/// One row a claim: id, verdict, expected verdict, largest error against its tolerance, number of comparisons.
Table claims_table(const std::vector<TestedClaim>& tested);

/// The comparisons of a claim, one a row.
Table checks_table(const ClaimResult& result);

/// Evidence in words: "read in the source", "derived", ...
std::string_view in_words(Evidence evidence);

/// For a terminal: the answer, the table, and in words the claims that did not hold; all of each claim with `verbose`
/// or if there is one only.
std::string claims_text(const std::vector<TestedClaim>& tested, bool verbose);
Document claims_document(const std::vector<TestedClaim>& tested, bool verbose);  ///< the same, with its tables

/// Ids and statements of claims that were not tested, for a terminal.
std::string claims_list(const std::vector<Claim>& claims);
std::string claims_list_json(const Provenance& provenance, const std::vector<Claim>& claims);

/// JSON document of `claims`: {"claims": [{id, statement, formula, source, evidence, range, test, expected, verdict,
/// as_expected, checks: [...], finding, counterexample, status}]}. `ended`: status of the work.
std::string claims_json(const Provenance& provenance, const std::vector<TestedClaim>& tested,
                        Status ended = Status::converged);

/// One row a comparison; a claim without any has one row with its verdict only.
std::string claims_csv(const std::vector<TestedClaim>& tested);

/// Self-contained page without scripts: the table, then each claim folded. `arguments`: of the command that made it.
std::string claims_page(const std::vector<TestedClaim>& tested, const Provenance& provenance,
                        const std::string& arguments, const std::string& case_text);

}  // namespace limcycle
