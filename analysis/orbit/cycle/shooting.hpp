#pragma once
#include <functional>
#include <string>

#include "limcycle/analysis/orbit/cycle/return_map.hpp"

namespace limcycle {

/// Options of shooting.
struct ShootingOptions {
  double rtol = 3e-12;       ///< of the integration; the answer is no better than this
  double tolerance = 1e-10;  ///< on the scaled residual |P(x) - x| of the return map
  /// Wanted relative error of period and amplitude: while the estimate is larger the integration is made tighter (and
  /// the tolerance on the residual with it). 0: rtol decides.
  double accuracy = 0.0;
  /// Tolerance of the derivative of the map that gives the multipliers (a second one, ten times as loose, gives their
  /// error); tighter if that leaves the stability open. 0: neither multipliers nor a verdict on stability are wanted.
  double derivative_rtol = 1e-10;
  int resolution = 1000;  ///< least number of steps in the recorded period
  int warm_maps = 4;      ///< plain maps before the first Newton step (0: start from the guess itself)
  int max_maps = 400;     ///< limit
  long max_steps_per_map = 200000;
  long max_steps = 1'000'000'000;  ///< in all maps: none is begun once as many are done
  double longest_map = infinite;   ///< s: a motion that has not returned by then is abandoned
  int returns = 1;                 ///< crossings of the section in one period, see returns_of
  std::function<bool()> stop;
};

/// A cycle found by shooting, or the reason why there is none.
struct ShootingResult {
  Status status = Status::no_cycle;
  Cycle cycle;                    ///< meaningful only if status is converged
  std::string why;                ///< one sentence
  int maps = 0;                   ///< return maps computed
  long steps = 0;                 ///< of the integrator, in all of them
  double multiplier_error = 0.0;  ///< estimated absolute error of the Floquet multipliers of the map
  double trivial_error = 0.0;     ///< deviation of the trivial multiplier from 1
  Eigen::VectorXd neutral;  ///< change of the state whose multiplier cannot be told from 1; empty if there is none
};

/// Section through a trace on which the loop returns transversally: y at 27 % of its swing above the middle (off the
/// middle, where relays switch), in the direction in which y moves faster.
Section choose_section(const Loop& loop, const Trace& trace);

/// Number of times that a trace of one period crosses the section in its direction; at least 1.
int returns_of(const Section& section, const Trace& trace);

/// Solves x = P(x) for the return map on `section`, from a guess near the cycle; of the half map if the loop has an odd
/// symmetry and the guess shows it (`half`). A few plain maps come first (cold Newton breaks down on stick-slip), then
/// damped Newton with the exact derivative of the map (variational equations and saltation), kept as long as it
/// contracts, with plain maps as the fallback. Where the derivative of P - x is singular (a family of cycles, a neutral
/// direction) the step of least norm is taken, which is the bordered solution. Coarse integration first; the difference
/// to an integration a hundred times as loose is the error estimate. Finds unstable cycles as well (with warm_maps =
/// 0).
///
/// Multipliers: eigenvalues of the product of the step derivatives (product_eigenvalues), so that strongly contracting
/// ones are accurate too. No verdict on stability if the largest is within four times its error of 1, the error being
/// at least that of the trivial multiplier, or if that error is more than 0.1.
ShootingResult shoot(const Loop& loop, const LoopState& guess, const Section& section, bool half,
                     const ShootingOptions& options = {});

}  // namespace limcycle
