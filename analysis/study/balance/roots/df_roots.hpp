#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"

namespace limcycle {

/// All roots of the first-harmonic balance in a box.
struct DfRoots {
  std::vector<Root> roots;
  std::vector<std::string> notes;  ///< regions in which roots may be missing
  Status status = Status::converged;
};

/// All roots of 1 + N(A, w) G(jw) of a loop in a box: the box is cut at undamped poles of the rest of the loop (where G
/// is infinite), the phase of a delay sets the grid, and on a belt the search runs along the kink of N. The search ends
/// as incomplete after `max_evaluations` of the main element's equations (FirstHarmonicBalance::evaluations).
DfRoots find_df_roots(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                      const std::function<bool()>& stop, long max_evaluations = 100'000'000);

}  // namespace limcycle
