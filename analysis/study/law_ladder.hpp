#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/elements.hpp"

namespace limcycle {

/// One step of the ladder of friction laws, made from the law of a case.
struct LawRung {
  std::string name;                    ///< "coulomb", "coulomb + stiction", "stribeck", ...
  std::optional<Element<double>> law;  ///< empty: not possible
  std::string rule;                    ///< how its parameters follow, or why it is not possible
  bool own = false;                    ///< it is the case's own law, as it stands
};

/// The laws coulomb, coulomb + stiction, stribeck, dahl, lugre, elasto-plastic, multi-state (GMS, or Maxwell-slip where
/// there is no Stribeck curve) and non-drift, least first, with parameters from `own` by one rule for each. What a law
/// cannot carry is dropped, and the rule says so. A law of another kind stands at the end as it is.
std::vector<LawRung> law_ladder(const Element<double>& own);

/// The law with one of its numbers changed.
struct LawVariation {
  std::string name;  ///< "Fs -10 %"
  Element<double> law;
};

/// Every number of the law up and down by `spread` (0.1: 10 %), one at a time. A number that has its value from another
/// one (Fs_minus) goes with it; numbers that are zero, and changes that the law's own rules refuse, are left out.
std::vector<LawVariation> law_variations(const Element<double>& own, double spread);

/// Kind of a law as a case file spells it.
std::string_view law_kind(const Element<double>& law);

}  // namespace limcycle
