#include "limcycle/analysis/frequency/harmonic_balance/balance_start.hpp"

namespace limcycle {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;

constexpr int quadrature_level = 2;  // a start need not be exact

/// Harmonics of the inputs, turned in phase; only odd ones for a half-wave symmetric motion.
std::vector<VectorXcd> turned_inputs(const HarmonicGuess& guess, bool half_wave) {
  std::vector<VectorXcd> inputs = guess.inputs;
  for (Index k = 0; guess.inputs.empty() && k < guess.first.size(); ++k)
    inputs.push_back((VectorXcd(2) << 0.0, guess.first(k)).finished());
  const double phase = std::arg(inputs.back()(1));
  for (auto& series : inputs) {
    for (Index n = 0; n < series.size(); ++n)
      series(n) *= half_wave && n % 2 == 0 ? 0.0 : std::polar(1.0, -static_cast<double>(n) * phase);
  }
  inputs.back()(1) = std::abs(inputs.back()(1));
  return inputs;
}

/// Input of an element that was not given: that of the main element times a factor if the two read the same signal
/// (gravity and friction on a pendulum), else the effect of the main element alone.
VectorXcd filled_input(const Loop& loop, const BalancePoint& point, Index k, double mean_rate, bool half_wave) {
  const VectorXcd& main = point.inputs.back();
  const Port &own = loop.ports[static_cast<std::size_t>(k)], &from = loop.ports.back();
  const double factor = from.C.squaredNorm() > 0.0 ? from.C.dot(own.C) / from.C.squaredNorm() : 0.0;
  const bool direct = own.D.isZero() && from.D.isZero() && own.C_delayed.isZero() && from.C_delayed.isZero();
  if (direct && factor != 0.0 && (own.C - factor * from.C).norm() <= 1e-12 * own.C.norm()) return factor * main;
  const auto last = std::ssize(loop.elements) - 1;
  const int orders = static_cast<int>(main.size()) - 1;
  const PrescribedHarmonics motion(main, point.frequency, mean_rate, half_wave);
  ElementHarmonics answer(loop.elements.back());
  const HarmonicResponse W = answer(motion, orders, quadrature_level, 1e-9);
  VectorXcd result = VectorXcd::Zero(main.size());
  for (int n = 1; n <= orders && W.status == Status::converged; n += half_wave ? 2 : 1)
    result(n) = loop.element_response(n * point.frequency)(k, last) * W.harmonics(n);
  if (!(std::abs(result(1)) > 0.0)) result(1) = 1e-6 * main(1);
  return result;
}

}  // namespace

Status balance_start(const Loop& loop, BalanceEquations& equations, const HarmonicGuess& guess, bool half_wave,
                     BalancePoint& point) {
  const auto ne = std::ssize(loop.elements);
  point.frequency = guess.frequency;
  point.inputs = turned_inputs(guess, half_wave);
  point.mean_outputs = Eigen::VectorXd::Zero(ne);
  point.free = Eigen::VectorXd::Zero(equations.free_parts());
  BalanceMeans means = equations.means(point.mean_outputs, point.free);
  for (Index k = 0; k + 1 < ne; ++k) {
    VectorXcd& series = point.inputs[static_cast<std::size_t>(k)];
    if (series.tail(series.size() - 1).norm() == 0.0)
      series = filled_input(loop, point, k, means.rates(ne - 1), half_wave);
  }
  for (Index k = 0; k < ne && !guess.inputs.empty(); ++k)
    means.inputs(k) = guess.inputs[static_cast<std::size_t>(k)](0).imag();
  if (guess.mean.size() == ne) means.inputs = guess.mean;
  const BalanceOutputs outputs = equations.outputs(point, 1, &means);
  if (outputs.status != Status::converged || half_wave) return outputs.status;
  for (Index k = 0; k < ne; ++k) point.mean_outputs(k) = outputs.harmonics[static_cast<std::size_t>(k)](0).imag();
  point.free = equations.closest_free(point.mean_outputs, means.inputs);
  return Status::converged;
}

}  // namespace limcycle
