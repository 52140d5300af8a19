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

/// The surface on which a piece ends, for all neighbours: that of its switch or reversal, or else the one across the
/// flow, n x = const with n f = 1, on which deviations are projected along the flow. Between creep and slip a deviation
/// along the flow grows and shrinks ten thousand times, and what is wanted would drown in it.
struct Nodes {
  std::vector<std::optional<Eigen::RowVectorXd>> across;  ///< n; none at bound ends and at the end of the period
  std::vector<MatrixXd> factors;                          ///< of each piece, projected
};

MatrixXd projected(const MatrixXd& factor, const State& rate, const Eigen::RowVectorXd& n) {
  const Eigen::Map<const VectorXd> f(rate.data(), n.size());
  return factor - f * (n * factor) / (n * f).value();
}

Nodes nodes_of(const CyclePieces& cut) {
  Nodes nodes;
  for (const CyclePiece& piece : cut.pieces) {
    auto& across = nodes.across.emplace_back();
    nodes.factors.push_back(piece.factor);
    const Eigen::Map<const VectorXd> f(piece.step.dx1.data(), cut.sizes.size());
    const double speed = f.cwiseQuotient(cut.sizes).squaredNorm();
    if (piece.end || &piece == &cut.pieces.back() || speed == 0.0) continue;
    across = f.cwiseQuotient(cut.sizes.cwiseAbs2()).transpose() / speed;
    nodes.factors.back() = projected(piece.factor, piece.step.dx1, *across);
  }
  return nodes;
}

/// A deviation that is carried along the cycle with a parameter: at a fixed time, and how the time moves at which the
/// neighbour ends a piece.
class Neighbouring {
 public:
  Neighbouring(ParameterRates& rates, Index parameter, VectorXd start)
      : rates_(rates), k_(parameter), deviation_(std::move(start)) {}

  /// d(projected factor)/dp of a piece; carries on to its end. `period`: d(period)/dp, if it is the last one.
  MatrixXd along(const CyclePiece& piece, const std::optional<Eigen::RowVectorXd>& across,
                 std::optional<double> period) {
    const VectorXd start = moved(piece.step.dx0);
    const double start_moment = moment_;
    deviation_ = (piece.factor * deviation_ + piece.columns.col(k_)).eval();
    moment_ = period.value_or(0.0);
    if (!period && piece.end) moment_ = piece.end->by_state * deviation_ + piece.end->by_parameters(k_);
    if (across) moment_ = -*across * deviation_;
    const VectorXd end = moved(piece.step.dx1);
    const auto side = [&](bool above) {
      const double by = (above ? 1.0 : -1.0) * rates_.step(k_);
      Step step = piece.step;
      shift(step.x0, by * start);
      shift(step.x1, by * end);
      step.t0 += by * start_moment;
      step.t1 += by * moment_;
      const MatrixXd factor = rates_.transition_beside(k_, above, piece.modes, step, piece.reversal);
      return across ? projected(factor, step.dx1, *across) : factor;
    };
    return (side(true) - side(false)) / (2.0 * rates_.step(k_));
  }

  /// d(saltation)/dp at the switch that ends a piece; carries on to after it. Nothing where a switch beside is grazed.
  std::optional<MatrixXd> over(const CyclePiece& piece) {
    const VectorXd at = moved(piece.step.dx1);
    MatrixXd change;
    for (const bool above : {true, false}) {
      LoopField& field = rates_.neighbour(k_, above);
      State x = piece.step.x1;
      shift(x, (above ? 1.0 : -1.0) * rates_.step(k_) * at);
      field.modes() = piece.modes;
      MatrixXd saltation;
      if (!field.fire(x, 0.0, piece.event->guard, saltation)) return std::nullopt;
      change = above ? saltation : MatrixXd(change - saltation);
    }
    deviation_ = (piece.event->saltation * deviation_ + piece.event->jump.col(k_)).eval();
    return change / (2.0 * rates_.step(k_));
  }

 private:
  /// The deviation at the moved time.
  VectorXd moved(const State& rate) const {
    return deviation_ + moment_ * Eigen::Map<const VectorXd>(rate.data(), deviation_.size());
  }
  static void shift(State& x, const VectorXd& by) { Eigen::Map<VectorXd>(x.data(), by.size()) += by; }

  ParameterRates& rates_;
  Index k_;
  VectorXd deviation_;
  double moment_ = 0.0;
};

/// All factors of the period in order; a switch is a factor of its own.
std::vector<const MatrixXd*> factors_of(const CyclePieces& cut, const Nodes& nodes) {
  std::vector<const MatrixXd*> factors;
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    factors.push_back(&nodes.factors[i]);
    if (cut.pieces[i].event) factors.push_back(&cut.pieces[i].event->saltation);
  }
  return factors;
}

/// The eigenvectors carried along the cycle: v before each factor, w after it.
struct CarriedPair {
  std::vector<VectorXcd> v, w;
};
CarriedPair carry_pair(const std::vector<const MatrixXd*>& factors, const VectorXd& sizes, const Eigenpair& pair) {
  CarriedPair carried;
  VectorXcd v = sizes.cast<Complex>().cwiseProduct(pair.v);
  for (const MatrixXd* factor : factors) {
    carried.v.push_back(v);
    v = (*factor * v).eval();
  }
  VectorXcd w = sizes.cwiseInverse().cast<Complex>().cwiseProduct(pair.w);
  carried.w.resize(factors.size());
  for (std::size_t i = factors.size(); i-- > 0;) {
    carried.w[i] = w;
    w = (factors[i]->transpose() * w).eval();
  }
  return carried;
}

using Changes = std::vector<std::optional<Complex>>;

/// d(multipliers)/dp for one parameter.
Changes changes(const CyclePieces& cut, const Nodes& nodes, const std::vector<std::optional<CarriedPair>>& pairs,
                Neighbouring beside, double period) {
  Changes sums(pairs.size());
  for (std::size_t m = 0; m < pairs.size(); ++m)
    if (pairs[m]) sums[m] = 0.0;
  std::size_t at = 0;
  const auto add = [&](const MatrixXd& change) {
    for (std::size_t m = 0; m < pairs.size(); ++m)
      if (pairs[m]) *sums[m] += pairs[m]->w[at].dot(change * pairs[m]->v[at]);
    ++at;
  };
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    const CyclePiece& piece = cut.pieces[i];
    const bool last = i + 1 == cut.pieces.size();
    add(beside.along(piece, nodes.across[i], last ? std::optional(period) : std::nullopt));
    if (!piece.event) continue;
    const auto change = beside.over(piece);
    if (!change) return Changes(pairs.size());
    add(*change);
  }
  return sums;
}

}  // namespace

std::vector<std::vector<std::optional<Complex>>> multiplier_derivatives(const CyclePieces& cut,
                                                                        const std::vector<Complex>& multipliers,
                                                                        const MatrixXd& solution,
                                                                        ParameterRates& rates) {
  const Nodes nodes = nodes_of(cut);
  const auto factors = factors_of(cut, nodes);
  const Index n = cut.sizes.size();
  MatrixXd whole = cut.sizes.asDiagonal();
  for (const MatrixXd* factor : factors) whole = (*factor * whole).eval();
  whole = (cut.sizes.cwiseInverse().asDiagonal() * whole).eval();
  std::vector<std::optional<CarriedPair>> pairs;
  for (const Complex multiplier : multipliers) {
    const auto pair = eigenpair(whole, multiplier);
    pairs.push_back(pair ? std::optional(carry_pair(factors, cut.sizes, *pair)) : std::nullopt);
  }
  std::vector<Changes> result;
  for (Index k = 0; k < rates.count(); ++k)
    result.push_back(changes(cut, nodes, pairs, Neighbouring(rates, k, solution.col(k).head(n)), solution(n, k)));
  return result;
}

}  // namespace limcycle
