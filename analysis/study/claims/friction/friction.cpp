#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/study/claims/friction/friction_claims.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

const LawSetting& compared_setting(const std::string& label) {
  const auto found = std::ranges::find(law_settings(), label, &LawSetting::label);
  if (found == law_settings().end()) throw std::invalid_argument("there are no values of a law '" + label + "'");
  return *found;
}

LuGre<double> lugre_1995() {
  LuGre<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = std::sqrt(1e5);
  return law;
}

std::vector<Claim> friction_claims() {
  std::vector<Claim> all;
  for (const auto list :
       {bristle_claims, passivity_claims, friction_path_claims, friction_run_claims, friction_scale_claims}) {
    auto some = list();
    all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  }
  // D2 before D10.
  std::ranges::sort(all, {}, [](const Claim& claim) { return std::pair(std::stoi(claim.id.substr(1)), claim.id); });
  return all;
}

}  // namespace limcycle
