#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "limcycle/analysis/frequency/march/element_march.hpp"
#include "limcycle/analysis/frequency/march/indifferent_map.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// The periodic steady state of an element under prescribed motion: the state at the beginning of a period, to which it
/// returns.
struct PeriodicState {
  Status status = Status::converged;
  ElementState state;              ///< at the origin of the motion's period
  bool symmetric = false;          ///< half-wave symmetric: half a period was visited, the rest mirrors it
  double defect = 0.0;             ///< bound of the distance of the state from the fixed point, in units of `scale`
  std::vector<double> scale = {};  ///< size of each state in this motion
};

/// Finds the periodic state as a fixed point of the period map, by Newton with the map's own derivative (one correction
/// where the map is affine, as for LuGre and Dahl with exponent 1); never by waiting for a transient to decay.
///
/// For an odd element without bias the half-period map followed by mirroring is tried first, which singles out the
/// half-wave symmetric state where many are periodic (elastic ranges). If that map has none (a relay that never
/// switches) or the motion is biased, the full map is used, from the virgin state; where it is indifferent (derivative
/// 1) the state reached is kept.
template <Motion M = PrescribedMotion>
class PeriodicStateSearch {
 public:
  /// `tolerance`: required distance from the fixed point, in units of state_scale.
  PeriodicStateSearch(ElementMarch<M>& march, const PeriodMesh& mesh, bool try_symmetric, double tolerance)
      : march_(march),
        mesh_(mesh),
        n_(march.states()),
        try_symmetric_(try_symmetric),
        tolerance_(std::max(tolerance, 4e-15)) {}

  /// `visitor` is restarted before each pass that may be the last; `guess` (or null) is a state known to be close.
  template <class Visitor>
  PeriodicState find(Visitor& visitor, const PeriodicState* guess) {
    const bool from_guess = try_symmetric_ && guess != nullptr && guess->symmetric;
    if (from_guess) {
      PeriodicState result = iterate(guess->state, true, visitor);
      if (result.status == Status::converged || result.status == Status::not_finite) return result;
    }
    // On a finer mesh start from the virgin state again: where many states are periodic, the guess may be another one.
    ElementState virgin = march_.virgin();
    NoVisitor nothing;
    const Status status = march_.march(mesh_.virgin, virgin, nothing);
    if (status != Status::converged) return {status, virgin, false, 0.0};
    // What is not symmetric on a coarse mesh is not on a fine one.
    if (try_symmetric_ && (guess == nullptr || from_guess)) {
      PeriodicState result = iterate(virgin, true, visitor);
      if (result.status == Status::converged || result.status == Status::not_finite) return result;
      if (result.status == Status::no_cycle) virgin = result.state;
    }
    return iterate(virgin, false, visitor);
  }

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::VectorXd;

  template <class Visitor>
  Status pass(ElementState& state, bool half, Visitor& visitor) {
    state.sensitivity.assign(n_ * n_, 0.0);
    for (std::size_t p = 0; p < n_; ++p) state.sensitivity[p * n_ + p] = 1.0;
    march_.restart();
    Status status = march_.march(mesh_.first, state, visitor);
    if (half) {
      state.mode = march_.element().mirror(state.mode);
      for (std::size_t p = 0; p < n_; ++p) {
        if (march_.element().even_state(static_cast<int>(p))) continue;
        state.z[p] = -state.z[p];
        for (std::size_t q = 0; q < n_; ++q) state.sensitivity[p * n_ + q] = -state.sensitivity[p * n_ + q];
      }
    } else if (status == Status::converged) {
      status = march_.march(mesh_.second, state, visitor);
    }
    for (const double z : state.z)
      if (!std::isfinite(z)) status = Status::not_finite;
    return status;
  }

  double scale(std::size_t p) const { return march_.scale(p); }

  double size(const Vector& r) const {
    double worst = 0.0;
    for (std::size_t p = 0; p < n_; ++p) worst = std::max(worst, std::abs(r(static_cast<Eigen::Index>(p))) / scale(p));
    return worst;
  }

  /// Correction of a state that the map moves by r: (1 - M)^-1 r, the limit of applying the map with the derivative M
  /// for ever, less the state; what is unused stays. With indifferent directions (M = 1) the group inverse of 1 - M,
  /// which leaves them unchanged, if `near` the end, since farther away the path may bend into them. Zero: apply the
  /// map.
  Vector correction(const ElementState& image, const Vector& r, bool near, double& amplification) const {
    const auto n = static_cast<Eigen::Index>(n_);
    std::vector<char> used(n_);
    for (std::size_t p = 0; p < n_; ++p) used[p] = march_.element().unused(image.mode, static_cast<int>(p)) ? 0 : 1;
    Matrix m = Matrix::Zero(n, n);
    Vector scaled(n);
    for (std::size_t p = 0; p < n_; ++p) {
      const auto row = static_cast<Eigen::Index>(p);
      scaled(row) = -r(row) / scale(p);
      for (std::size_t q = 0; q < n_; ++q)
        if (used[p] != 0 && used[q] != 0)
          m(row, static_cast<Eigen::Index>(q)) =
              (image.sensitivity[p * n_ + q] - (p == q ? 1.0 : 0.0)) * scale(q) / scale(p);
    }
    Vector step = indifferent_correction(m, scaled, near, amplification);
    for (Eigen::Index p = 0; p < n; ++p) step(p) *= scale(static_cast<std::size_t>(p));
    return step;
  }

  /// Newton while it helps. Where it did not (a kink of the map, or a jump), the map itself once, twice, four times as
  /// often before it is tried again, since the map of any sound law contracts.
  class Turns {
   public:
    bool newton(bool gained) {
      if (tried_ && !gained) {
        maps_ = patience_;
        patience_ = std::min(2 * patience_, 8);
      }
      tried_ = maps_ == 0;
      if (!tried_) --maps_;
      return tried_;
    }

   private:
    bool tried_ = false;
    int maps_ = 0, patience_ = 1;
  };

  /// Status no_cycle: a motion whose halves end in two modes in turn is not half-wave symmetric; the state is then the
  /// start, or that after some whole periods from it.
  template <class Visitor>
  PeriodicState iterate(const ElementState& start, bool half, Visitor& visitor) {
    PeriodicState result{Status::converged, start, half, 0.0};
    double before = infinite, near = std::max(1e-6, std::sqrt(tolerance_));
    double best = infinite;
    int foreign_modes = 0, to_and_fro = 0, without_gain = 0;
    Mode last_but_one = start.mode;
    ElementState whole = start;  // reached by the map alone, in whole periods
    bool by_map_alone = true;
    Turns turns;
    for (int k = 0; k < 200; ++k) {
      visitor.restart();
      ElementState image = result.state;
      result.status = pass(image, half, visitor);
      if (result.status != Status::converged) return result;
      if (image.mode != result.state.mode) {
        to_and_fro = half && image.mode == last_but_one ? to_and_fro + 1 : 0;
        last_but_one = result.state.mode;
        result.state = image;
        if (by_map_alone && k % 2 == 1) whole = image;
        if (++foreign_modes > 20) break;
        if (to_and_fro > 1 || (to_and_fro > 0 && by_map_alone && k % 2 == 1)) {
          result.state = whole;
          result.status = Status::no_cycle;
          return result;
        }
        continue;
      }
      Vector r(static_cast<Eigen::Index>(n_));
      for (std::size_t p = 0; p < n_; ++p) r(static_cast<Eigen::Index>(p)) = image.z[p] - result.state.z[p];
      const double now = size(r);
      double amplification = 1.0;
      const Vector step = n_ == 0 ? r : correction(image, r, now < near, amplification);
      const double distance = std::max(now, n_ == 0 ? 0.0 : size(step));
      result.defect = distance + 1e-15 * amplification;
      result.scale.resize(n_);
      for (std::size_t p = 0; p < n_; ++p) result.scale[p] = scale(p);
      const bool indifferent = n_ == 0 || size(step) == 0.0;
      // A map with small jumps (a level followed by switches) has no better fixed point; `defect` shows it.
      without_gain = distance < 0.5 * best ? 0 : without_gain + 1;
      best = std::min(best, distance);
      if (without_gain > 3 && distance <= 100.0 * tolerance_) return result;
      if (distance <= tolerance_ || (now >= 0.25 * before && distance <= 1e-11) || (indifferent && now <= 1e-14))
        return result;
      // Where the map itself arrives, a step of Newton would only leave its range.
      const bool newton = turns.newton(now < 0.5 * before) && size(step) > 0.0 && size(step - r) > 0.5 * tolerance_;
      for (std::size_t p = 0; p < n_; ++p)
        result.state.z[p] = newton ? result.state.z[p] + step(static_cast<Eigen::Index>(p)) : image.z[p];
      result.state.mode = image.mode;
      by_map_alone = by_map_alone && !newton;
      if (by_map_alone && k % 2 == 1) whole = image;
      before = now;
    }
    result.status = Status::max_iterations;
    return result;
  }

  ElementMarch<M>& march_;
  const PeriodMesh& mesh_;
  std::size_t n_;
  bool try_symmetric_;
  double tolerance_;
};

}  // namespace limcycle
