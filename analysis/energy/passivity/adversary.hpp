#pragma once
#include "limcycle/analysis/energy/passivity/motions.hpp"

namespace limcycle {

/// Result of a search for energy.
struct Attack {
  long inputs = 0;     ///< periodic inputs that were tried and whose motion became periodic
  double least = 0.0;  ///< J, least energy supplied per cycle by any of them, errors counting as none
  double share = 1.0;  ///< least energy supplied per cycle over the turnover
  Strokes input{};     ///< the one to show: much energy taken out in a short time, otherwise the least share
  Status status = Status::converged;
};

/// Searches periodic inputs, linear in pieces, for one that takes energy out cycle by cycle: inputs known to do so for
/// some law, random ones (`seed`), then local refinement in the logarithms of signals and lengths. Finding nothing
/// proves nothing. Cost: some 10^3 inputs times `effort`, each marched until its state repeats.
Attack attack(const Element& element, const MotionScales& scales, const PassivityOptions& options);

/// Counter-example from the result of a search: marched again at tighter tolerance, with an error; empty unless the
/// energy is clearly above it. Not confirmed yet.
std::optional<Counterexample> counterexample_of(const Element& element, const Strokes& input);

/// The verdict of a search alone: no, with a counter-example that the independent simulation confirms to 1e-4, or
/// undecided. In passivity.cpp.
Passivity searched_passivity(const Element& element, const PassivityOptions& options);

/// The input as text, piece by piece.
std::string words_of(std::span<const SignalPiece> pieces, DrivenBy port);

}  // namespace limcycle
