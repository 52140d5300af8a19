#include "limcycle/analysis/motion/affine_flow.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace limcycle {

using Eigen::Index;
using Eigen::MatrixXd;

bool AffineFlow::applies(const Loop& loop) {
  return std::ranges::all_of(loop.elements, [](const auto& element) {
    return std::visit([]<class E>(const E&) { return PiecewiseAffine<E>; }, element);
  });
}

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

MatrixXd AffineFlow::over(double h) { return (present().generator * h).exp(); }

const MatrixXd& AffineFlow::over_power(int k) {
  InMode& mode = present();
  const auto known = mode.powers.find(k);
  if (known != mode.powers.end()) return known->second;
  return mode.powers.emplace(k, (mode.generator * std::ldexp(1.0, k)).exp()).first->second;
}

void AffineFlow::apply(const MatrixXd& exponential, const State& x, State& out) {
  const auto n = static_cast<Index>(x.size());
  const Eigen::VectorXd moved = exponential.topLeftCorner(n, n) * Eigen::Map<const Eigen::VectorXd>(x.data(), n) +
                                exponential.topRightCorner(n, 1);
  out.assign(moved.begin(), moved.end());
}

}  // namespace limcycle
