#include "limcycle/analysis/motion/time_scales.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/transfer.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double negligible = 1e-9;

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
  const MatrixXd even = doubtful ? balanced(A) : MatrixXd();
  const int zero = doubtful ? zero_modes(even).times : 0;
  const double none_below = zero > 1 ? std::pow(rounding, 1.0 / zero) * std::max(largest, even.norm()) : 0.0;
  for (Index i = 0; i < moduli.size(); ++i)
    if (moduli(i) > std::max(negligible * largest, i < zero ? none_below : 0.0)) found.push_back(moduli(i));
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
      working.allFinite() &&
      (working != loop.A + loop.A_delayed || std::ranges::any_of(loop.elements, resets_integral)))
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

}  // namespace limcycle
