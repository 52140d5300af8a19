// The balance of several elements: two whose inputs are not the same have an amplitude each.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/balance/quasi_linear.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double most_wound_up = 1e5;  ///< of the amplitude at which a second element becomes nonlinear

/// True if an element's gain on the oscillation also acts on the harmonics that return to it (gravity).
bool gives_way(const Element& element) { return element.pull(0.0, 0.0).has_value(); }

}  // namespace

Complex FirstHarmonicBalance::other_gain(double input_amplitude, double frequency, double accuracy) const {
  DfOptions options;
  options.harmonics = 1;
  options.accuracy = std::clamp(accuracy, 1e-12, 1e-2);
  const auto& element = loop_->elements[*other_];
  if (const auto exact = element.exact_describing_function(input_amplitude, frequency, 0.0)) return *exact;
  return describing_function(element, {input_amplitude, frequency, 0.0}, options).gain;
}

/// The oscillations with this amplitude of the main element's input: one for each solution of the second.
std::vector<FirstHarmonicBalance::Oscillation> FirstHarmonicBalance::oscillations(double amplitude, double frequency,
                                                                                  double accuracy) const {
  const Eigen::VectorXcd W = own_outputs(amplitude, frequency, accuracy);
  if (!W.allFinite()) return {};
  const Eigen::MatrixXcd H = loop_->element_response(frequency);
  const auto m = static_cast<Index>(main_);
  if (!other_) return {{0, W, 1.0 - (H.row(m) * W).value() / amplitude}};
  const auto o = static_cast<Index>(*other_);
  const Complex reached = (H.row(o) * W).value(), back = H(o, o);
  const auto size = [&](double a) { return a * std::abs(1.0 - back * other_gain(a, frequency, accuracy)); };
  std::vector<Oscillation> found;
  for (const auto& answer :
       second_->own->answers(size, second_->reach.range(std::abs(back)), std::abs(reached), frequency, accuracy)) {
    Eigen::VectorXcd all = W, gains = Eigen::VectorXcd::Zero(W.size());
    if (reached != 0.0) {
      gains(o) = other_gain(answer.amplitude, frequency, accuracy);
      all(o) = gains(o) * reached / (1.0 - back * gains(o));
    }
    const Complex returning = (quasi_linear_response(*loop_, gains, frequency).row(m) * W).value();
    found.push_back({answer.branch, std::move(all), 1.0 - returning / amplitude});
  }
  return found;
}

/// The one nearest to the loop condition: at a root the one that satisfies it.
FirstHarmonicBalance::Oscillation FirstHarmonicBalance::oscillation(double amplitude, double frequency,
                                                                    double accuracy) const {
  auto all = oscillations(amplitude, frequency, accuracy);
  std::erase_if(all, [](const Oscillation& one) { return !std::isfinite(std::abs(one.left)); });
  if (all.empty()) return {0, Eigen::VectorXcd::Constant(std::ssize(loop_->elements), Complex(nan, nan)), {nan, nan}};
  return *std::ranges::min_element(all, {}, [](const Oscillation& one) { return std::abs(one.left); });
}

Complex FirstHarmonicBalance::on_branch(int branch, double amplitude, double frequency, double accuracy) const {
  for (const Oscillation& one : oscillations(amplitude, frequency, accuracy))
    if (one.branch == branch) return one.left;
  return {nan, nan};
}

/// Loeb's rule for two amplitudes. Both parts of the motion grow alike, so with s = j w + sigma
///   D(A, a, s) = 1 - (returning input of the main element)/A = 0,  a = |X(A, a, s)|,
/// with X the second element's input; differentiation gives d sigma / dA, which must be negative.
std::optional<bool> FirstHarmonicBalance::pair_returns(double amplitude, double frequency) const {
  const auto all = oscillation(amplitude, frequency, 1e-9);
  if (!std::isfinite(std::abs(all.left))) return std::nullopt;
  const auto m = static_cast<Index>(main_), o = static_cast<Index>(*other_);
  const double second = std::abs((loop_->element_response(frequency).row(o) * all.outputs).value());
  if (!(second > 0.0)) return std::nullopt;
  const auto at = [&](double A, double a, double w) {  // D and ln X
    const Eigen::MatrixXcd H = loop_->element_response(w);
    Eigen::VectorXcd W = own_outputs(A, w, 1e-9);
    const Complex N = other_gain(a, w, 1e-9), X = (H.row(o) * W).value() / (1.0 - H(o, o) * N);
    W(o) = N * X;
    return std::pair<Complex, Complex>(1.0 - (H.row(m) * W).value() / A, std::log(X));
  };
  constexpr double step = 1e-4;
  const auto slope = [&](double to_A, double to_a, double to_w) {
    const auto there = [&](double h) {
      return at(amplitude * std::exp(h * to_A), second * std::exp(h * to_a), frequency * std::exp(h * to_w));
    };
    const auto up = there(step), down = there(-step);
    Complex turn = up.second - down.second;
    turn.imag(std::remainder(turn.imag(), 2.0 * std::numbers::pi));
    return std::pair<Complex, Complex>((up.first - down.first) / (2.0 * step), turn / (2.0 * step));
  };
  const auto [D_A, X_A] = slope(1.0, 0.0, 0.0);
  const auto [D_a, X_a] = slope(0.0, 1.0, 0.0);
  const auto [D_w, X_w] = slope(0.0, 0.0, 1.0);
  const Complex D_s(D_w.imag(), -D_w.real());  // -j D_w: by sigma over the frequency
  Eigen::Matrix3d M;                           // of d ln a, d ln w, d sigma / w
  M << D_a.real(), D_w.real(), D_s.real(), D_a.imag(), D_w.imag(), D_s.imag(), 1.0 - X_a.real(), -X_w.real(),
      -X_w.imag();
  const Eigen::Vector3d right(-D_A.real(), -D_A.imag(), X_A.real());
  const double growth = M.fullPivLu().solve(right)(2);
  if (!std::isfinite(growth) || growth == 0.0) return std::nullopt;
  return growth < 0.0;
}

std::pair<double, double> FirstHarmonicBalance::second_range() const {
  return {0.9 * second_->reach.bend(), most_wound_up * second_->reach.bend()};
}

FirstHarmonicBalance::FromSecond FirstHarmonicBalance::from_second(int branch, double amplitude, double frequency,
                                                                   double accuracy) const {
  const Eigen::MatrixXcd H = loop_->element_response(frequency);
  const auto m = static_cast<Index>(main_), o = static_cast<Index>(*other_);
  const Complex N = other_gain(amplitude, frequency, accuracy);
  const Eigen::RowVectorXcd to_main = H.row(m);
  const auto size = [&](double A) { return std::abs(A - (to_main * own_outputs(A, frequency, accuracy)).value()); };
  const Complex drives = H(m, o) * N * amplitude;
  const auto answer =
      second_->main->answer_on(branch, size, main_range(std::abs(H(m, m))), std::abs(drives), frequency, accuracy);
  if (!answer) return {{nan, nan}, nan};
  Eigen::VectorXcd gains = own_outputs(answer->amplitude, frequency, accuracy) / answer->amplitude;
  for (const auto& [index, factor] : beside_) gains(static_cast<Index>(index)) /= factor;
  return {1.0 - N * quasi_linear_response(*loop_, gains, frequency)(o, o), answer->amplitude};
}

/// Amplitudes of the main element's input between which the size of the required drive can turn.
std::pair<double, double> FirstHarmonicBalance::main_range(double back) const {
  const Scales scales = loop_->elements[main_].scales();
  const double comes_back = back * scales.output;
  const double bend = scales.displacement < infinite ? scales.displacement : comes_back;
  const double high = 10.0 * std::max(bend, comes_back);
  return {std::max(0.1 * std::min(bend, comes_back), 1e-8 * high), high};
}

Complex FirstHarmonicBalance::response(double amplitude, double frequency, int order) const {
  const Eigen::MatrixXcd H = loop_->element_response(order * frequency);
  const auto m = static_cast<Index>(main_);
  if (loop_->elements.size() == 1) return H(m, m);
  Eigen::VectorXcd W = outputs(amplitude, frequency, 1e-9);
  const Eigen::VectorXcd inputs = loop_->element_response(frequency) * W;
  Eigen::VectorXcd N = Eigen::VectorXcd::Zero(W.size());  // of those that act on the harmonic that returns to them
  const auto answers = [&](Index k) {
    N(k) = inputs(k) == 0.0 ? 0.0 : W(k) / inputs(k);
    W(k) = 0.0;
  };
  if (other_) answers(static_cast<Index>(*other_));
  for (const auto& [index, factor] : beside_)
    if (gives_way(loop_->elements[index])) answers(static_cast<Index>(index));
  const Index ne = W.size();
  const Eigen::MatrixXcd back = Eigen::MatrixXcd::Identity(ne, ne) - H * N.asDiagonal();
  return solve_fully_pivoted(back, H * W)(m) / W(m);
}

}  // namespace limcycle
