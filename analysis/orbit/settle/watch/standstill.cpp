#include "limcycle/analysis/orbit/settle/watch/standstill.hpp"

#include <cmath>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/settle/linear_motion.hpp"
#include "limcycle/analysis/orbit/settle/watch/rest_watch.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

VectorXd size_vector(const LoopSizes& scale) {
  return Eigen::Map<const VectorXd>(scale.sizes.data(), std::ssize(scale.sizes));
}

VectorXd of_state(const State& x) { return Eigen::Map<const VectorXd>(x.data(), std::ssize(x)); }
State to_state(const VectorXd& x) { return {x.begin(), x.end()}; }

/// Rates at x in sizes per slowest time constant.
VectorXd scaled_rates(LoopField& field, const State& x, const LoopSizes& scale) {
  State dx;
  field.rate(x, dx, 0.0);
  return (of_state(dx) * scale.slow).cwiseQuotient(size_vector(scale));
}

/// Their derivative by the states in sizes.
MatrixXd scaled_jacobian(LoopField& field, const State& x, const LoopSizes& scale) {
  State dx, unused(field.size());
  MatrixXd J;
  field.rate(x, dx, 0.0);
  field.jacobian(x, J, 0.0, unused);
  const VectorXd size = size_vector(scale);
  return scale.slow * size.cwiseInverse().asDiagonal() * J * size.asDiagonal();
}

Held held_by(const LoopField& field, std::size_t i) { return field.loop().elements[i].held(field.modes()[i]); }

/// Rows, in sizes, of the signals that elements hold.
MatrixXd held_rows(const LoopField& field, const LoopSizes& scale) {
  const Loop& loop = field.loop();
  const Index n = std::ssize(scale.sizes);
  MatrixXd rows(0, n);
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Held what = held_by(field, i);
    if (what == Held::nothing) continue;
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n);
    row.head(loop.states()) = what == Held::input ? loop.ports[i].C : loop.ports[i].C_v;
    row = row.cwiseProduct(size_vector(scale).transpose()).eval();
    rows.conservativeResize(rows.rows() + 1, n);
    rows.bottomRows(1) = row.normalized();
  }
  return rows;
}

/// True if the nonlinear part neglected by the linear motion is small against the decay, all around the steady state.
bool nearly_linear(LoopField& field, const State& centre, const LinearMotion& motion, const LoopSizes& scale) {
  const Index n = motion.amounts.size();
  const double most = motion.amounts.cwiseAbs().maxCoeff();
  if (most == 0.0) return true;
  const VectorXcd reach = motion.amounts.cwiseAbs().cwiseMax(0.1 * most).cast<std::complex<double>>();
  const auto small_at = [&](const VectorXcd& amounts) {
    const State x = motion.around(centre, amounts);
    const VectorXd away = (of_state(x) - of_state(centre)).cwiseQuotient(motion.sizes);
    const VectorXcd rest =
        motion.inverse * (scaled_rates(field, x, scale) - motion.J * away).cast<std::complex<double>>();
    for (Index k = 0; k < n; ++k)
      if (!motion.neutral[static_cast<std::size_t>(k)] &&
          !(std::abs(rest(k)) <= 0.3 * -motion.eigenvalues(k).real() * std::abs(reach(k)) + 1e-14))
        return false;
    return true;
  };
  for (const double sign : {1.0, -1.0}) {
    if (!small_at(sign * motion.amounts) || !small_at(sign * reach)) return false;
    for (Index k = 0; k < n; ++k)
      for (const std::complex<double> turn : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)})
        if (!small_at(VectorXcd::Unit(n, k) * (sign * reach(k) * turn))) return false;
  }
  return true;
}

}  // namespace

bool is_stuck(const LoopField& field) {
  const auto& elements = field.loop().elements;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (field.holds(i) && elements[i].may_stick()) return true;
  return false;
}

bool rubs_at(const LoopField& field, const State& x) {
  const Loop& loop = field.loop();
  const std::size_t last = loop.elements.size() - 1;
  if (!loop.ports[last].rubs || held_by(field, last) == Held::rate) return false;
  const Eigen::Map<const VectorXd> X(x.data(), loop.states());
  return std::abs((loop.ports[last].C_v * X + loop.ports[last].c_v * loop.external).value()) > rubbing_speed(loop);
}

LoopSizes loop_sizes(const Loop& loop) { return {typical_sizes(loop), slow_time(loop)}; }

std::optional<Standstill> standstill_near(LoopField& field, const State& x, const LoopSizes& scale) {
  constexpr double exact = 1e-11, good = 1e-8;
  const VectorXd size = size_vector(scale);
  Standstill found{x, 0.0, 0.0, false};
  for (int i = 0; i < 20; ++i) {
    const VectorXd rates = scaled_rates(field, found.x, scale);
    if (!rates.allFinite()) return std::nullopt;
    found.residual = rates.cwiseAbs().maxCoeff();
    if (found.residual <= exact) break;
    const MatrixXd J = scaled_jacobian(field, found.x, scale);
    if (!J.allFinite()) return std::nullopt;
    const VectorXd step = least_squares(J, -rates, 1e-12);
    found.x = to_state(of_state(found.x) + step.cwiseProduct(size));
    if (step.cwiseAbs().maxCoeff() <= 1e-15) break;
  }
  found.residual = scaled_rates(field, found.x, scale).cwiseAbs().maxCoeff();
  if (!(found.residual <= good)) return std::nullopt;
  found.moved = (of_state(found.x) - of_state(x)).cwiseQuotient(size).cwiseAbs().maxCoeff();
  std::vector<double> before, after;
  field.guards(x, 0.0, before);
  field.guards(found.x, 0.0, after);
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i] < -1e-3 * std::abs(before[i])) return std::nullopt;
  found.slides = rubs_at(field, found.x);
  return found;
}

std::optional<Approach> approach_from(LoopField& field, const State& x, const LoopSizes& scale) {
  State centre = x;
  LinearMotion motion;
  const bool affine = AffineFlow::applies(field.loop());
  for (int i = 0; i < 10; ++i) {
    motion = linear_motion(scaled_jacobian(field, centre, scale), scaled_rates(field, centre, scale),
                           held_rows(field, scale), size_vector(scale));
    if (!motion.settles) return std::nullopt;
    centre = motion.around(centre, -motion.amounts);
    if (affine || motion.amounts.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  const double residual = scaled_rates(field, centre, scale).cwiseAbs().maxCoeff();
  if (!(residual <= 1e-9)) return std::nullopt;
  const VectorXd away = (of_state(x) - of_state(centre)).cwiseQuotient(size_vector(scale));
  motion.amounts = motion.inverse * away.cast<std::complex<double>>();
  for (Index k = 0; k < motion.amounts.size(); ++k)
    if (motion.neutral[static_cast<std::size_t>(k)]) motion.amounts(k) = 0.0;
  const auto guards = [&](const State& at, std::vector<double>& values) { field.guards(at, 0.0, values); };
  if (!stay_positive(guards, centre, motion)) return std::nullopt;
  if (!affine && !nearly_linear(field, centre, motion, scale)) return std::nullopt;
  return Approach{{centre, residual, away.cwiseAbs().maxCoeff(), rubs_at(field, centre)}, motion.decay / scale.slow};
}

bool held_while_winding_up(LoopField& field, const State& x, const State& dx, const LoopSizes& scale) {
  constexpr double still = 1e-12, constant = 1e-6, for_ever = 1e9;
  if (rubs_at(field, x)) return false;
  const Loop& loop = field.loop();
  const VectorXd rates = (of_state(dx) * scale.slow).cwiseQuotient(size_vector(scale));
  const VectorXd row = loop.C_y.transpose().cwiseProduct(size_vector(scale).head(loop.states()));
  if (std::abs(row.dot(rates.head(loop.states()))) > still * row.cwiseAbs().sum()) return false;
  const VectorXd change = scaled_jacobian(field, x, scale) * rates;
  if (!(change.cwiseAbs().maxCoeff() <= constant * rates.cwiseAbs().maxCoeff())) return false;
  std::vector<double> now, later;
  field.guards(x, 0.0, now);
  field.guards(to_state(of_state(x) + for_ever * scale.slow * of_state(dx)), 0.0, later);
  for (std::size_t i = 0; i < now.size(); ++i)
    if (later[i] < 0.0 && later[i] < now[i]) return false;
  return true;
}

bool slides_steadily(LoopField& field, const State& x, const State& dx, const LoopSizes& scale) {
  if (!rubs_at(field, x)) return false;
  const VectorXd rates = (of_state(dx) * scale.slow).cwiseQuotient(size_vector(scale));
  const VectorXd change = scaled_jacobian(field, x, scale) * rates;
  return change.cwiseAbs().maxCoeff() <= 1e-6 * rates.cwiseAbs().maxCoeff();
}

}  // namespace limcycle
