#include "limcycle/analysis/orbit/multiplier_derivatives.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "limcycle/analysis/motion/transition.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

/// Right and left eigenvector of a simple multiplier, w' v = 1; nothing if it is not simple.
struct Eigenpair {
  VectorXcd v, w;
};
std::optional<Eigenpair> eigenpair(const MatrixXd& scaled, Complex multiplier) {
  const Index n = scaled.rows();
  const double size = scaled.norm();
  if (!(std::abs(multiplier) > 1e-9 * size)) return std::nullopt;
  const MatrixXcd shifted = scaled.cast<Complex>() - multiplier * MatrixXcd::Identity(n, n);
  const Eigen::JacobiSVD<MatrixXcd> svd(shifted, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& singular = svd.singularValues();
  if (n > 1 && !(singular(n - 1) < 1e-3 * singular(n - 2))) return std::nullopt;
  Eigenpair pair{svd.matrixV().col(n - 1), svd.matrixU().col(n - 1)};
  const Complex product = pair.w.dot(pair.v);
  if (!(std::abs(product) > 1e-9)) return std::nullopt;
  pair.w /= std::conj(product);
  return pair;
}

/// A deviation that is carried along the cycle with a parameter: at a fixed time, and how the time of a bound moment
/// moves.
class Neighbouring {
 public:
  Neighbouring(ParameterRates& rates, Index parameter, VectorXd start)
      : rates_(rates), k_(parameter), deviation_(std::move(start)) {}

  /// d(factor)/dp of a piece whose end moves with the parameter by `last` if it is the last one; carries on to its end.
  MatrixXd along(const CyclePiece& piece, std::optional<double> last) {
    const VectorXd start = moved(deviation_, piece.step.dx0);
    const double start_moment = moment_;
    deviation_ = (piece.factor * deviation_ + piece.columns.col(k_)).eval();
    moment_ = last ? *last : piece.end ? piece.end->by_state * deviation_ + piece.end->by_parameters(k_) : 0.0;
    const VectorXd end = moved(deviation_, piece.step.dx1);
    const auto side = [&](bool above) {
      const double by = (above ? 1.0 : -1.0) * rates_.step(k_);
      Step step = piece.step;
      shift(step.x0, by * start);
      shift(step.x1, by * end);
      step.t0 += by * start_moment;
      step.t1 += by * moment_;
      return rates_.transition_beside(k_, above, piece.modes, step, piece.reversal);
    };
    return (side(true) - side(false)) / (2.0 * rates_.step(k_));
  }

  /// d(saltation)/dp at the switch that ends a piece; carries on to after it. Nothing where a switch beside is grazed.
  std::optional<MatrixXd> over(const CyclePiece& piece) {
    const VectorXd at = moved(deviation_, piece.step.dx1);
    MatrixXd change;
    for (const bool above : {true, false}) {
      LoopField& field = rates_.neighbour(k_, above);
      const double by = (above ? 1.0 : -1.0) * rates_.step(k_);
      State x = piece.step.x1;
      shift(x, by * at);
      field.modes() = piece.modes;
      MatrixXd saltation;
      if (!field.fire(x, 0.0, piece.event->guard, saltation)) return std::nullopt;
      change = above ? saltation : MatrixXd(change - saltation);
    }
    deviation_ = (piece.event->saltation * deviation_ + piece.event->jump.col(k_)).eval();
    return change / (2.0 * rates_.step(k_));
  }

 private:
  VectorXd moved(const VectorXd& deviation, const State& rate) const {
    return deviation + moment_ * Eigen::Map<const VectorXd>(rate.data(), deviation.size());
  }
  static void shift(State& x, const VectorXd& by) { Eigen::Map<VectorXd>(x.data(), by.size()) += by; }

  ParameterRates& rates_;
  Index k_;
  VectorXd deviation_;
  double moment_ = 0.0;
};

/// The eigenvectors carried along the cycle: v forward, w backward.
struct CarriedPair {
  std::vector<VectorXcd> v, w;  ///< v before each factor, w after it; a switch is a factor of its own
};
CarriedPair carry_pair(const CyclePieces& cut, const Eigenpair& pair) {
  std::vector<const MatrixXd*> factors;
  for (const CyclePiece& piece : cut.pieces) {
    factors.push_back(&piece.factor);
    if (piece.event) factors.push_back(&piece.event->saltation);
  }
  CarriedPair carried;
  carried.v.push_back(cut.sizes.cwiseProduct(pair.v.real()).cast<Complex>() +
                      Complex(0.0, 1.0) * cut.sizes.cwiseProduct(pair.v.imag()).cast<Complex>());
  for (const MatrixXd* factor : factors) carried.v.push_back(*factor * carried.v.back());
  carried.w.assign(factors.size(), {});
  VectorXcd w = cut.sizes.cwiseInverse().cast<Complex>().cwiseProduct(pair.w);
  for (std::size_t i = factors.size(); i-- > 0;) {
    carried.w[i] = w;
    w = (factors[i]->transpose() * w).eval();
  }
  return carried;
}

}  // namespace

std::vector<std::vector<std::optional<Complex>>> multiplier_derivatives(const CyclePieces& cut, const MatrixXd& whole,
                                                                        const std::vector<Complex>& multipliers,
                                                                        const MatrixXd& solution,
                                                                        ParameterRates& rates) {
  const MatrixXd scaled = cut.sizes.cwiseInverse().asDiagonal() * whole * cut.sizes.asDiagonal();
  std::vector<std::optional<CarriedPair>> pairs;
  for (const Complex multiplier : multipliers) {
    const auto pair = eigenpair(scaled, multiplier);
    pairs.push_back(pair ? std::optional(carry_pair(cut, *pair)) : std::nullopt);
  }
  const Index n = whole.rows();
  std::vector<std::vector<std::optional<Complex>>> result;
  for (Index k = 0; k < rates.count(); ++k) {
    std::vector<std::optional<Complex>> sums(pairs.size());
    for (std::size_t m = 0; m < pairs.size(); ++m)
      if (pairs[m]) sums[m] = 0.0;
    Neighbouring beside(rates, k, solution.col(k).head(n));
    std::size_t at = 0;
    const auto add = [&](const MatrixXd& change) {
      for (std::size_t m = 0; m < pairs.size(); ++m)
        if (pairs[m]) *sums[m] += pairs[m]->w[at].dot(change * pairs[m]->v[at]);
      ++at;
    };
    bool smooth = true;
    for (const CyclePiece& piece : cut.pieces) {
      const bool last = &piece == &cut.pieces.back();
      add(beside.along(piece, last ? std::optional(solution(n, k)) : std::nullopt));
      if (!piece.event) continue;
      const auto change = beside.over(piece);
      if (!(smooth = change.has_value())) break;
      add(*change);
    }
    if (!smooth) std::ranges::fill(sums, std::nullopt);
    result.push_back(std::move(sums));
  }
  return result;
}

}  // namespace limcycle
