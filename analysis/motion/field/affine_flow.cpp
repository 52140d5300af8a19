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

/// exp(A) as I + X, X = exp(A) - I by its series on A/2^s, then X <- 2 X + X^2 s times: components that A leaves
/// unchanged stay unchanged to the last bit (squaring exp(A/2^s) itself would multiply the rounding of its ones by
/// 2^s).
MatrixXd exponential(const MatrixXd& A) {
  const Index n = A.rows();
  const double norm = A.cwiseAbs().colwise().sum().maxCoeff();
  const int s = norm > 0.5 && std::isfinite(norm) ? static_cast<int>(std::ceil(std::log2(norm / 0.5))) : 0;
  const MatrixXd B = A * std::ldexp(1.0, -s), I = MatrixXd::Identity(n, n);
  MatrixXd X = B / 16.0;
  for (int k = 15; k >= 1; --k) X = (B / k * (I + X)).eval();
  for (int i = 0; i < s; ++i) X = (2.0 * X + X * X).eval();
  return I + X;
}

}  // namespace

AffineFlow::InMode& AffineFlow::present() {
  std::vector<std::int64_t> key;
  for (const Mode mode : field_->modes()) key.push_back(mode.value);
  const auto known = modes_.find(key);
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
  return modes_.emplace(std::move(key), std::move(fresh)).first->second;
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
  return mode.powers.emplace(k, exponential(mode.generator * std::ldexp(1.0, k))).first->second;
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
