#include "limcycle/analysis/study/composite/composite_balance.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/df_undefined.hpp"
#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/study/balance/quasi_linear.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

double mass_of(const Loop& loop, std::size_t f) {
  const Port& port = loop.ports[f];
  return -1.0 / (port.C_v * loop.B.col(static_cast<Index>(f))).value();
}

const Loop& applicable(const Loop& loop) {
  if (const auto why = CompositeBalance::not_applicable(loop)) throw std::invalid_argument(*why);
  return loop;
}

}  // namespace

std::optional<std::string> CompositeBalance::not_applicable(const Loop& loop) {
  if (loop.elements.empty() || !loop.ports.back().opposes)
    return "the composite describing function is of mass and friction; this loop has no friction";
  if (loop.elements.size() > 1)
    return "the composite describing function takes mass and friction as the one nonlinear element; this loop has " +
           loop.ports.front().path + " as well";
  if (undefined_under(loop.elements.back(), infinite, 1.0))
    return "the composite describing function knows no place of rest; this friction law holds a spring to one";
  const double mass = mass_of(loop, loop.elements.size() - 1);
  if (!(mass > 0.0 && std::isfinite(mass)))
    return "the friction force does not act on a mass of its own (C_v B is not negative)";
  return std::nullopt;
}

CompositeBalance::CompositeBalance(const Loop& loop)
    : loop_(&applicable(loop)),
      f_(std::ssize(loop.elements) - 1),
      mass_(mass_of(loop, loop.elements.size() - 1)),
      element_(loop.elements.back(), mass_) {
  bool exact = false;
  const Port& port = loop.ports.back();
  mean_velocity_ = (port.C_v * loop.rest_point(exact) + port.c_v * loop.external).value();
  if (std::abs(mean_velocity_) < 1e-13 * typical_rubbing_velocity(loop)) mean_velocity_ = 0.0;
  const auto [odd, level] = std::pair(loop.elements.back().odd(), loop.elements.back().scales().output);
  biased_ = mean_velocity_ != 0.0 || !odd;
  level_ = level;
}

Complex CompositeBalance::rest_of_loop(double frequency) const {
  return 1.0 / loop_->element_response(frequency)(f_, f_) - mass_ * frequency * frequency;
}

Complex CompositeBalance::residue(Complex gain, double frequency) const { return 1.0 - rest_of_loop(frequency) * gain; }

CompositeResponse CompositeBalance::solve(double force, double frequency, double accuracy, bool estimate) {
  CompositeOptions options;
  options.accuracy = std::clamp(accuracy, 1e-10, 1e-2);
  options.estimate_error = estimate;
  const CompositePoint point{force, frequency, mean_velocity_};
  ++evaluations_;
  CompositeResponse found;
  if (near_) {
    // The velocity of an inertial motion is proportional to U/w.
    CompositeResponse start = *near_;
    found = element_(point, options, &start);
  }
  if (!near_ || found.status != Status::converged) {
    found = element_(point, options);
  }
  if (found.status == Status::converged) near_ = found;
  return found;
}

/// With a mean velocity V there is a bias for each force at which the body begins to break away in every period. If
/// full stick-slip is slower than V there, a larger bias makes it as fast. If it is faster, no periodic motion has this
/// mean: the mean velocity jumps across V, and the jump is closed by the mixture of stick and full stick-slip with mean
/// V.
std::optional<CompositeBalance::StickSlip> CompositeBalance::stick_slip(double force, double frequency,
                                                                        double accuracy) {
  const double V = mean_velocity_;
  const double edge = element_.break_away_bias(force, frequency, V, accuracy > 1e-5 ? 1e-6 : 1e-9);
  CompositeOptions options;
  options.accuracy = std::clamp(accuracy, 1e-10, 1e-2);
  options.estimate_error = false;
  const double beyond = edge + (V < 0.0 ? -1e-4 : 1e-4) * level_;
  ++evaluations_;
  CompositeResponse full = element_({force, frequency, V, beyond}, options);
  if (full.status != Status::converged) return std::nullopt;
  StickSlip found;
  if (full.mean_velocity / V >= 1.0) {
    found.share = V / full.mean_velocity;
  } else {
    full = element_({force, frequency, V}, options, &full);
    if (full.status != Status::converged) return std::nullopt;
  }
  found.gain = found.share * full.gain;
  found.bias = full.bias;
  found.sticking = 1.0 - found.share * (1.0 - full.sticking_fraction);
  found.full = std::move(full);
  return found;
}

CompositeResponse CompositeBalance::response(double force, double frequency, const CompositeOptions& options) {
  return element_({force, frequency, mean_velocity_}, options, near_ ? &*near_ : nullptr);
}

Complex CompositeBalance::operator()(double force, double frequency, double accuracy) {
  const CompositeResponse r = solve(force, frequency, accuracy, false);
  if (r.status != Status::converged) return {std::nan(""), std::nan("")};
  return residue(r.gain, frequency);
}

CompositeRoot CompositeBalance::describe(double force, double frequency, Complex gain, int index) const {
  CompositeRoot root;
  root.force = force;
  root.frequency = frequency;
  root.input_amplitude = std::abs(gain) * force;
  const Complex H = loop_->element_response(frequency)(f_, f_);
  root.amplitude = root.input_amplitude * std::abs(loop_->output_response(frequency)(f_) / H);
  root.residual = std::abs(residue(gain, frequency));
  root.index = index;
  root.stable = stable(frequency, gain, index);
  return root;
}

/// The quasi-linear loop, with friction as Re N_F + (Im N_F/w) d/dt with N_F = F1/x1 = 1/N + m w^2: all its other roots
/// must lie in the left half plane.
std::optional<bool> CompositeBalance::stable(double frequency, Complex gain, int index) const {
  if (index == 0) return std::nullopt;
  if (index < 0) return false;
  if (loop_->delay > 0.0) return std::nullopt;
  const Complex N = 1.0 / gain + mass_ * frequency * frequency;
  const Eigen::VectorXcd roots = eigenvalues(quasi_linear(*loop_, static_cast<std::size_t>(f_), N, frequency));
  for (const Complex& root : roots) {
    const bool own =
        std::abs(std::abs(root.imag()) - frequency) < 1e-3 * frequency && std::abs(root.real()) < 1e-3 * frequency;
    if (!own && root.real() > 1e-9 * frequency) return false;
  }
  return true;
}

LoopState CompositeBalance::state(const CompositeRoot& root) {
  LoopField field(*loop_);
  const Index n = loop_->states();
  const double w = root.frequency;
  const CompositeResponse r = solve(root.force, w, 1e-6, false);
  Complex x1 = r.gain * root.force;
  if (root.on_break_away_front) x1 = root.force / rest_of_loop(w);
  const Complex F1 = x1 / loop_->element_response(w)(f_, f_);
  Eigen::MatrixXcd M = Complex(0.0, w) * Eigen::MatrixXcd::Identity(n, n) - loop_->A.cast<Complex>();
  if (loop_->delay > 0.0) M -= std::exp(Complex(0.0, -w * loop_->delay)) * loop_->A_delayed.cast<Complex>();
  const Eigen::VectorXcd X = limcycle::solve(M, loop_->B.col(f_).cast<Complex>() * F1);
  const Eigen::VectorXd pull = loop_->E * loop_->external + loop_->B.col(f_) * root.bias;
  LoopState state{std::vector<double>(field.size(), 0.0), std::vector<Mode>(1)};
  Eigen::Map<Eigen::VectorXd>(state.x.data(), n) = X.imag() + least_squares(loop_->A + loop_->A_delayed, -pull);
  if (!root.on_break_away_front && r.status == Status::converged)
    for (std::size_t k = 1; k < r.start.size(); ++k) state.x[field.first_state(0) + k - 1] = r.start[k];
  field.modes() = state.modes;
  field.start(state.x, 0.0);
  state.modes = field.modes();
  return state;
}

}  // namespace limcycle
