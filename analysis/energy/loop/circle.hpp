#pragma once
#include <optional>
#include <string>
#include <utility>

#include "limcycle/analysis/energy/loop/positive_real.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Least and greatest slope of the chords of a memoryless, single-valued element; the greatest may be infinite (a cubic
/// that rises). Empty for anything with memory, with jumps, or that acts on a rate.
std::optional<std::pair<double, double>> chord_slopes(const Element& element);

/// Two proofs that the loop x = -G n(x), n memoryless with slopes in [alpha, beta] and G rational, has no cycle,
/// decided without gridding frequencies. With psi = n - alpha x, of slopes in [0, k], k = beta - alpha, and G' = G/(1 +
/// alpha G):
///
/// Circle criterion (I. W. Sandberg 1964, G. Zames 1966; Khalil, Nonlinear Systems, section 7.1), for differences of
/// the motion and of itself shifted in time, so that no bias matters: over a period int d_psi (k d_x - d_psi) >= 0,
/// hence
///   sum over harmonics (1/k + Re G'(jkw)) |d_psi_k|^2 <= 0;   none if 1/k + Re G'(jw) > 0 at every w > 0.
///
/// Popov's criterion (V. M. Popov 1961), for deviations from the equilibrium: int psi dx/dt = 0 over a period, so that
///   1/k + Re (1 + j w q) G'(jw) > 0 at every w, for some real q, is enough
/// (of either sign, since a periodic motion does not require stability). The search for q is exact: at every q that
/// fails, the frequency where it fails most cuts off the side on which that frequency goes on failing; the remaining
/// range is halved.
class CircleCriterion {
 public:
  explicit CircleCriterion(const Loop& loop);

  const Answer& applies() const { return applies_; }
  double alpha() const { return alpha_; }
  double beta() const { return beta_; }

  /// Circle criterion: 1/k + Re G'(jw), its infimum over w > 0, which proves that there is no cycle if positive.
  /// Requires applies().
  const RealPart::Least& circle_margin() const { return circle_->least(); }
  const Answer& circle() const { return circle_answer_; }
  /// Popov's criterion; the multiplier q (s) if it is proved.
  const Answer& popov() const { return popov_answer_; }
  std::optional<double> multiplier() const { return q_; }
  /// Either criterion.
  Answer no_cycle() const;

 private:
  Answer check(const Loop& loop);
  StateSpace with_multiplier(double q) const;
  void answer_circle();
  void answer_popov(const Loop& loop);
  bool equilibrium_allows(const Loop& loop);
  void search_multiplier();

  Answer applies_, circle_answer_, popov_answer_;
  double alpha_ = 0.0, beta_ = 0.0, inverse_k_ = 0.0;
  StateSpace G_;  ///< G'
  bool free_mode_ = false;
  std::optional<RealPart> circle_;
  std::optional<double> q_;
};

}  // namespace limcycle
