#include "limcycle/analysis/motion/typical_sizes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double hardly = 1e-9;  ///< a response that small, relative to the largest, may be rounding

/// Those of a loop at which its linear part responds, rad/s.
std::vector<double> frequencies_of(const Loop& loop) {
  std::vector<double> frequencies = pole_moduli(loop);
  if (frequencies.empty()) frequencies.push_back(1.0);
  return frequencies;
}

/// Typical sizes of the linear states: of their responses to the elements, at some frequencies.
class LinearSizes {
 public:
  LinearSizes(const Loop& loop, const std::vector<double>& frequencies)
      : loop_(loop), size_(VectorXd::Zero(loop.states())), at_(size_) {
    if (loop.states() > 0) poles_ = eigenvalues(loop.A);
    for (std::size_t k = 0; k < loop.elements.size(); ++k) levels_.push_back(output_level(loop, k));
    for (const double w : frequencies) respond(w);
    largest_ = size_.size() > 0 ? size_.maxCoeff() : 0.0;
  }

  /// Of a state that the elements move; else nothing.
  std::optional<double> response(Index i) const {
    return size_(i) > hardly * largest_ || answers(i) ? std::optional(size_(i)) : std::nullopt;
  }

  /// Size of a state that no element moves: that of the states it moves itself.
  double by_what_it_moves(Index i) const {
    double found = infinite;
    for (Index k = 0; k < size_.size(); ++k)
      if (k != i && loop_.A(k, i) != 0.0 && size_(k) > 0.0)
        found = std::min(found, size_(k) * at_(k) / std::abs(loop_.A(k, i)));
    if (std::isfinite(found) && found > 0.0) return found;
    return largest_ > 0.0 ? hardly * largest_ : 1.0;
  }

 private:
  /// s I - A at s = j w; at (0.1 + j) w where an undamped pole is, as a resonance does not count as infinite.
  Eigen::MatrixXcd resolvent(double w) const {
    const Index n = loop_.states();
    std::complex<double> s(0.0, w);
    for (const auto& pole : poles_)
      if (std::abs(pole.imag() - w) < 1e-3 * w && std::abs(pole.real()) < 1e-3 * w) s = {0.1 * w, w};
    return s * Eigen::MatrixXcd::Identity(n, n) - loop_.A.cast<std::complex<double>>();
  }

  /// Full pivoting treats pivots much smaller than the largest as zero, although only their units may be small.
  static Eigen::MatrixXcd solution(const Eigen::MatrixXcd& M, const Eigen::MatrixXcd& right) {
    const Eigen::FullPivLU<Eigen::MatrixXcd> pivoted(M);
    if (pivoted.isInvertible()) return pivoted.solve(right);
    return solve_columns(M, right);
  }

  void respond(double w) {
    const Eigen::MatrixXcd response = solution(resolvent(w), loop_.B.cast<std::complex<double>>());
    for (Index i = 0; i < size_.size(); ++i)
      for (Index k = 0; k < response.cols(); ++k) {
        const double level = std::abs(response(i, k)) * levels_[static_cast<std::size_t>(k)];
        if (!std::isfinite(level) || level <= size_(i)) continue;
        size_(i) = level;
        at_(i) = w;
      }
  }

  /// True if a response that is small compared with the others, in whatever units, exceeds their rounding.
  bool answers(Index i) const {
    if (!(size_(i) > 0.0)) return false;
    const Eigen::MatrixXcd M = resolvent(at_(i));
    const MatrixXd inverse = solve_columns(M, Eigen::MatrixXcd::Identity(M.rows(), M.cols())).cwiseAbs();
    const MatrixXd noise = inverse.row(i) * M.cwiseAbs() * inverse * loop_.B.cwiseAbs();
    double largest = 0.0;
    for (Index k = 0; k < noise.cols(); ++k)
      largest = std::max(largest, noise(0, k) * levels_[static_cast<std::size_t>(k)]);
    return size_(i) > 1e-13 * largest;
  }

  const Loop& loop_;
  Eigen::VectorXcd poles_;
  std::vector<double> levels_;  ///< of the elements' outputs
  VectorXd size_, at_;          ///< and the frequency that gave it, rad/s
  double largest_ = 0.0;
};

/// A far limit says nothing about motions within it: those are the responses of the closed loop to what else it has.
State linear_sizes(const Loop& loop) {
  const std::vector<double> frequencies = frequencies_of(loop);
  const LinearSizes open(loop, frequencies);
  State result;
  for (Index i = 0; i < loop.states(); ++i) result.push_back(open.response(i).value_or(open.by_what_it_moves(i)));
  if (std::ranges::none_of(loop.elements, [](const Element& one) { return command_limit(one) > 0.0; })) return result;
  const Loop closed = with_gains(loop, loop.elements.size(), within_limit);
  if (!closed.A.allFinite()) return result;
  const LinearSizes within(closed, frequencies);
  for (Index i = 0; i < loop.states(); ++i)
    if (const auto size = within.response(i)) {
      double& here = result[static_cast<std::size_t>(i)];
      here = std::min(here, *size);
    }
  return result;
}

}  // namespace

double output_level(const Loop& loop, std::size_t element) {
  const auto* cubic = loop.elements[element].as<Cubic<double>>();
  if (!cubic || cubic->coefficient == 0.0) return loop.elements[element].scales().output;
  double response = 0.0;
  const auto k = static_cast<Index>(element);
  for (const double w : frequencies_of(loop))
    if (const double here = std::abs(loop.element_response(std::complex<double>(0.1 * w, w))(k, k));
        std::isfinite(here))
      response = std::max(response, here);
  if (!(response > 0.0)) return loop.elements[element].scales().output;
  return 1.0 / (response * std::sqrt(response * std::abs(cubic->coefficient)));
}

State typical_sizes(const Loop& loop) {
  if (loop.continuous) return sampled_sizes(loop, linear_sizes(*loop.continuous));
  State result = linear_sizes(loop);
  const VectorXd linear = Eigen::Map<const VectorXd>(result.data(), loop.states());
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Element& element = loop.elements[i];
    const auto first = result.size();
    for (int k = 0; k < element.states(); ++k) result.push_back(element.state_scale(k));
    if (!resets_integral(element)) continue;  // its integral has no size of its own
    const double input = loop.ports[i].C.cwiseAbs().dot(linear), size = *integral_gain(element) * input;
    if (size != 0.0) result[first] = std::abs(size) * slow_time(loop);
  }
  return result;
}

double typical_rubbing_velocity(const Loop& loop) {
  const Port& port = loop.ports.back();
  const State sizes = typical_sizes(loop);
  const auto states = Eigen::Map<const VectorXd>(sizes.data(), loop.states());
  return (port.C_v.cwiseAbs() * states + port.c_v.cwiseAbs() * loop.external.cwiseAbs()).value();
}

}  // namespace limcycle
