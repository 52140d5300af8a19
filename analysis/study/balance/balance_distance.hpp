#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"

namespace limcycle {

/// Closest approach of -1/N to the Nyquist curve at equal frequency.
struct BalanceDistance {
  double distance;   ///< |1/G + N| / |N| = |1 + N G| / |N G|; 0: they meet, the describing function predicts a cycle
  double amplitude;  ///< of the element's input, at the closest approach
  double frequency;  ///< rad/s, at the closest approach
};

/// The least distance over the box: a grid over (ln A, ln w), then a pattern search from its best points (R. Hooke, T.
/// A. Jeeves, 1961), to 1e-6 in ln A and ln w. Empty if the plain describing function does not apply to the loop, or if
/// `stop` returns true. Cost: some 2000 describing functions. A minimum much narrower than the grid (a lightly damped
/// resonance) may be missed, unless it is near one of the `roots` that are known: the distance is then an upper bound.
std::optional<BalanceDistance> balance_distance(const Loop& loop, const SearchBox& box,
                                                const std::function<bool()>& stop = {},
                                                const std::vector<BalanceDistance>& roots = {});

}  // namespace limcycle
