#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/orbit/branch/branch_step.hpp"
#include "limcycle/analysis/orbit/branch/continuation.hpp"

namespace limcycle {

/// Evidence at the point where a branch cannot be followed any farther.
struct EndEvidence {
  std::vector<const BranchPoint*> last;  ///< the points before the end, the last one first; at least one
  double direction = 1.0;                ///< sign of ds there
  double largest_amplitude = 0.0, first_amplitude = 0.0, shortest_period = 0.0;  ///< on the branch
  Status failure = Status::stalled;                                              ///< of the last attempt
  bool invalid = false;                                                          ///< that attempt left the valid range
  /// Stopped on purpose: the orbit has become very small, very large, very slow or very unstable.
  bool on_purpose = false;
};

/// Why a branch ends.
struct EndDiagnosis {
  double parameter = 0.0;
  double error = 0.0;  ///< relative error of the value; NaN if the end was not located
  std::string why;
  bool understood = false;
};

/// Explains why a branch ends, from the course of amplitude and period, the order of switches just before and just
/// beyond, and the failure of the map. An end that none of these explains is reported as not understood.
EndDiagnosis diagnose_end(BranchMap& map, const BranchSpot& spot, const EndEvidence& evidence);

/// Zero of a quantity that falls along p: by the line through its last two points, or through those of its square
/// (Hopf), whichever agrees better with the point before. Error: the difference to the same from the points one
/// earlier, and a thousandth of the distance. Empty if it does not fall.
struct Vanishing {
  double parameter, error;
};
std::optional<Vanishing> vanishing(const std::vector<std::pair<double, double>>& last);

/// Where a period grows without bound along p, from its last points (p, 1/T), the last one first: by its rate (see
/// vanishing()), or by p = p* + a exp(-b T), as where a motion only just reaches what it approaches exponentially (a
/// relay the gain of whose loop falls to its hysteresis, a saddle), whichever agrees better with the point before. The
/// latter needs four points. Error: as of vanishing(). Empty if it does not grow.
std::optional<Vanishing> slowing(const std::vector<std::pair<double, double>>& last);

}  // namespace limcycle
