#pragma once
#include <Eigen/Core>
#include <complex>
#include <limits>
#include <optional>
#include <vector>

#include "limcycle/analysis/orbit/cycle/return_map.hpp"
#include "limcycle/analysis/orbit/cycle/section_chart.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"

namespace limcycle {

/// Loosest tolerance of an integration that shooting uses: beyond, a cycle with stick may be lost.
inline constexpr double loosest_shooting_rtol = 1e-6;
/// Error of the derivative of a return map, along the motion itself, beyond which it tells nothing.
inline constexpr double lost_derivative = 0.5;

/// Newton's method for a fixed point of a return map: from states near it to the point, its derivative and its
/// multipliers. Call warm_up(), then solve(), then the rest.
class FixedPoint {
 public:
  FixedPoint(const Loop& loop, ReturnMap map, const ShootingOptions& options);

  /// Maps the guess until it changes little.
  Status warm_up(const LoopState& guess);
  /// Brings the residual below the tolerance; on return state() is the best point and residual_size() its residual.
  /// `most_maps`: with all before, if that is less than the options allow.
  Status solve(double rtol, double tolerance, int most_maps = std::numeric_limits<int>::max());
  /// Relative difference in period and amplitude between the solution and that of a looser integration, which is so
  /// close that the derivative of the map leads to it.
  Status compare(double loose, double& difference);
  /// Derivative of the map at state(), integrated at its own tolerance. Status stalled: a switch is grazed there.
  Status linearise(double rtol);
  /// True if the derivative is already known, at this tolerance and close enough. (A Jacobian that was too old is
  /// discarded, and at a grazed switch there is none.)
  bool is_linear_at(double rtol) const;
  /// Change of the state that the map neither reduces nor, but for states of which this is known (see remembered()),
  /// enlarges; empty if there is none.
  Eigen::VectorXd neutral() const;
  /// See Cycle::remembered; states that are zero and stay so remember nothing.
  int remembered() const;
  /// Multipliers of the (half) map, from the factors of its derivative, without those of kept combinations (see
  /// find_kept). The trivial one is removed; its deviation from 1 gives their error.
  std::vector<std::complex<double>> multipliers(double& trivial_error) const;

  /// False if the map of a march without error changes a state by a good part of all that it does on the orbit: far
  /// below the typical sizes, where the residual is blind, every state of a motion that decays may be as small as that.
  bool repeats_small_states() const;

  const LoopState& state() const { return state_; }
  double period() const { return map_.half() ? 2.0 * time_ : time_; }
  double amplitude() const { return amplitude_; }
  const Trace& trace() const { return trace_; }
  double residual_size() const { return residual_; }
  const std::optional<Reflection>& reflection() const { return map_.reflection(); }
  int maps() const { return maps_; }
  long steps() const { return map_.steps(); }

 private:
  Status find_jacobian(double rtol, Eigen::Index size);
  bool newton(ReturnMap::Result& image, Eigen::VectorXd& r, bool fresh);
  void improve_jacobian(const Eigen::VectorXd& step, const Eigen::VectorXd& change);
  Eigen::MatrixXd away_from(double multiplier) const;
  Eigen::VectorXd newton_step(const Eigen::VectorXd& r) const;
  Status compare_anew(double loose, double& difference);
  void find_kept();
  bool is_kept(Eigen::Index state) const { return kept_.rows() > 0 && kept_.row(state - first_).norm() > 1.0 - 1e-9; }
  ReturnMap::Result map(const LoopState& from) {
    ++maps_;
    return map_(from);
  }
  Eigen::VectorXd residual(const ReturnMap::Result& image) const {
    return chart_->coordinates(image.state.x, state_.x);
  }

  ReturnMap map_;
  const ShootingOptions& options_;
  Eigen::Index first_;    ///< index of the first element state
  Eigen::MatrixXd kept_;  ///< see find_kept: by columns, orthonormal, in units of the chart
  Eigen::Index turned_ = 0;
  State typical_, largest_, image_;
  std::optional<SectionChart> chart_;
  LoopState state_;
  ReturnMap::Result linear_;
  LoopState linear_at_;
  double linear_rtol_ = 0.0;
  Trace trace_;
  Eigen::MatrixXd jacobian_;
  double residual_ = infinite, time_ = 0.0, amplitude_ = 0.0;
  int maps_ = 0, stuck_ = 0;
  bool no_derivative_ = false;  ///< see find_jacobian
};

}  // namespace limcycle
