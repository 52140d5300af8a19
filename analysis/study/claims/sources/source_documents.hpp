#pragma once
#include "limcycle/analysis/study/claims/claim.hpp"
#include "limcycle/analysis/study/claims/run_claims.hpp"
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"
#include "limcycle/analysis/study/experiments/runs/laws.hpp"

/// @file
/// Common parts of the claims of the source documents: the thesis on a non-drift dynamic friction model (sections 3.5
/// to 3.7) and the paper on the Froude pendulum (Piatkowski and Wolski 2018).

namespace limcycle {

// By subject; source_document_claims() joins them.
std::vector<Claim> document_property_claims();    ///< uniqueness, boundedness, dissipativity, stability, steady curve
std::vector<Claim> document_presliding_claims();  ///< drift, balance below the Coulomb level
std::vector<Claim> document_memory_claims();      ///< inner loops of pre-sliding
std::vector<Claim> document_breakaway_claims();   ///< break-away over parameters and force rate
std::vector<Claim> document_pendulum_claims();    ///< of the pendulum paper, and on LuGre's parameters

/// The law of that label with the documents' values.
LawSetting document_law(const std::string& label);

/// The proposed law with parameters drawn about the printed ones: levels, vs, Zb, sigma and tau up to three times
/// smaller or larger.
LawSetting random_proposed_law(RandomShares& random);

/// "Fs = 1.5, Fc = 1, ...": the numbers of a setting.
std::string values_of(const LawSetting& setting);

/// A signal that is constant between `times` (the first is 0), with one value fewer than times.
Signal piecewise_constant(const std::vector<double>& times, const std::vector<double>& values);

/// Records a run that ended early as a stop of the claim's checks; then returns false.
bool completed(const ForcedRun& run, ClaimChecks& checks);

}  // namespace limcycle
