#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// One step of the ladder of friction laws, made from the law of a case.
struct SimplifiedLaw {
  std::string name;            ///< "coulomb", "coulomb + stiction", "stribeck", ...
  std::optional<Element> law;  ///< empty: not possible
  std::string rule;            ///< how its parameters follow, or why it is not possible
  bool own = false;            ///< it is the case's own law, unchanged
};

/// The laws coulomb, coulomb + stiction, stribeck, dahl, lugre, elasto-plastic, multi-state (GMS, or Maxwell-slip if
/// there is no Stribeck curve) and non-drift, simplest first, with parameters from `own` by one rule for each. Effects
/// that a law cannot represent are dropped, as its rule states. A law of another kind comes last, unchanged.
std::vector<SimplifiedLaw> simplified_laws(const Element& own);

/// The law with one of its parameters changed.
struct LawVariation {
  std::string name;  ///< "Fs -10 %"
  Element law;
};

/// Every parameter of the law up and down by `spread` (0.1: 10 %), one at a time. A parameter that takes its value from
/// another one (Fs_minus) changes with it; parameters that are zero, and changes that the law's own rules reject, are
/// omitted.
std::vector<LawVariation> law_variations(const Element& own, double spread);

}  // namespace limcycle
