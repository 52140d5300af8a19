#include "limcycle/analysis/study/loop_balance.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "limcycle/analysis/frequency/describing_function.hpp"
#include "limcycle/analysis/motion/loop_field.hpp"
#include "limcycle/analysis/orbit/return_map.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr Complex undefined{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

DescribingFunction df(const Element<double>& element, double A, double w, double bias, double accuracy) {
  DfOptions options;
  options.harmonics = 1;
  options.accuracy = std::clamp(accuracy, 1e-12, 1e-2);
  return describing_function(element, {A, w, bias}, options);
}

/// Closed form where the element offers one, at no cost.
std::optional<Complex> exact_gain(const Element<double>& element, double A, double w, double bias) {
  return std::visit(
      [&]<class E>(const E& e) -> std::optional<Complex> {
        if constexpr (HasExactDescribingFunction<E>) return e.exact_describing_function(A, w, bias);
        return std::nullopt;
      },
      element);
}

bool is_friction(const Loop& loop, std::size_t i) { return loop.ports[i].path == "loop.friction"; }

}  // namespace

std::optional<std::string> LoopBalance::not_applicable(const Loop& loop) {
  const std::size_t n = loop.elements.size();
  if (n > 2)
    return "the plain describing function is for one nonlinear element with at most one saturated command beside it";
  if (n == 2 && loop.ports[0].path == "loop.element")
    return "the plain describing function is for one nonlinear element; this loop has both friction and a forward "
           "element";
  if (is_friction(loop, n - 1) || symmetry(loop)) return std::nullopt;
  if (loop.A.fullPivLu().rank() < loop.A.rows())
    return "the loop is biased (load or reference) and integrates: the mean is not determined by a static balance";
  if (n == 2) return "the loop is biased (load or reference) and its command is saturated";
  return std::nullopt;
}

LoopBalance::LoopBalance(const Loop& loop)
    : loop_(&loop), main_(loop.elements.size() - 1), symmetric_(symmetry(loop).has_value()) {
  if (!is_friction(loop, main_) || symmetric_) return;
  bool exact = false;
  const Port& port = loop.ports[main_];
  mean_velocity_ = (port.C_v * loop.rest_point(exact) + port.c_v * loop.external).value();
}

double LoopBalance::mean_velocity() const { return mean_velocity_; }

bool LoopBalance::depends_on_frequency() const { return is_friction(*loop_, main_); }

/// Mean of the main element's input (friction: mean rubbing velocity). A biased forward element settles where the
/// static balance mean input = rest + H(0) mean output holds.
double LoopBalance::bias(double amplitude, double frequency, double accuracy) const {
  const Port& port = loop_->ports[main_];
  if (is_friction(*loop_, main_)) return mean_velocity_;
  if (symmetric_) return 0.0;
  bool exact = false;
  const double rest = (port.C * loop_->rest_point(exact) + port.c * loop_->external).value();
  const double slope = loop_->element_response(0.0)(0, 0).real();
  double low = rest, high = rest;
  const auto balance = [&](double b) {
    return rest + slope * df(loop_->elements[main_], amplitude, frequency, b, accuracy).mean - b;
  };
  double width = std::abs(balance(rest));
  for (int i = 0; i < 60 && balance(low) < 0.0; ++i) low -= width *= 2.0;
  width = std::abs(balance(rest));
  for (int i = 0; i < 60 && balance(high) > 0.0; ++i) high += width *= 2.0;
  for (int i = 0; i < 100 && high - low > 1e-14 * (std::abs(high) + std::abs(low)); ++i) {
    const double mid = 0.5 * (low + high);
    (balance(mid) > 0.0 ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

Complex LoopBalance::gain(double amplitude, double frequency, double accuracy) const {
  if (const auto exact = exact_gain(loop_->elements[main_], amplitude, frequency, bias(amplitude, frequency, accuracy)))
    return *exact;
  const auto result = df(loop_->elements[main_], amplitude, frequency, bias(amplitude, frequency, accuracy), accuracy);
  if (result.status != Status::converged && result.status != Status::incomplete) return undefined;
  if (symmetric_ && !result.symmetric) return undefined;  // e.g. a relay that does not switch
  return result.gain;
}

/// The smallest amplitude a with a |1 - H_ss N_s(a)| = |H_sm W_m|, by a scan upwards and bisection.
std::optional<LoopBalance::Others> LoopBalance::others(double main_output, double frequency, double accuracy) const {
  if (main_ == 0) return std::nullopt;
  const Eigen::MatrixXcd H = loop_->element_response(frequency);
  const auto m = static_cast<Index>(main_);
  const double wanted = std::abs(H(0, m)) * main_output;
  const auto gain_at = [&](double a) {
    const auto exact = exact_gain(loop_->elements[0], a, frequency, 0.0);
    return exact ? *exact : df(loop_->elements[0], a, frequency, 0.0, accuracy).gain;
  };
  const auto excess = [&](double a) { return a * std::abs(1.0 - H(0, 0) * gain_at(a)) - wanted; };
  Others result{0.0, 0.0};
  if (wanted == 0.0) return result;
  double low = 0.0, high = 1e-3 * wanted;
  for (int i = 0; i < 400 && excess(high) < 0.0; ++i) {
    low = high;
    high *= 1.15;
  }
  for (int i = 0; i < 60; ++i) {
    const double mid = 0.5 * (low + high);
    (excess(mid) < 0.0 ? low : high) = mid;
  }
  result.input_amplitude = 0.5 * (low + high);
  const Complex N = gain_at(result.input_amplitude);
  result.from_main = N * H(0, m) / (1.0 - H(0, 0) * N);
  return result;
}

Complex LoopBalance::operator()(double amplitude, double frequency, double accuracy) const {
  const Complex N = gain(amplitude, frequency, accuracy);
  if (!std::isfinite(N.real())) return undefined;
  const Eigen::MatrixXcd H = loop_->element_response(frequency);
  const auto m = static_cast<Index>(main_);
  Complex response = H(m, m);
  if (const auto other = others(std::abs(N) * amplitude, frequency, accuracy)) response += H(m, 0) * other->from_main;
  return 1.0 - N * response;
}

/// Phasors (sine reference) of all element outputs on the predicted oscillation.
Eigen::VectorXcd LoopBalance::outputs(double amplitude, double frequency) const {
  Eigen::VectorXcd W = Eigen::VectorXcd::Zero(std::ssize(loop_->elements));
  const auto m = static_cast<Index>(main_);
  W(m) = gain(amplitude, frequency, 1e-9) * amplitude;
  if (const auto other = others(std::abs(W(m)), frequency, 1e-9)) W(0) = other->from_main * W(m);
  return W;
}

double LoopBalance::output_amplitude(double amplitude, double frequency) const {
  return std::abs((loop_->output_response(frequency) * outputs(amplitude, frequency)).value());
}

std::optional<bool> LoopBalance::stable(double amplitude, double frequency, int index) const {
  if (index == 0) return std::nullopt;
  if (index < 0) return false;
  if (loop_->delay > 0.0) return std::nullopt;  // the other roots of a loop with delay are infinitely many
  if (main_ != 0) return true;
  // The quasi-linear loop, N acting as Re N + (Im N / w) d/dt: all its other roots must lie in the left half plane.
  const Port& port = loop_->ports[main_];
  const Complex N = gain(amplitude, frequency, 1e-9);
  const double damping = N.imag() / frequency;
  const Eigen::RowVectorXd feedback = (N.real() * port.C + damping * port.C_v) / (1.0 - damping * port.D_v(0));
  const Eigen::VectorXcd roots = (loop_->A + loop_->B * feedback).eigenvalues();
  for (const Complex& root : roots) {
    const bool own =
        std::abs(std::abs(root.imag()) - frequency) < 1e-3 * frequency && std::abs(root.real()) < 1e-3 * frequency;
    if (!own && root.real() > 1e-9 * frequency) return false;
  }
  return true;
}

LoopState LoopBalance::state(double amplitude, double frequency, double scale) const {
  LoopField field(*loop_);
  const Index n = loop_->states();
  const Eigen::VectorXcd W = outputs(amplitude, frequency);
  Eigen::MatrixXcd M = Complex(0.0, frequency) * Eigen::MatrixXcd::Identity(n, n) - loop_->A.cast<Complex>();
  const Eigen::VectorXcd X = M.partialPivLu().solve(loop_->B.cast<Complex>() * W);
  const double b = bias(amplitude, frequency, 1e-9);
  const double mean = df(loop_->elements[main_], amplitude, frequency, b, 1e-9).mean;
  const Eigen::VectorXd pull = loop_->E * loop_->external + loop_->B.col(static_cast<Index>(main_)) * mean;
  LoopState state{State(field.size(), 0.0), std::vector<Mode>(loop_->elements.size())};
  Eigen::Map<Eigen::VectorXd>(state.x.data(), n) =
      scale * X.imag() + loop_->A.completeOrthogonalDecomposition().solve(-pull);
  field.modes() = state.modes;
  field.start(state.x, 0.0);
  state.modes = field.modes();
  return state;
}

}  // namespace limcycle
