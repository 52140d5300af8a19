#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/orbit/branch/branch_map.hpp"

namespace limcycle {

/// Derivatives of the map, at a point of the branch or near it.
struct BranchJacobian {
  Eigen::MatrixXd D;      ///< dP/du; empty: not known
  Eigen::VectorXd slope;  ///< dR/ds
};

/// A solved point of a branch: w = (u, s) with the direction of the branch there.
struct BranchSpot {
  Eigen::VectorXd w, tangent;  ///< tangent of length 1; its last component is ds
  BranchJacobian jacobian;
  BranchMap::Value value;                         ///< at w
  std::vector<std::complex<double>> multipliers;  ///< of the (half) map, largest first
  double left = 0.0;                              ///< bound of the remaining R
  double s_error = 0.0;      ///< from the difference of two integration tolerances, at fixed arclength
  double orbit_error = 0.0;  ///< the same for u and the period, relative
  Cycle cycle;
  int iterations = 0;

  double s() const { return w(w.size() - 1); }
  Eigen::VectorXd u() const { return w.head(w.size() - 1); }
};

/// Solves the points of a branch. The integration is as tight as `accuracy` needs, by the estimated errors.
class BranchSolver {
 public:
  BranchSolver(BranchMap& map, double accuracy) : map_(map), accuracy_(accuracy) {}

  /// Required precision of the derivatives at a solved point: to step on, or to locate a passage through a value.
  enum class Derivatives { rough, precise };

  /// The point of the branch in the plane through `w` across `normal`: Newton on the bordered system with the Jacobian
  /// of a point nearby (improved by Broyden's updates, computed anew if that does not contract), with the tangent
  /// (along `normal`), the multipliers, the errors and the cycle. Empty if it does not contract; failure() gives the
  /// reason.
  std::optional<BranchSpot> solve(const Eigen::VectorXd& w, const Eigen::VectorXd& normal, const BranchJacobian& near,
                                  Derivatives derivatives = Derivatives::rough);

  /// Puts the frame of the map onto the orbit of `spot`, whose cycle has its trace. `before`: the spot before it, for
  /// the direction; else `direction` is the sign of ds. Empty if the orbit is not found again.
  std::optional<BranchSpot> reframe(const BranchSpot& spot, const BranchSpot* before, double direction);

  /// The first frame, from a cycle at s, and the point there.
  std::optional<BranchSpot> begin(const Cycle& cycle, double s);

  /// True if the orbit has moved or changed its size so much that the frame no longer suits it.
  bool frame_is_worn(const BranchSpot& spot) const;

  /// Reason why the last solve() failed: the status of the map, or stalled if Newton did not contract.
  Status failure() const { return failure_; }
  bool invalid() const { return invalid_; }  ///< it left the valid range

 private:
  bool converge(BranchSpot& spot, const Eigen::VectorXd& normal, BranchJacobian& jacobian);
  bool complete(BranchSpot& spot, const Eigen::VectorXd& normal, const BranchJacobian& near, Derivatives derivatives);
  std::optional<BranchMap::Value> differentiate(const BranchSpot& spot, double rtol, Derivatives wanted,
                                                BranchJacobian& jacobian);
  void polish(BranchSpot& spot, const BranchMap::Value& loose) const;
  bool fill_cycle(BranchSpot& spot);
  bool fail(const BranchMap::Value& value);
  bool place_frame(const LoopState& start, const Trace& trace, double s, bool half);
  double slope_step(const Eigen::VectorXd& slope, double rtol) const;
  double loose_rtol() const;

  BranchMap& map_;
  double accuracy_;
  Status failure_ = Status::converged;
  bool invalid_ = false;
};

}  // namespace limcycle
