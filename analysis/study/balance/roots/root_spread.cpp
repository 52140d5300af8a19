#include "limcycle/analysis/study/balance/roots/root_spread.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

constexpr double difference = 1e-4;  ///< step of ln a, ln w and ln G

/// Real and imaginary part of the balance, and ln of the amplitude of y.
Eigen::Vector3d values(const Loop& loop, const RootOf& root, double a, double w) {
  const std::complex<double> f = root.balance(loop, a, w);
  return {f.real(), f.imag(), std::log(root.amplitude(loop, a, w))};
}

}  // namespace

std::optional<RootSpread> root_spread(const Loop& loop, const RootOf& root, double a, double w) {
  const bool known =
      std::ranges::any_of(loop.measured, [&](const MeasuredPart& part) { return part.response->deviation(w) > 0.0; });
  if (!known) return std::nullopt;
  const double up = std::exp(difference), down = 1.0 / up;
  Eigen::Matrix<double, 3, 2> slopes;
  slopes.col(0) = (values(loop, root, a * up, w) - values(loop, root, a * down, w)) / (2.0 * difference);
  slopes.col(1) = (values(loop, root, a, w * up) - values(loop, root, a, w * down)) / (2.0 * difference);
  const Eigen::Matrix2d balance = slopes.topRows<2>();
  const double size = balance.col(0).norm() * balance.col(1).norm();
  if (!slopes.allFinite() || !(std::abs(balance.determinant()) > 1e-9 * size)) return std::nullopt;
  const Eigen::Matrix2d back = balance.inverse();
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();
  Loop moved = loop;
  for (MeasuredPart& part : moved.measured) {
    const double deviation = part.response->deviation(w);
    for (const std::complex<double> direction : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)}) {
      part.factor = 1.0 + difference * direction;
      const Eigen::Vector3d above = values(moved, root, a, w);
      part.factor = 1.0 - difference * direction;
      const Eigen::Vector3d by_data = (above - values(moved, root, a, w)) * (deviation / (2.0 * difference));
      const Eigen::Vector2d step = -back * by_data.head<2>();  // of ln a and ln w, which keeps the balance
      const double in_y = by_data(2) + slopes.row(2) * step;
      variance += Eigen::Vector2d(in_y * in_y, step(1) * step(1));
    }
    part.factor = 1.0;
  }
  if (!variance.allFinite()) return std::nullopt;
  return RootSpread{std::sqrt(variance(0)), std::sqrt(variance(1))};
}

}  // namespace limcycle
