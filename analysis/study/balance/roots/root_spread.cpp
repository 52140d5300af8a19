#include "limcycle/analysis/study/balance/roots/root_spread.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"

namespace limcycle {
namespace {

constexpr double difference = 1e-4;  ///< step of ln a, ln w and ln G

/// Real and imaginary part of the balance, and ln of the amplitude of y.
Eigen::Vector3d values(const Loop& loop, const RootOf& root, double a, double w) {
  const std::complex<double> f = root.balance(loop, a, w);
  return {f.real(), f.imag(), std::log(root.amplitude(loop, a, w))};
}

/// First derivatives at a root.
struct RootSlopes {
  Eigen::Matrix<double, 3, 2> slopes;  ///< of values() by ln a and ln w
  Eigen::Matrix2d back;                ///< inverse of those of the balance
};
std::optional<RootSlopes> slopes_at(const Loop& loop, const RootOf& root, double a, double w) {
  const double up = std::exp(difference), down = 1.0 / up;
  RootSlopes found;
  found.slopes.col(0) = (values(loop, root, a * up, w) - values(loop, root, a * down, w)) / (2.0 * difference);
  found.slopes.col(1) = (values(loop, root, a, w * up) - values(loop, root, a, w * down)) / (2.0 * difference);
  const Eigen::Matrix2d balance = found.slopes.topRows<2>();
  const double size = balance.col(0).norm() * balance.col(1).norm();
  if (!found.slopes.allFinite() || !(std::abs(balance.determinant()) > 1e-9 * size)) return std::nullopt;
  found.back = balance.inverse();
  return found;
}

/// Changes of ln amplitude of y and ln w that keep the balance while a number changes values() by that.
Eigen::Vector2d kept(const RootSlopes& at, const Eigen::Vector3d& by) {
  const Eigen::Vector2d step = -at.back * by.head<2>();  // of ln a and ln w
  return {by(2) + at.slopes.row(2) * step, step(1)};
}

/// A sampled loop of which everything that leaves the controller is that much later; empty where another part of it
/// reads all of that.
std::optional<Loop> later(Loop loop, double by) {
  bool any = false;
  auto sampled = std::make_shared<Loop>(*loop.sampled);
  const auto is_read_on_clock = [&](std::size_t j) {
    for (std::size_t i = 0; i < sampled->elements.size(); ++i)
      if (sampled_at(*sampled, i) && sampled->ports[i].D(static_cast<Eigen::Index>(j)) != 0.0) return true;
    return false;
  };
  for (std::size_t j = 0; j < sampled->elements.size(); ++j) {
    const auto* part = sampled_at(*sampled, j);
    if (part == nullptr || is_read_on_clock(j)) continue;
    Sampled<double> moved = *part;
    moved.computation_delay += by;
    sampled->elements[j] = Element(moved);
    any = true;
  }
  if (!any) return std::nullopt;
  loop.sampled = std::move(sampled);
  return loop;
}

}  // namespace

std::optional<RootSpread> root_spread(const Loop& loop, const RootOf& root, double a, double w) {
  const bool known =
      std::ranges::any_of(loop.measured, [&](const MeasuredPart& part) { return part.response->deviation(w) > 0.0; });
  if (!known) return std::nullopt;
  const auto at = slopes_at(loop, root, a, w);
  if (!at) return std::nullopt;
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();
  Loop moved = loop;
  for (MeasuredPart& part : moved.measured) {
    const double deviation = part.response->deviation(w);
    for (const std::complex<double> direction : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)}) {
      part.factor = 1.0 + difference * direction;
      const Eigen::Vector3d above = values(moved, root, a, w);
      part.factor = 1.0 - difference * direction;
      const Eigen::Vector3d by_data = (above - values(moved, root, a, w)) * (deviation / (2.0 * difference));
      variance += kept(*at, by_data).cwiseAbs2();
    }
    part.factor = 1.0;
  }
  if (!variance.allFinite()) return std::nullopt;
  return RootSpread{std::sqrt(variance(0)), std::sqrt(variance(1))};
}

std::optional<RootSpread> sampling_band(const Loop& loop, const RootOf& root, double a, double w) {
  if (!loop.sampled) return std::nullopt;
  const auto at = slopes_at(loop, root, a, w);
  if (!at) return std::nullopt;
  const double half = 0.5 * sample_time(*loop.sampled), step = difference / w;
  const auto late = later(loop, step), early = later(loop, -step);
  if (!late || !early) return std::nullopt;
  const Eigen::Vector3d by = (values(*late, root, a, w) - values(*early, root, a, w)) * (half / (2.0 * step));
  const Eigen::Vector2d moved = kept(*at, by).cwiseAbs();
  if (!moved.allFinite()) return std::nullopt;
  return RootSpread{moved(0), moved(1)};
}

}  // namespace limcycle
