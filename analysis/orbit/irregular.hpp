#pragma once
#include <optional>

#include "limcycle/analysis/cycle.hpp"

namespace limcycle {

/// Numbers of a permanent bounded motion that has no period.
struct IrregularMotion {
  double half_range = 0.0;   ///< half of largest less least y
  double mean_period = 0.0;  ///< mean time between upward crossings of the middle of that range, s
};

/// The numbers of a recorded motion, its first third left out, if it looks permanent: over four equal parts of the rest
/// its range, its spread and its returns stay the same within the scatter of such numbers, and its spread neither falls
/// nor rises from each part to the next (a slow decay, a slow approach), nor do the returns repeat themselves. Whether
/// the numbers are those of the loop and not of the tolerance: see agree().
std::optional<IrregularMotion> permanent_motion(const Trace& trace);

/// Whether two runs at different tolerances, whose motions part after a while if they are chaotic, tell the same.
bool agree(const IrregularMotion& one, const IrregularMotion& other);

}  // namespace limcycle
