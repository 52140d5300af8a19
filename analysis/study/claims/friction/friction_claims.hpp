#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/claims/claim_points.hpp"
#include "limcycle/analysis/study/experiments/runs/laws.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// The values of a law that the experiments compare.
const LawSetting& compared_setting(const std::string& label);

/// LuGre with the values of 1995, sigma2 = 0: Fs = 1.5, Fc = 1, vs = 1e-3, sigma0 = 1e5, sigma1 = sqrt(1e5).
LuGre<double> lugre_1995();

/// Speed at which no law shows an effect of its rate, m/s.
inline constexpr double creep = 1e-12;

std::vector<Claim> bristle_claims();         ///< D1, D6, D7, D8
std::vector<Claim> passivity_claims();       ///< D2
std::vector<Claim> friction_path_claims();   ///< D3, D4, D9
std::vector<Claim> friction_run_claims();    ///< D5, D10, D12
std::vector<Claim> friction_scale_claims();  ///< D11

}  // namespace limcycle
