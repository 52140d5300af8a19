#include "limcycle/analysis/orbit/settle/displaced.hpp"

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

constexpr double slowly = 1e-4;       ///< rate of a quasi-static motion, relative to the slowest pole
constexpr double far_reach = 1e3;     ///< largest displacement of the states in it, relative to that near that pole
constexpr double no_response = 1e-9;  ///< response of y, relative to the others in their typical sizes

/// The states at a turning point of y = cos(w t), in the response to a harmonic input on this column; empty if y does
/// not respond.
Eigen::VectorXd turning_state(const Loop& loop, const Eigen::VectorXd& input, double w, const Eigen::VectorXd& sizes) {
  const Eigen::Index n = loop.states();
  const Eigen::MatrixXcd M = std::complex<double>(0.0, w) * Eigen::MatrixXcd::Identity(n, n) -
                             (loop.tangent() + loop.A_delayed).cast<std::complex<double>>();
  const Eigen::VectorXcd X = solve(M, Eigen::VectorXcd(input.cast<std::complex<double>>()));
  const std::complex<double> y = (loop.C_y.cast<std::complex<double>>() * X).value();
  const double parts = (loop.C_y.cwiseAbs() * X.cwiseAbs()).value();
  if (!(std::abs(y) > no_response * parts) || !X.allFinite()) return {};
  Eigen::VectorXd state = (X / y).real();
  // Remainders of rates in a slow motion, and rounding, are set to zero.
  const double reach = state.cwiseQuotient(sizes).cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < n; ++i)
    if (std::abs(state(i)) < slowly * reach * sizes(i) * 1e-2) state(i) = 0.0;
  const double moved = (loop.C_y * state).value();
  return std::abs(moved - 1.0) < 1e-3 ? Eigen::VectorXd(state / moved) : Eigen::VectorXd();
}

/// The direction that moves y and, in units of their typical sizes, the other states as little as possible.
Eigen::VectorXd shortest(const Loop& loop, const Eigen::VectorXd& sizes) {
  const Eigen::VectorXd direction = sizes.cwiseAbs2().cwiseProduct(loop.C_y.transpose());
  return direction / (loop.C_y * direction).value();
}

}  // namespace

LoopState scaled(const Loop& loop, const LoopState& state, double factor) {
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  LoopState moved = state;
  Eigen::Map<Eigen::VectorXd> X(moved.x.data(), rest.size());
  X = rest + factor * (X - rest);
  return moved;
}

LoopState displaced(const Loop& loop, double displacement) {
  if (loop.continuous) {
    const LoopState of_continuous = displaced(*loop.continuous, displacement);
    return sampled_state(loop, Eigen::Map<const Eigen::VectorXd>(of_continuous.x.data(), loop.continuous->states()));
  }
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  const State typical = typical_sizes(loop);
  const Eigen::VectorXd sizes = Eigen::Map<const Eigen::VectorXd>(typical.data(), loop.states());
  const double slow = 1.0 / slow_time(loop);
  // The same place with a limit of the command that is not reached as without one.
  const Loop within = with_gains(loop, loop.elements.size(), within_limit);
  for (const Eigen::VectorXd& input :
       {Eigen::VectorXd(within.E.col(reference_value)), Eigen::VectorXd(within.E.col(external_force)),
        Eigen::VectorXd(within.B.rightCols(1))}) {
    Eigen::VectorXd direction = turning_state(within, input, slowly * slow, sizes);
    const Eigen::VectorXd faster = turning_state(within, input, slow, sizes);
    const auto reach = [&](const Eigen::VectorXd& state) { return state.cwiseQuotient(sizes).cwiseAbs().maxCoeff(); };
    if (faster.size() > 0 && (direction.size() == 0 || reach(direction) > far_reach * reach(faster)))
      direction = faster;
    if (direction.size() > 0) return without_history(loop, rest + displacement * direction);
  }
  return without_history(loop, rest + displacement * shortest(loop, sizes));
}

}  // namespace limcycle
