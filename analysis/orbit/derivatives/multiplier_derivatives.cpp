#include "limcycle/analysis/orbit/derivatives/multiplier_derivatives.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/steppers/transition.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

/// Right and left eigenvector of a simple multiplier, w' v = 1; nothing if it is not simple.
struct Eigenpair {
  VectorXcd v, w;
  double defect = 0.0;  ///< deviation of the multiplier from being one
};
std::optional<Eigenpair> eigenpair(const MatrixXd& scaled, Complex multiplier, double least) {
  const Index n = scaled.rows();
  const double size = scaled.norm();
  if (!(std::abs(multiplier) > least * size)) return std::nullopt;
  const MatrixXcd shifted = scaled.cast<Complex>() - multiplier * MatrixXcd::Identity(n, n);
  const auto [values, U, V] = singular_values(shifted);
  if (n > 1 && !(values(n - 1) < 1e-3 * values(n - 2))) return std::nullopt;
  Eigenpair pair{V.col(n - 1), U.col(n - 1), values(n - 1)};
  const Complex product = pair.w.dot(pair.v);
  if (!(std::abs(product) > 1e-9)) return std::nullopt;
  pair.w /= std::conj(product);
  return pair;
}

Eigen::Map<const VectorXd> state_vector(const State& x) { return {x.data(), std::ssize(x)}; }

/// n, with n f = 1, of the surface across the flow of rate f; zero where nothing moves.
RowVectorXd across(const State& rate, const VectorXd& sizes) {
  const double speed = state_vector(rate).cwiseQuotient(sizes).squaredNorm();
  if (speed == 0.0) return RowVectorXd::Zero(sizes.size());
  return state_vector(rate).cwiseQuotient(sizes.cwiseAbs2()).transpose() / speed;
}

/// Projects out of a factor its result along the flow at its end.
MatrixXd projected(const MatrixXd& factor, const State& rate, const RowVectorXd& n) {
  const double speed = n * state_vector(rate);
  if (speed == 0.0) return factor;
  return factor - state_vector(rate) * (n * factor) / speed;
}

/// The factors of the pieces, projected along the flow unless they end with a bound moment. All eigenvalues of the
/// product but the trivial one stay the same; without it, a deviation along the flow would grow and shrink ten thousand
/// times between creep and slip, and the result would be lost in it.
struct Projected {
  std::vector<std::optional<RowVectorXd>> across;
  std::vector<MatrixXd> factors;
};

Projected project(const CyclePieces& cut) {
  Projected result;
  for (const CyclePiece& piece : cut.pieces) {
    const bool bound = piece.end || &piece == &cut.pieces.back();
    result.across.push_back(bound ? std::nullopt : std::optional(across(piece.step.dx1, cut.sizes)));
    result.factors.push_back(bound ? piece.factor : projected(piece.factor, piece.step.dx1, *result.across.back()));
  }
  return result;
}

/// A neighbour's cycle along the pieces of this one: state and time at which it begins and ends each, per unit of the
/// parameter. Bound moments are its own. Between them the neighbour is taken where it crosses the surface across the
/// flow, or nearly so: close to a bound moment the times approach those of the bound moment smoothly, so that no piece
/// gets much longer or shorter.
struct Beside {
  std::vector<VectorXd> start, end;              ///< at the moved times
  std::vector<double> start_moment, end_moment;  ///< derivatives of the times
};

/// Weight of a bound moment in the times between them, at a distance `away` from it.
double share_of_bound(double away, double reach) { return reach > 0.0 ? std::max(0.0, 1.0 - away / reach) : 0.0; }

Beside go_beside(const CyclePieces& cut, Index k, const VectorXd& solution) {
  const Index n = cut.sizes.size();
  const double period = cut.pieces.back().step.t1;
  VectorXd deviation = solution.head(n);
  double start_moment = 0.0;
  Beside beside;
  std::size_t first = 0;  // the first piece since the last bound moment
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    const CyclePiece& piece = cut.pieces[i];
    const bool last = i + 1 == cut.pieces.size();
    beside.start.push_back(deviation);
    beside.start_moment.push_back(-(across(piece.step.dx0, cut.sizes) * deviation).value());
    deviation = (piece.factor * deviation + piece.columns.col(k)).eval();
    beside.end.push_back(deviation);
    beside.end_moment.push_back(-(across(piece.step.dx1, cut.sizes) * deviation).value());
    if (!last && !piece.end) continue;
    const double end_moment =
        last ? solution(n) : (piece.end->by_state * deviation).value() + piece.end->by_parameters(k);
    const double from = cut.pieces[first].step.t0, to = piece.step.t1, reach = std::min(to - from, 0.02 * period);
    const double at_start = start_moment - beside.start_moment[first], at_end = end_moment - beside.end_moment[i];
    const auto bind = [&](double& moment, double t) {
      moment += at_start * share_of_bound(t - from, reach) + at_end * share_of_bound(to - t, reach);
    };
    for (std::size_t j = first; j <= i; ++j) {
      const Step& step = cut.pieces[j].step;
      bind(beside.start_moment[j], step.t0);
      bind(beside.end_moment[j], step.t1);
      beside.start[j] += beside.start_moment[j] * state_vector(step.dx0);
      beside.end[j] += beside.end_moment[j] * state_vector(step.dx1);
    }
    if (piece.event) deviation = (piece.event->saltation * deviation + piece.event->jump.col(k)).eval();
    start_moment = end_moment;
    first = i + 1;
  }
  return beside;
}

void shift(State& x, const VectorXd& by) { Eigen::Map<VectorXd>(x.data(), by.size()) += by; }

/// d(projected factor)/dp of piece i; nothing if the piece is too short compared with the shift of its ends.
std::optional<MatrixXd> factor_change(const CyclePiece& piece, std::size_t i, const Beside& beside,
                                      const std::optional<RowVectorXd>& n, Index k, ParameterRates& rates) {
  const double longer = rates.step(k) * (beside.end_moment[i] - beside.start_moment[i]);
  if (!(std::abs(longer) <= 0.2 * (piece.step.t1 - piece.step.t0))) return std::nullopt;
  const auto side = [&](bool above) {
    const double by = (above ? 1.0 : -1.0) * rates.step(k);
    Step step = piece.step;
    shift(step.x0, by * beside.start[i]);
    shift(step.x1, by * beside.end[i]);
    step.t0 += by * beside.start_moment[i];
    step.t1 += by * beside.end_moment[i];
    const MatrixXd factor = rates.transition_beside(k, above, piece.modes, step, piece.reversal);
    return n ? projected(factor, step.dx1, *n) : factor;
  };
  return (side(true) - side(false)) / (2.0 * rates.step(k));
}

/// d(saltation)/dp at the switch that ends a piece; nothing if a neighbour grazes it.
std::optional<MatrixXd> saltation_change(const CyclePiece& piece, const VectorXd& at, Index k, ParameterRates& rates) {
  MatrixXd change;
  for (const bool above : {true, false}) {
    LoopField& field = rates.neighbour(k, above);
    State x = piece.step.x1;
    shift(x, (above ? 1.0 : -1.0) * rates.step(k) * at);
    field.modes() = piece.modes;
    MatrixXd saltation;
    if (!field.fire(x, 0.0, piece.event->guard, saltation)) return std::nullopt;
    change = above ? saltation : MatrixXd(change - saltation);
  }
  return MatrixXd(change / (2.0 * rates.step(k)));
}

/// All factors of the period in order; a switch is a factor of its own.
std::vector<const MatrixXd*> factors_of(const CyclePieces& cut, const Projected& nodes) {
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
Changes changes(const CyclePieces& cut, const Projected& nodes, const std::vector<std::optional<CarriedPair>>& pairs,
                Index k, const VectorXd& solution, ParameterRates& rates) {
  const Beside beside = go_beside(cut, k, solution);
  Changes sums(pairs.size());
  for (std::size_t m = 0; m < pairs.size(); ++m)
    if (pairs[m]) sums[m] = 0.0;
  std::size_t at = 0;
  const auto add = [&](const std::optional<MatrixXd>& change) {
    if (!change) return false;
    for (std::size_t m = 0; m < pairs.size(); ++m)
      if (pairs[m]) *sums[m] += pairs[m]->w[at].dot(*change * pairs[m]->v[at]);
    ++at;
    return true;
  };
  for (std::size_t i = 0; i < cut.pieces.size(); ++i) {
    const CyclePiece& piece = cut.pieces[i];
    const bool smooth = add(factor_change(piece, i, beside, nodes.across[i], k, rates)) &&
                        (!piece.event || add(saltation_change(piece, beside.end[i], k, rates)));
    if (!smooth) return Changes(pairs.size());
  }
  return sums;
}

}  // namespace

std::vector<std::vector<std::optional<Complex>>> multiplier_derivatives(const CyclePieces& cut,
                                                                        const std::vector<Complex>& multipliers,
                                                                        const MatrixXd& solution,
                                                                        ParameterRates& rates) {
  const Projected nodes = project(cut);
  const auto factors = factors_of(cut, nodes);
  MatrixXd whole = cut.sizes.asDiagonal();
  for (const MatrixXd* factor : factors) whole = (*factor * whole).eval();
  if (cut.mirror) whole = (cut.mirror->signs.asDiagonal() * whole).eval();
  whole = (cut.sizes.cwiseInverse().asDiagonal() * whole).eval();
  constexpr double least = 1e-9;  // of the largest: smaller values are rounding
  std::vector<std::optional<CarriedPair>> pairs;
  for (const Complex multiplier : multipliers) {
    auto pair =
        eigenpair(whole, cut.mirror ? std::sqrt(multiplier) : multiplier, cut.mirror ? std::sqrt(least) : least);
    if (cut.mirror) {  // one of the two roots is a multiplier of the half period
      const auto other = eigenpair(whole, -std::sqrt(multiplier), std::sqrt(least));
      const bool take_other = other && (!pair || other->defect < pair->defect);
      if (take_other) pair = other;
      // d(m^2) = 2 m dm; the reflection is the last factor.
      const Complex root = take_other ? -std::sqrt(multiplier) : std::sqrt(multiplier);
      if (pair) pair->w = (2.0 * std::conj(root) * pair->w).cwiseProduct(cut.mirror->signs.cast<Complex>());
    }
    pairs.push_back(pair ? std::optional(carry_pair(factors, cut.sizes, *pair)) : std::nullopt);
  }
  std::vector<Changes> result;
  for (Index k = 0; k < rates.count(); ++k) result.push_back(changes(cut, nodes, pairs, k, solution.col(k), rates));
  return result;
}

}  // namespace limcycle
