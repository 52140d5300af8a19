#include "limcycle/analysis/motion/tolerances.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/reset_integrator.hpp"
#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/transfer.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double negligible = 1e-9;

/// Typical sizes of the linear states: of their responses to the elements, at the frequencies of the loop.
class LinearSizes {
 public:
  explicit LinearSizes(const Loop& loop) : loop_(loop), size_(VectorXd::Zero(loop.states())), at_(size_) {
    if (loop.states() > 0) poles_ = eigenvalues(loop.A);
    for (std::size_t k = 0; k < loop.elements.size(); ++k) levels_.push_back(output_level(loop, k));
  }

  State find() {
    std::vector<double> frequencies = pole_moduli(loop_);  // at which the linear part responds
    if (frequencies.empty()) frequencies.push_back(1.0);
    for (const double w : frequencies) respond(w);
    const double largest = size_.size() > 0 ? size_.maxCoeff() : 0.0;
    State result;
    for (Index i = 0; i < size_.size(); ++i)
      result.push_back(size_(i) > negligible * largest || answers(i) ? size_(i) : by_what_it_moves(i, largest));
    return result;
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

  /// Size of a state that no element moves: that of the states it moves itself.
  double by_what_it_moves(Index i, double largest) const {
    double found = infinite;
    for (Index k = 0; k < size_.size(); ++k)
      if (k != i && loop_.A(k, i) != 0.0 && size_(k) > 0.0)
        found = std::min(found, size_(k) * at_(k) / std::abs(loop_.A(k, i)));
    if (std::isfinite(found) && found > 0.0) return found;
    return largest > 0.0 ? negligible * largest : 1.0;
  }

  const Loop& loop_;
  Eigen::VectorXcd poles_;
  std::vector<double> levels_;  ///< of the elements' outputs
  VectorXd size_, at_;          ///< and the frequency that gave it, rad/s
};

/// Input scale over which the last element changes its behaviour; true if that is a rate.
std::pair<double, bool> own_input(const Element& element) {
  const Scales scales = element.scales();
  if (std::isfinite(scales.velocity)) return {scales.velocity, true};
  if (std::isfinite(scales.displacement)) return {scales.displacement, false};
  const double size = element.switching_input();
  return {size, false};
}

/// The frequency at which the output of the last element moves its own input by the scale over which it changes, in a
/// loop whose poles are all at the origin, where the response is a power of s; 0 if there is none.
double frequency_of_scales(const Loop& loop) {
  const auto [size, is_rate] = own_input(loop.elements.back());
  const Index last = std::ssize(loop.elements) - 1;
  const auto moves = [&, by_rate = is_rate](double w) {
    return std::abs(loop.element_response(w)(last, last)) * (by_rate ? w : 1.0) * loop.elements.back().scales().output;
  };
  const double at_one = moves(1.0), at_two = moves(2.0), power = std::log2(at_one / at_two);
  const double found = size > 0.0 && power > 0.5 ? std::pow(at_one / size, 1.0 / std::round(power)) : 0.0;
  return std::isfinite(found) ? found : 0.0;
}

/// The states that an element or the output sees, in the end: a part of a plant that reaches neither has no say in the
/// scales of the loop.
std::vector<Index> seen_states(const Loop& loop, const MatrixXd& A) {
  VectorXd seen = loop.C_y.cwiseAbs().transpose();
  for (const Port& port : loop.ports) {
    seen += (port.C.cwiseAbs() + port.C_v.cwiseAbs()).transpose();
    if (port.C_delayed.size() > 0) seen += port.C_delayed.cwiseAbs().transpose();
  }
  std::vector<Index> kept, fresh;
  const auto keep = [&](Index i) {
    if (std::ranges::find(kept, i) != kept.end()) return;
    kept.push_back(i);
    fresh.push_back(i);
  };
  for (Index i = 0; i < seen.size(); ++i)
    if (seen(i) != 0.0) keep(i);
  while (!fresh.empty()) {
    const Index i = fresh.back();
    fresh.pop_back();
    for (Index j = 0; j < A.cols(); ++j)
      if (A(i, j) != 0.0) keep(j);
  }
  std::ranges::sort(kept);
  return kept;
}

/// Moduli of the poles that are not zero. A pole at the origin of order k (a free body: 2; with an integrator before
/// it: 3) is computed as k small ones, of the kth root of rounding: how many of such a size are zero is decided by
/// ranks.
void add_moduli(const MatrixXd& A, std::vector<double>& found) {
  constexpr double rounding = 1e-14, doubtful_up_to = 1e-3;
  VectorXd moduli = eigenvalues(A).cwiseAbs();
  std::ranges::sort(moduli);
  const double largest = moduli.maxCoeff();
  const bool doubtful =
      std::ranges::any_of(moduli, [&](double m) { return m > negligible * largest && m < doubtful_up_to * largest; });
  const int zero = doubtful ? zero_modes(balanced(A)).times : 0;
  const double none_below = zero > 1 ? std::pow(rounding, 1.0 / zero) : negligible;
  for (Index i = 0; i < moduli.size(); ++i)
    if (moduli(i) > (i < zero ? none_below : negligible) * largest) found.push_back(moduli(i));
}

/// Factor on the velocity scale of a law whose steep_exponent() is below 1: for a force accurate to rtol, v must be
/// accurate to vs rtol^(1/delta), and implicit stages must not skip the steep part. A body that breaks away gains the
/// velocity of a tighter tolerance within the rounding of time: no step would pass.
double steepness(const Element& element, double rtol) {
  constexpr double tightest = 1e-7;
  const double delta = element.steep_exponent();
  return delta < 1.0 ? 1e-3 * std::pow(std::max(rtol, tightest), 1.0 / delta - 1.0) : 1.0;
}

/// On a belt a body is at rest at the belt's speed. Where the curve is infinitely steep there, the velocity is as small
/// as it differs from that: relative to itself, an error would be as large as a whole start of slip.
void count_from_rest(const Port& port, const External& external, ErrorWeights& weights) {
  const double speed = port.c_v.dot(external);
  std::optional<std::size_t> only;
  for (Index i = 0; i < port.C_v.size(); ++i) {
    if (port.C_v(i) == 0.0) continue;
    if (only) return;
    only = static_cast<std::size_t>(i);
  }
  if (!only || speed == 0.0) return;
  weights.origin.resize(weights.atol.size(), 0.0);
  weights.origin[*only] = -speed / port.C_v(static_cast<Index>(*only));
}

}  // namespace

MatrixXd working_loop(const Loop& loop) {
  const Index n = loop.states(), ne = std::ssize(loop.elements);
  MatrixXd C(ne, n), D(ne, ne);
  bool any = false;
  for (Index i = 0; i < ne; ++i) {
    const Port& port = loop.ports[static_cast<std::size_t>(i)];
    const auto [gain, rate_gain] = loop.elements[static_cast<std::size_t>(i)].working_gain();
    any = any || gain != 0.0 || rate_gain != 0.0;
    C.row(i) = gain * (port.C + port.C_delayed) + rate_gain * port.C_v;
    D.row(i) = gain * port.D + rate_gain * port.D_v;
  }
  if (!any) return loop.A + loop.A_delayed;
  const MatrixXd closed = MatrixXd::Identity(ne, ne) - D;
  return loop.A + loop.A_delayed + loop.B * solve_columns_fully_pivoted(closed, C);
}

namespace {

/// Gain of an integral that is the state of an element, as long as nothing holds it back.
std::optional<double> integral_gain(const Element& element) {
  if (const auto* pi = element.as<ClampedPi<double>>()) return pi->ki;
  if (const auto* integral = element.as<ResetIntegrator<double>>()) return integral->gain;
  if (const auto* integral = element.as<StopResetIntegrator<double>>()) return integral->gain;
  return std::nullopt;
}

bool is_reset(const Element& element) {
  return element.as<ResetIntegrator<double>>() != nullptr || element.as<StopResetIntegrator<double>>() != nullptr;
}

/// working_loop() on some states, with the integrals that are states of elements below them.
MatrixXd with_integrals(const Loop& loop, const MatrixXd& working, const std::vector<Index>& seen) {
  const Index n = std::ssize(seen);
  MatrixXd all = working(seen, seen);
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const auto gain = integral_gain(loop.elements[k]);
    if (!gain) continue;
    const Index own = all.rows();
    all.conservativeResizeLike(MatrixXd::Zero(own + 1, own + 1));
    all.col(own).head(n) = loop.B(seen, static_cast<Index>(k));
    all.row(own).head(n) = *gain * loop.ports[k].C(seen);
  }
  return all;
}

}  // namespace

std::vector<double> pole_moduli(const Loop& loop) {
  if (loop.continuous) return pole_moduli(*loop.continuous);
  std::vector<double> found;
  if (loop.states() == 0) return found;
  const MatrixXd tangent = loop.tangent();
  const auto seen = seen_states(loop, tangent);
  if (!seen.empty()) add_moduli(tangent(seen, seen), found);
  if (const MatrixXd working = working_loop(loop);
      working.allFinite() && (working != loop.A + loop.A_delayed || std::ranges::any_of(loop.elements, is_reset)))
    add_moduli(with_integrals(loop, working, seen), found);
  if (found.empty() && !loop.elements.empty())
    if (const double own = frequency_of_scales(loop); own > 0.0) found.push_back(own);
  std::ranges::sort(found);
  return found;
}

double slow_time(const Loop& loop) {
  const auto moduli = pole_moduli(loop);
  return moduli.empty() ? 1.0 : 1.0 / moduli.front();
}

double output_level(const Loop& loop, std::size_t element) {
  const auto* cubic = loop.elements[element].as<Cubic<double>>();
  if (!cubic || cubic->coefficient == 0.0) return loop.elements[element].scales().output;
  std::vector<double> frequencies = pole_moduli(loop);
  if (frequencies.empty()) frequencies.push_back(1.0);
  double response = 0.0;
  const auto k = static_cast<Index>(element);
  for (const double w : frequencies)
    if (const double here = std::abs(loop.element_response(std::complex<double>(0.1 * w, w))(k, k));
        std::isfinite(here))
      response = std::max(response, here);
  if (!(response > 0.0)) return loop.elements[element].scales().output;
  return 1.0 / (response * std::sqrt(response * std::abs(cubic->coefficient)));
}

State typical_sizes(const Loop& loop) {
  if (loop.continuous) return sampled_sizes(loop, LinearSizes(*loop.continuous).find());
  State result = LinearSizes(loop).find();
  const VectorXd linear = Eigen::Map<const VectorXd>(result.data(), loop.states());
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Element& element = loop.elements[i];
    const auto first = result.size();
    for (int k = 0; k < element.states(); ++k) result.push_back(element.state_scale(k));
    if (!is_reset(element)) continue;  // its integral has no size of its own
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

bool has_infinite_slope(const Loop& loop) {
  return std::ranges::any_of(loop.elements, [](const Element& element) { return element.steep_exponent() < 1.0; });
}

ErrorWeights loop_weights(const Loop& loop, double rtol) { return loop_weights(loop, rtol, typical_sizes(loop)); }

ErrorWeights loop_weights(const Loop& loop, double rtol, State typical, bool stuck) {
  if (!(rtol > 0.0 && rtol <= 0.1))
    throw std::invalid_argument("rtol must be in (0, 0.1], got " + std::to_string(rtol));
  ErrorWeights weights{rtol, std::move(typical), {}, std::exp2(std::round(std::log2(slow_time(loop))))};
  const auto n = static_cast<std::size_t>(loop.states());
  for (std::size_t i = 0; i < n; ++i) weights.atol[i] *= 1e-3;
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Scales scales = loop.elements[k].scales();
    const auto limit = [&](const Eigen::RowVectorXd& row, double scale) {
      if (!std::isfinite(scale)) return;
      for (std::size_t i = 0; i < n; ++i)
        if (const double part = std::abs(row(static_cast<Index>(i))); part > 0.0)
          weights.atol[i] = std::min(weights.atol[i], scale / part);
    };
    if (!loop.ports[k].rubs) continue;
    limit(loop.ports[k].C, scales.displacement);
    limit(loop.ports[k].C_v, scales.velocity * (stuck ? 1.0 : steepness(loop.elements[k], rtol)));
    if (loop.elements[k].steep_exponent() < 1.0) count_from_rest(loop.ports[k], loop.external, weights);
    // The rubbing velocity of a belt is a difference from its speed: no tolerance may ask for less than its rounding.
    const double speed = std::abs(loop.ports[k].c_v.dot(loop.external));
    for (std::size_t i = 0; i < n; ++i)
      if (const double part = std::abs(loop.ports[k].C_v(static_cast<Index>(i))); part > 0.0)
        weights.atol[i] = std::max(weights.atol[i], 1e-6 * speed / part);
  }
  // A loop whose numbers over- or underflow is still marched, as far as possible.
  constexpr double least = std::numeric_limits<double>::min(), most = std::numeric_limits<double>::max();
  for (auto& value : weights.atol) value = std::isnan(value) ? rtol : std::clamp(value * rtol, least, most);
  return weights;
}

}  // namespace limcycle
