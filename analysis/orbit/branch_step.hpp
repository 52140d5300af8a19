#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/orbit/branch_map.hpp"

namespace limcycle {

/// A solved point of a branch: w = (u, s) with the direction of the branch there.
struct BranchSpot {
  Eigen::VectorXd w, tangent;                     ///< tangent of length 1; its last component is ds
  Eigen::VectorXd slope;                          ///< dR/ds
  BranchMap::Value value;                         ///< with dP/du
  std::vector<std::complex<double>> multipliers;  ///< of the (half) map, largest first
  double s_error = 0.0;      ///< by the disagreement of two integration tolerances, at fixed arclength
  double orbit_error = 0.0;  ///< the same for u and the period, relative
  Cycle cycle;               ///< filled by measure_spot()
  int iterations = 0;

  double s() const { return w(w.size() - 1); }
  Eigen::VectorXd u() const { return w.head(w.size() - 1); }
};

/// Solves the points of a branch.
class BranchSolver {
 public:
  explicit BranchSolver(BranchMap& map) : map_(map) {}

  /// The point of the branch in the plane through `w` across `normal`: Newton on the bordered system, and there the
  /// tangent (along `normal`), the multipliers and the errors. Empty if it does not contract; failure() says why.
  std::optional<BranchSpot> solve(const Eigen::VectorXd& w, const Eigen::VectorXd& normal,
                                  const Eigen::VectorXd& slope);

  /// Fills the cycle of a solved point; false if it cannot be recorded.
  bool measure_spot(BranchSpot& spot);

  /// Puts the frame of the map onto the orbit of `spot`, whose cycle has its trace. `before`: the spot before it, for
  /// the direction; else `direction` is the sign of ds. Empty if the orbit is not found again.
  std::optional<BranchSpot> reframe(const BranchSpot& spot, const BranchSpot* before, double direction);

  /// The first frame, from a cycle at s.
  std::optional<BranchSpot> begin(const Cycle& cycle, double s);

  /// Has the orbit moved or changed its size so much that the frame no longer suits it?
  bool frame_is_worn(const BranchSpot& spot) const;

  /// Why the last solve() failed: the status of the map, or stalled where Newton did not contract.
  Status failure() const { return failure_; }
  bool invalid() const { return invalid_; }  ///< it left the values that are valid

 private:
  bool complete(BranchSpot& spot, const Eigen::VectorXd& normal);
  bool place_frame(const LoopState& start, const Trace& trace, double s, bool half);
  double slope_step(const Eigen::VectorXd& slope) const;

  BranchMap& map_;
  Status failure_ = Status::converged;
  bool invalid_ = false;
};

}  // namespace limcycle
