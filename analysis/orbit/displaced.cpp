#include <Eigen/Dense>
#include <cmath>
#include <complex>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

constexpr double wide_gap = 1e3;       ///< between the frequencies of a loop that are told apart as slow and fast
constexpr double lasting_share = 0.1;  ///< of y, that must be left once the fast part of a motion has died out

/// A frequency in the widest gap between those of the loop; 0 if there is no wide one.
double between_slow_and_fast(const std::vector<double>& frequencies) {
  double widest = wide_gap, middle = 0.0;
  for (std::size_t i = 0; i + 1 < frequencies.size(); ++i) {
    const double ratio = frequencies[i + 1] / frequencies[i];
    if (ratio <= widest) continue;
    widest = ratio;
    middle = std::sqrt(frequencies[i] * frequencies[i + 1]);
  }
  return middle;
}

/// Does y stay displaced once the fast part of the motion has died out? s Y(s) at a real s between slow and fast is
/// what y is then.
bool lasts(const Loop& loop, const Eigen::VectorXd& direction, double s) {
  const Eigen::Index n = loop.states();
  const Eigen::VectorXd x = solve(Eigen::MatrixXd(s * Eigen::MatrixXd::Identity(n, n) - loop.A), direction);
  return std::abs(s * (loop.C_y * x).value()) > lasting_share * std::abs((loop.C_y * direction).value());
}

/// The states at the turning point of y on the oscillation that the last element causes at frequency w.
Eigen::VectorXd turning_state(const Loop& loop, double w) {
  const Eigen::Index n = loop.states();
  const Eigen::MatrixXcd M =
      std::complex<double>(0.0, w) * Eigen::MatrixXcd::Identity(n, n) - loop.A.cast<std::complex<double>>();
  const Eigen::VectorXcd x = solve(M, Eigen::VectorXcd(loop.B.rightCols(1).cast<std::complex<double>>()));
  const std::complex<double> y = (loop.C_y.cast<std::complex<double>>() * x).value();
  return (x / y).real();
}

/// The direction that moves y and, in units of their typical sizes, the other states as little as possible.
Eigen::VectorXd shortest(const Loop& loop) {
  const State sizes = typical_sizes(loop);
  Eigen::VectorXd direction = loop.C_y.transpose();
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    direction(i) *= sizes[static_cast<std::size_t>(i)] * sizes[static_cast<std::size_t>(i)];
  return direction / (loop.C_y * direction).value();
}

}  // namespace

LoopState displaced(const Loop& loop, double displacement) {
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  Eigen::VectorXd direction = shortest(loop);
  const auto frequencies = pole_moduli(loop);
  if (const double s = between_slow_and_fast(frequencies); s > 0.0 && !lasts(loop, direction, s))
    if (const Eigen::VectorXd slow = turning_state(loop, frequencies.front()); slow.allFinite()) direction = slow;
  return without_history(loop, rest + displacement * direction);
}

}  // namespace limcycle
