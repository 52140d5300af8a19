#include "limcycle/analysis/study/balance/output_per_input.hpp"

#include <cmath>
#include <optional>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/models/linear/balance.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

/// Factor between two units of the same motion: y = factor x for every state.
std::optional<double> same_motion(const Loop& loop, const Port& main) {
  const double size = main.C.squaredNorm();
  if (!(size > 0.0)) return std::nullopt;
  const double factor = loop.C_y.dot(main.C) / size;
  const bool same = factor > 0.0 && (loop.C_y - factor * main.C).norm() <= 1e-12 * loop.C_y.norm();
  return same ? std::optional(factor) : std::nullopt;
}

/// |y/x| under a force exp(s t) on the plant. The controller does not matter: its command acts at the same place.
double rubbing_ratio(const Loop& loop, const Port& main, double s) {
  const Eigen::Index n = loop.states();
  const Complex at(0.0, s);
  const Eigen::MatrixXcd M = at * Eigen::MatrixXcd::Identity(n, n) -
                             (loop.A + loop.A_delayed).cast<Complex>();  // slow against the delay, shared by both
  // Both y and x vanish with s if the controller integrates: in other units of the states they would be rounding.
  const Eigen::VectorXd units = balancing_units(loop.A + loop.A_delayed);
  const Eigen::MatrixXcd balanced = units.cwiseInverse().asDiagonal() * M * units.asDiagonal();
  const Eigen::VectorXcd force = units.cwiseInverse().cwiseProduct(loop.E.col(external_force)).cast<Complex>();
  const Eigen::VectorXcd X = units.cast<Complex>().cwiseProduct(solve(balanced, force));
  const Complex x =
      main.C.isZero(0.0) ? (main.C_v.cast<Complex>() * X).value() / at : (main.C.cast<Complex>() * X).value();
  return std::abs((loop.C_y.cast<Complex>() * X).value() / x);
}

double six_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 5.0);
  return std::round(value / unit) * unit;
}

}  // namespace

double output_per_input(const Loop& loop) {
  const Port& main = loop.ports.back();
  if (const auto factor = same_motion(loop, main)) return *factor;
  if (!main.rubs) return 1.0;
  const auto moduli = pole_moduli(loop);
  const double slow = moduli.empty() ? 1.0 : moduli.front(), fast = moduli.empty() ? 1.0 : moduli.back();
  const double ratio = rubbing_ratio(loop, main, 1e-5 * slow), slower = rubbing_ratio(loop, main, 1e-6 * slow);
  if (ratio > 0.0 && std::abs(slower - ratio) < 1e-3 * ratio) return six_digits(ratio);
  const double middle = rubbing_ratio(loop, main, std::sqrt(slow * fast));
  return middle > 0.0 && std::isfinite(middle) ? six_digits(middle) : 1.0;
}

}  // namespace limcycle
