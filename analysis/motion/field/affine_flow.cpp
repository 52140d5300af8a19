#include "limcycle/analysis/motion/field/affine_flow.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {

using Eigen::Index;
using Eigen::MatrixXd;

bool AffineFlow::applies(const Loop& loop) {
  return std::ranges::all_of(loop.elements, [](const auto& element) { return element.facts().piecewise_affine; });
}

namespace {

constexpr double largest_norm = 0.5;  ///< of a matrix whose exponential is that series
constexpr int terms = 15;

double norm_of(const MatrixXd& A) { return A.cwiseAbs().colwise().sum().maxCoeff(); }

/// How often A must be halved.
int halvings(const MatrixXd& A) {
  const double norm = norm_of(A);
  return norm > largest_norm && std::isfinite(norm) ? static_cast<int>(std::ceil(std::log2(norm / largest_norm))) : 0;
}

/// X = exp(B) - I of a small matrix, by its series.
MatrixXd series(const MatrixXd& B) {
  const MatrixXd I = MatrixXd::Identity(B.rows(), B.cols());
  MatrixXd X = B / (terms + 1.0);
  for (int k = terms; k >= 1; --k) X = (B / k * (I + X)).eval();
  return X;
}

/// exp(2 B) - I of X = exp(B) - I: components that B leaves unchanged stay unchanged to the last bit (squaring exp(B)
/// itself would double the rounding of its ones).
MatrixXd doubled(const MatrixXd& X) { return 2.0 * X + X * X; }

MatrixXd exponential(const MatrixXd& A) {
  const int s = halvings(A);
  MatrixXd X = series(A * std::ldexp(1.0, -s));
  for (int i = 0; i < s; ++i) X = doubled(X);
  return MatrixXd::Identity(A.rows(), A.cols()) + X;
}

}  // namespace

AffineFlow::InMode& AffineFlow::present() {
  key_.clear();
  for (const Mode mode : field_->modes()) key_.push_back(mode.value);
  const auto known = modes_.find(key_);
  if (known != modes_.end()) return known->second;
  const auto n = static_cast<Index>(field_->size());
  const State zero(field_->size(), 0.0);
  State constant, time;
  MatrixXd J;
  field_->rate(zero, constant, 0.0);
  field_->jacobian(zero, J, 0.0, time);
  InMode fresh;
  fresh.generator = MatrixXd::Zero(n + 1, n + 1);
  fresh.generator.topLeftCorner(n, n) = J;
  fresh.generator.topRightCorner(n, 1) = Eigen::Map<const Eigen::VectorXd>(constant.data(), n);
  fresh.least = -halvings(fresh.generator);
  return modes_.emplace(key_, std::move(fresh)).first->second;
}

/// exp(M 2^k s) - I for k >= mode.least, from those before it.
const MatrixXd& AffineFlow::doubled_to(InMode& mode, int k) {
  if (mode.doublings.empty()) mode.doublings.push_back(series(mode.generator * std::ldexp(1.0, mode.least)));
  while (mode.least + static_cast<int>(mode.doublings.size()) <= k)
    mode.doublings.push_back(doubled(mode.doublings.back()));
  return mode.doublings[static_cast<std::size_t>(k - mode.least)];
}

MatrixXd AffineFlow::over(double h) {
  constexpr std::size_t most = 4;
  InMode& mode = present();
  const auto known = std::ranges::find(mode.last, h, &std::pair<double, MatrixXd>::first);
  if (known != mode.last.end()) return known->second;
  if (mode.last.size() == most) mode.last.erase(mode.last.begin());
  return mode.last.emplace_back(h, exponential(mode.generator * h)).second;
}

const MatrixXd& AffineFlow::over_power(int k) {
  InMode& mode = present();
  const auto known = mode.powers.find(k);
  if (known != mode.powers.end()) return known->second;
  const Index n = mode.generator.rows();
  const MatrixXd X = k < mode.least ? series(mode.generator * std::ldexp(1.0, k)) : doubled_to(mode, k);
  return mode.powers.emplace(k, MatrixXd::Identity(n, n) + X).first->second;
}

void AffineFlow::move(double h, const State& x, State& out) {
  InMode& mode = present();
  const Index n = mode.generator.rows() - 1;
  Eigen::VectorXd& y = moved_;
  y.resize(n + 1);
  y << Eigen::Map<const Eigen::VectorXd>(x.data(), n), 1.0;
  if (std::isfinite(h) && h > 0.0)
    for (int k = std::ilogb(h); k >= mode.least; --k) {
      const double part = std::ldexp(1.0, k);
      if (h < part) continue;
      part_.noalias() = doubled_to(mode, k) * y;
      y += part_;
      h -= part;  // exactly: the leading digit of h
    }
  term_ = y;
  for (int k = 1; h > 0.0 && k <= terms + 1; ++k) {
    part_.noalias() = mode.generator * term_;
    term_ = part_ * (h / k);
    y += term_;
  }
  out.assign(y.begin(), y.begin() + n);
}

MatrixXd AffineFlow::over_step(double h) {
  constexpr double of_times = 1e-11;
  const double power = std::log2(h), nearest = std::round(power);
  if (std::isfinite(nearest) && std::abs(power - nearest) < of_times) return over_power(static_cast<int>(nearest));
  return over(h);
}

void AffineFlow::apply(const MatrixXd& exponential, const State& x, State& out) {
  const auto n = static_cast<Index>(x.size());
  const Eigen::VectorXd moved = exponential.topLeftCorner(n, n) * Eigen::Map<const Eigen::VectorXd>(x.data(), n) +
                                exponential.topRightCorner(n, 1);
  out.assign(moved.begin(), moved.end());
}

}  // namespace limcycle
