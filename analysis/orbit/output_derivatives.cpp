#include "limcycle/analysis/orbit/output_derivatives.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace limcycle {
namespace {

using Turn = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXcd;
using Eigen::RowVectorXd;

double read_y(const Loop& loop, const State& x) {
  return loop.C_y.dot(Eigen::Map<const Eigen::VectorXd>(x.data(), loop.states()));
}

/// Integrals over a period, and what they owe to the deviations.
struct OutputIntegrals {
  double mean = 0.0;    ///< of y
  Turn harmonic = 0.0;  ///< of y e^{-jwt}
  Turn late = 0.0;      ///< of t y e^{-jwt}
  RowVectorXd by_mean;
  RowVectorXcd by_harmonic;
};

OutputIntegrals integrate(const Loop& loop, const CyclePieces& cut, const MatrixXd& solution) {
  const Index n = cut.sizes.size(), count = solution.cols();
  const double w = 2.0 * std::numbers::pi / cut.pieces.back().step.t1;
  MatrixXd deviation = solution.topRows(n);
  OutputIntegrals sum;
  sum.by_mean = RowVectorXd::Zero(count);
  sum.by_harmonic = RowVectorXcd::Zero(count);
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    const CyclePiece& piece = cut.pieces[i];
    for (const auto& reading : piece.readings) {
      const Turn turn = reading.weight * std::polar(1.0, -w * reading.t);
      const RowVectorXd moved = reading.by_start * deviation + reading.by_parameters;
      sum.mean += reading.weight * reading.y;
      sum.harmonic += turn * reading.y;
      sum.late += turn * (reading.t * reading.y);
      sum.by_mean += reading.weight * moved;
      sum.by_harmonic += turn * moved.cast<Turn>();
    }
    deviation = (piece.factor * deviation + piece.columns).eval();
    if (!piece.event) continue;
    if (i + 1 < cut.pieces.size()) {
      const double fall = read_y(loop, piece.step.x1) - read_y(loop, cut.pieces[i + 1].step.x0);
      const RowVectorXd moment = piece.end->by_state * deviation + piece.end->by_parameters;
      sum.by_mean += fall * moment;
      sum.by_harmonic += fall * std::polar(1.0, -w * piece.step.t1) * moment.cast<Turn>();
    }
    deviation = (piece.event->saltation * deviation + piece.event->jump).eval();
  }
  return sum;
}

}  // namespace

OutputDerivatives output_derivatives(const Loop& loop, const CyclePieces& cut, const MatrixXd& solution) {
  const OutputIntegrals sum = integrate(loop, cut, solution);
  const double T = cut.pieces.back().step.t1, y = read_y(loop, cut.last.x);
  const RowVectorXd period = solution.bottomRows(1);
  OutputDerivatives result;
  result.mean = sum.mean / T;
  result.by_mean = (sum.by_mean + (y - result.mean) * period) / T;
  const Turn harmonic = 2.0 / T * sum.harmonic;
  result.first_harmonic = std::abs(harmonic);
  result.by_first_harmonic = RowVectorXd::Zero(period.size());
  if (result.first_harmonic == 0.0) return result;
  const Turn of_period = y + Turn(0.0, 2.0 * std::numbers::pi / (T * T)) * sum.late;
  const RowVectorXcd moved = (2.0 / T) * sum.by_harmonic + ((2.0 * of_period - harmonic) / T) * period.cast<Turn>();
  result.by_first_harmonic = (std::conj(harmonic) / result.first_harmonic * moved).real();
  return result;
}

}  // namespace limcycle
