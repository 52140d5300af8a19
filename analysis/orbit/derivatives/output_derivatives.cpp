#include "limcycle/analysis/orbit/derivatives/output_derivatives.hpp"

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

/// Integrals over a period, and their changes by deviations.
struct OutputIntegrals {
  double mean = 0.0;    ///< of y
  Turn harmonic = 0.0;  ///< of y e^{-jwt}
  Turn late = 0.0;      ///< of t y e^{-jwt}
  RowVectorXd by_mean;
  RowVectorXcd by_harmonic;
};

/// Centre of the swing of y, if known beforehand: the middle on a half-wave symmetric cycle.
struct Middle {
  double y = 0.0;
  RowVectorXd moves;
};

OutputIntegrals integrate(const Loop& loop, const CyclePieces& cut, const MatrixXd& solution, double w,
                          const Middle& middle) {
  const Index n = cut.sizes.size(), count = solution.cols();
  MatrixXd deviation = solution.topRows(n);
  OutputIntegrals sum;
  sum.by_mean = RowVectorXd::Zero(count);
  sum.by_harmonic = RowVectorXcd::Zero(count);
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    const CyclePiece& piece = cut.pieces[i];
    for (const auto& reading : piece.readings) {
      const Turn turn = reading.weight * std::polar(1.0, -w * reading.t);
      const double y = reading.y - middle.y;
      const RowVectorXd moved = reading.by_start * deviation + reading.by_parameters - middle.moves;
      sum.mean += reading.weight * y;
      sum.harmonic += turn * y;
      sum.late += turn * (reading.t * y);
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

OutputDerivatives output_derivatives(const Loop& loop, const CyclePieces& cut, const ParameterRates& rates,
                                     const MatrixXd& solution) {
  const double halves = cut.mirror ? 2.0 : 1.0, T = halves * cut.pieces.back().step.t1, w = 2.0 * std::numbers::pi / T;
  const RowVectorXd period = halves * solution.bottomRows(1);
  Middle middle{0.0, RowVectorXd::Zero(period.size())};
  if (cut.mirror) {
    const auto& centre = cut.mirror->centre;
    const State at(centre.begin(), centre.end());
    middle.y = read_y(loop, at);
    middle.moves = loop.C_y * cut.mirror->moved.topRows(loop.states()) + rates.output(at);
  }
  const OutputIntegrals sum = integrate(loop, cut, solution, w, middle);
  const double y = read_y(loop, cut.pieces.back().step.x1) - middle.y;
  OutputDerivatives result;
  result.mean = cut.mirror ? middle.y : sum.mean / T;
  result.by_mean = cut.mirror ? middle.moves : RowVectorXd((sum.by_mean + (y - result.mean) * period) / T);
  // Over the other half period, the integral of y less its middle is the same again.
  const Turn harmonic = 2.0 * halves / T * sum.harmonic;
  result.first_harmonic = std::abs(harmonic);
  result.by_first_harmonic = RowVectorXd::Zero(period.size());
  if (result.first_harmonic == 0.0) return result;
  const Turn end = y * std::polar(1.0 / halves, -w * cut.pieces.back().step.t1);
  const Turn of_period = halves * (end + Turn(0.0, w / T) * sum.late);
  const RowVectorXcd moved =
      (2.0 * halves / T) * sum.by_harmonic + ((2.0 * of_period - harmonic) / T) * period.cast<Turn>();
  result.by_first_harmonic = (std::conj(harmonic) / result.first_harmonic * moved).real();
  return result;
}

}  // namespace limcycle
