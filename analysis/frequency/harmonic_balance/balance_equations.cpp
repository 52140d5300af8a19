#include "limcycle/analysis/frequency/harmonic_balance/balance_equations.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Square root of the sum of |harmonic|^2 over all orders above 0.
double oscillation(const VectorXcd& series) { return series.size() < 2 ? 0.0 : series.tail(series.size() - 1).norm(); }

const VectorXcd& at(const std::vector<VectorXcd>& list, Index k) { return list[static_cast<std::size_t>(k)]; }

}  // namespace

BalanceEquations::BalanceEquations(const Loop& loop, bool half_wave) : loop_(loop), half_wave_(half_wave) {
  for (const auto& element : loop.elements) responses_.emplace_back(element);
  still_ = loop.A + loop.A_delayed;
  pull_ = loop.E * loop.external;
  const Index n = loop.states();
  null_ = kernel(still_).colwise().normalized();
  left_null_ = kernel(still_.transpose()).colwise().normalized();
  pseudo_inverse_ = null_.cols() == 0 ? solve_columns_fully_pivoted(still_, Eigen::MatrixXd::Identity(n, n))
                                      : limcycle::pseudo_inverse(still_);
  const Index ne = elements(), free = null_.cols();
  resting_ = means(VectorXd::Zero(ne), VectorXd::Zero(free));
  mean_inputs_.resize(ne, ne + free);
  mean_rates_.resize(ne, ne + free);
  for (Index j = 0; j < ne + free; ++j) {
    const VectorXd unit = VectorXd::Unit(ne + free, j);
    const BalanceMeans moved = means(unit.head(ne), unit.tail(free));
    mean_inputs_.col(j) = moved.inputs - resting_.inputs;
    mean_rates_.col(j) = moved.rates - resting_.rates;
  }
}

BalanceMeans BalanceEquations::means(const VectorXd& mean_outputs, const VectorXd& free) const {
  const VectorXd force = pull_ + loop_.B * mean_outputs;
  BalanceMeans result{null_ * free - pseudo_inverse_ * force, VectorXd(elements()), VectorXd(elements())};
  // As long as the means are not in balance the linear part drifts; the drift does not count as a rate.
  const VectorXd drift = still_ * result.state + force;
  for (Index k = 0; k < elements(); ++k) {
    const Port& port = loop_.ports[static_cast<std::size_t>(k)];
    result.inputs(k) =
        ((port.C + port.C_delayed) * result.state + port.D * mean_outputs + port.c * loop_.external).value();
    const double rate = (port.C_v * result.state + port.D_v * mean_outputs + port.c_v * loop_.external).value();
    const double terms = port.C_v.cwiseAbs().dot(result.state.cwiseAbs()) +
                         port.D_v.cwiseAbs().dot(mean_outputs.cwiseAbs()) +
                         port.c_v.cwiseAbs().dot(loop_.external.cwiseAbs());
    const double moving = rate - (port.C * drift).value();
    result.rates(k) = std::abs(moving) <= 1e-12 * terms ? 0.0 : moving;
  }
  return result;
}

VectorXd BalanceEquations::closest_free(const VectorXd& mean_outputs, const VectorXd& inputs) const {
  VectorXd none = VectorXd::Zero(null_.cols());
  if (null_.cols() == 0) return none;
  Eigen::MatrixXd rows(elements(), loop_.states());
  for (Index k = 0; k < elements(); ++k) {
    const Port& port = loop_.ports[static_cast<std::size_t>(k)];
    rows.row(k) = port.C + port.C_delayed;
  }
  const VectorXd missing = inputs - means(mean_outputs, none).inputs;
  return least_squares(rows * null_, missing);
}

void BalanceEquations::set_reference(const BalancePoint& point, const BalanceOutputs& outputs) {
  const Index ne = elements();
  orders_ = static_cast<int>(at(point.inputs, 0).size()) - 1;
  input_scale_.resize(ne);
  output_scale_.resize(ne);
  for (Index k = 0; k < ne; ++k) {
    const double own = loop_.elements[static_cast<std::size_t>(k)].scales().output;
    input_scale_(k) = oscillation(at(point.inputs, k));
    output_scale_(k) = std::max(at(outputs.harmonics, k).norm(), 1e-6 * own);
  }
  const double smallest = 1e-9 * input_scale_.maxCoeff();
  for (Index k = 0; k < ne; ++k) input_scale_(k) = std::max(input_scale_(k), smallest);
  const Complex first = at(point.inputs, main())(1);
  main_cosine_ = first.imag();
  main_amplitude_ = std::abs(first);
  free_scale_ = VectorXd::Ones(null_.cols());
  balance_scale_ = VectorXd::Ones(null_.cols());
  for (Index i = 0; i < null_.cols(); ++i) {
    double seen = 0.0;
    for (Index k = 0; k < ne; ++k) {
      const Port& port = loop_.ports[static_cast<std::size_t>(k)];
      seen = std::max(seen, std::abs(((port.C + port.C_delayed) * null_.col(i)).value()) / input_scale_(k));
    }
    if (seen > 0.0) free_scale_(i) = 1.0 / seen;
    const double force = (left_null_.col(i).transpose() * loop_.B).cwiseAbs() * output_scale_;
    const double given = left_null_.col(i).cwiseAbs().dot(pull_.cwiseAbs());
    if (force + given > 0.0) balance_scale_(i) = force > 0.0 ? force : given;
  }
}

PrescribedHarmonics BalanceEquations::motion(const BalancePoint& point, const BalanceMeans& means, Index k) const {
  VectorXcd input = at(point.inputs, k);
  input(0) = half_wave_ ? 0.0 : Complex(0.0, means.inputs(k));
  return {input, point.frequency, half_wave_ ? 0.0 : means.rates(k), half_wave_};
}

BalanceOutputs BalanceEquations::outputs(const BalancePoint& point, int orders, const BalanceMeans* given) {
  BalanceOutputs result;
  BalanceMeans mean;
  if (!half_wave_) mean = given != nullptr ? *given : means(point.mean_outputs, point.free);
  for (Index k = 0; k < elements(); ++k) {
    const VectorXcd& input = at(point.inputs, k);
    if (!input.allFinite() || !(oscillation(input) > 0.0) || !std::isfinite(point.frequency)) {
      result.status = Status::not_finite;
      return result;
    }
    HarmonicResponse response =
        responses_[static_cast<std::size_t>(k)](motion(point, mean, k), orders, level_, tolerance_);
    evaluations_ += response.evaluations;
    if (response.status != Status::converged) {
      result.status = response.status;
      return result;
    }
    result.harmonics.push_back(std::move(response.harmonics));
  }
  return result;
}

VectorXd BalanceEquations::pack(const BalancePoint& point) const {
  VectorXd u(unknowns());
  Index i = 0;
  for (Index k = 0; k < elements(); ++k) {
    for (Index n = 1; n <= orders_; n += stride()) {
      const Complex x = at(point.inputs, k)(n) / input_scale_(k);
      u(i++) = x.real();
      u(i++) = k == main() && n == 1 ? std::log(point.frequency) : x.imag();
    }
  }
  if (half_wave_) return u;
  for (Index k = 0; k < elements(); ++k) u(i++) = point.mean_outputs(k) / output_scale_(k);
  for (Index q = 0; q < null_.cols(); ++q) u(i++) = point.free(q) / free_scale_(q);
  return u;
}

BalancePoint BalanceEquations::unpack(const VectorXd& u) const {
  const Index ne = elements();
  BalancePoint point{0.0, std::vector<VectorXcd>(static_cast<std::size_t>(ne), VectorXcd::Zero(orders_ + 1)),
                     VectorXd::Zero(ne), VectorXd::Zero(null_.cols())};
  Index i = 0;
  for (Index k = 0; k < ne; ++k) {
    for (Index n = 1; n <= orders_; n += stride(), i += 2) {
      const bool fixed = k == main() && n == 1;
      if (fixed) point.frequency = std::exp(u(i + 1));
      point.inputs[static_cast<std::size_t>(k)](n) = {u(i) * input_scale_(k),
                                                      fixed ? main_cosine_ : u(i + 1) * input_scale_(k)};
    }
  }
  if (half_wave_) return point;
  for (Index k = 0; k < ne; ++k) point.mean_outputs(k) = u(i++) * output_scale_(k);
  for (Index q = 0; q < null_.cols(); ++q) point.free(q) = u(i++) * free_scale_(q);
  return point;
}

VectorXd BalanceEquations::residual(const BalancePoint& point, const BalanceOutputs& outputs) const {
  const Index ne = elements(), per = per_element();
  VectorXd r(unknowns());
  VectorXcd W(ne);
  const double away = std::abs(at(point.inputs, main())(1)) / main_amplitude_;
  Index i = 0;
  for (int n = 1; n <= orders_; n += stride(), ++i) {
    for (Index k = 0; k < ne; ++k) W(k) = at(outputs.harmonics, k)(n);
    const VectorXcd X = response(n, point.frequency) * W;
    for (Index k = 0; k < ne; ++k) {
      const Complex defect = (at(point.inputs, k)(n) - X(k)) / (input_scale_(k) * away);
      r(2 * (k * per + i)) = defect.real();
      r(2 * (k * per + i) + 1) = defect.imag();
    }
  }
  if (half_wave_) return r;
  i = 2 * ne * per;
  for (Index k = 0; k < ne; ++k)
    r(i++) = (point.mean_outputs(k) - at(outputs.harmonics, k)(0).imag()) / output_scale_(k);
  const VectorXd force = left_null_.transpose() * (pull_ + loop_.B * point.mean_outputs);
  for (Index q = 0; q < null_.cols(); ++q) r(i++) = force(q) / balance_scale_(q);
  return r;
}

/// Columns of an element's own derivative (its input's harmonics, frequency, mean, mean rate) brought to the unknowns.
Eigen::MatrixXd BalanceEquations::by_unknowns(const Eigen::MatrixXd& own, Index l, double frequency) const {
  const Index per = per_element(), first = 2 * l * per;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(own.rows(), unknowns());
  result.middleCols(first, 2 * per) = own.leftCols(2 * per) * input_scale_(l);
  if (l == main()) result.col(first + 1).setZero();
  result.col(main_index() + 1) += own.col(2 * per) * frequency;
  if (half_wave_) return result;
  const Index means = 2 * elements() * per;
  for (Index j = 0; j < mean_inputs_.cols(); ++j) {
    const double scale = j < elements() ? output_scale_(j) : free_scale_(j - elements());
    result.col(means + j) =
        (own.col(2 * per + 1) * mean_inputs_(l, j) + own.col(2 * per + 2) * mean_rates_(l, j)) * scale;
  }
  return result;
}

bool BalanceEquations::jacobian(const BalancePoint& point, const BalanceOutputs& outputs, Eigen::MatrixXd& J) {
  const Index ne = elements(), per = per_element(), size = unknowns(), w_column = main_index() + 1;
  const double w = point.frequency;
  BalanceMeans mean;
  if (!half_wave_) mean = means(point.mean_outputs, point.free);
  std::vector<Eigen::MatrixXd> dW;
  for (Index l = 0; l < ne; ++l) {
    Eigen::MatrixXd own;
    const HarmonicResponse answer = responses_[static_cast<std::size_t>(l)].with_derivative(
        motion(point, mean, l), orders_, level_, tolerance_, own);
    evaluations_ += answer.evaluations;
    if (answer.status != Status::converged || !own.allFinite()) return false;
    dW.push_back(by_unknowns(own, l, w));
  }
  J.setZero(size, size);
  const VectorXd r = residual(point, outputs);
  const Complex first = at(point.inputs, main())(1);
  const double away = std::abs(first) / main_amplitude_, part = 1e-5;
  const Index offset = half_wave_ ? 0 : 2;  // rows of the mean output come first
  VectorXcd W(ne);
  Index i = 0;
  for (int n = 1; n <= orders_; n += stride(), ++i) {
    const Eigen::MatrixXcd H = response(n, w);
    const Eigen::MatrixXcd slope = (response(n, w * (1.0 + part)) - response(n, w * (1.0 - part))) / (2.0 * part);
    for (Index k = 0; k < ne; ++k) W(k) = at(outputs.harmonics, k)(n);
    const VectorXcd by_frequency = slope * W;
    for (Index k = 0; k < ne; ++k) {
      const Index row = 2 * (k * per + i);
      const double scale = input_scale_(k) * away;
      for (Index l = 0; l < ne; ++l) {
        const double re = H(k, l).real(), im = H(k, l).imag();
        const auto b = dW[static_cast<std::size_t>(l)].row(offset + 2 * i);
        const auto a = dW[static_cast<std::size_t>(l)].row(offset + 2 * i + 1);
        J.row(row) -= (re * b - im * a) / scale;
        J.row(row + 1) -= (re * a + im * b) / scale;
      }
      J(row, w_column) -= by_frequency(k).real() / scale;
      J(row + 1, w_column) -= by_frequency(k).imag() / scale;
      J(row, row) += 1.0 / away;
      if (row + 1 != w_column) J(row + 1, row + 1) += 1.0 / away;
    }
  }
  const double grows = input_scale_(main()) * first.real() / std::norm(first);
  J.col(main_index()).head(2 * ne * per) -= grows * r.head(2 * ne * per);
  if (half_wave_) return true;
  i = 2 * ne * per;
  for (Index k = 0; k < ne; ++k, ++i) {
    J.row(i) = -dW[static_cast<std::size_t>(k)].row(1) / output_scale_(k);
    J(i, i) += 1.0;
  }
  for (Index q = 0; q < null_.cols(); ++q, ++i)
    for (Index k = 0; k < ne; ++k)
      J(i, 2 * ne * per + k) = left_null_.col(q).dot(loop_.B.col(k)) * output_scale_(k) / balance_scale_(q);
  return true;
}

}  // namespace limcycle
