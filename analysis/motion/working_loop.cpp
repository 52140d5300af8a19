#include "limcycle/analysis/motion/working_loop.hpp"

#include <Eigen/Core>

#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/reset_integrator.hpp"
#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The outputs of all elements once some are gains: w = from_states X + from_delayed X(t - delay) + from_external ext +
/// outputs w', with w' the outputs of those that stay.
struct Replaced {
  MatrixXd from_states, from_delayed, from_external, outputs;
};

/// Empty if none of them has a gain.
std::optional<Replaced> replaced(const Loop& loop, std::size_t count, Gains (*gains_of)(const Element&)) {
  const Index n = loop.states(), ne = std::ssize(loop.elements);
  MatrixXd C = MatrixXd::Zero(ne, n), C_delayed = MatrixXd::Zero(ne, n), D = MatrixXd::Zero(ne, ne),
           c = MatrixXd::Zero(ne, 4);
  MatrixXd stay = MatrixXd::Identity(ne, ne);
  bool any = false;
  for (std::size_t k = 0; k < count; ++k) {
    const Port& port = loop.ports[k];
    const auto i = static_cast<Index>(k);
    const auto [gain, rate_gain] = gains_of(loop.elements[k]);
    if (gain == 0.0 && rate_gain == 0.0) continue;
    any = true;
    stay(i, i) = 0.0;
    C.row(i) = gain * port.C + rate_gain * port.C_v;
    if (port.C_delayed.size() > 0) C_delayed.row(i) = gain * port.C_delayed;
    D.row(i) = gain * port.D + rate_gain * port.D_v;
    c.row(i) = gain * port.c + rate_gain * port.c_v;
  }
  if (!any) return std::nullopt;
  const MatrixXd closed = MatrixXd::Identity(ne, ne) - D;
  return Replaced{solve_columns_fully_pivoted(closed, C), solve_columns_fully_pivoted(closed, C_delayed),
                  solve_columns_fully_pivoted(closed, c), solve_columns_fully_pivoted(closed, stay)};
}

Gains own_gains(const Element& element) { return element.working_gain(); }

}  // namespace

Loop with_gains(Loop loop, std::size_t count, Gains (*gains_of)(const Element&)) {
  const auto gains = replaced(loop, count, gains_of);
  if (!gains) return loop;
  const bool delayed = loop.A_delayed.size() > 0;
  loop.A += loop.B * gains->from_states;
  loop.E += loop.B * gains->from_external;
  if (delayed) loop.A_delayed += loop.B * gains->from_delayed;
  loop.B *= gains->outputs;
  for (Port& port : loop.ports) {
    port.C += port.D * gains->from_states;
    port.C_v += port.D_v * gains->from_states;
    port.c += port.D * gains->from_external;
    port.c_v += port.D_v * gains->from_external;
    if (delayed && port.C_delayed.size() > 0) port.C_delayed += port.D * gains->from_delayed;
    port.D *= gains->outputs;
    port.D_v *= gains->outputs;
  }
  return loop;
}

double command_limit(const Element& element) {
  const bool limits = element.as<Saturation<double>>() != nullptr || element.as<ClampedPi<double>>() != nullptr;
  return limits ? element.scales().output : 0.0;
}

Gains within_limit(const Element& element) {
  return command_limit(element) > 0.0 ? element.working_gain() : Gains{0.0, 0.0};
}

MatrixXd working_loop(const Loop& loop) {
  const auto gains = replaced(loop, loop.elements.size(), own_gains);
  if (!gains) return loop.A + loop.A_delayed;
  return loop.A + loop.A_delayed + loop.B * (gains->from_states + gains->from_delayed);
}

std::optional<double> integral_gain(const Element& element) {
  if (const auto* pi = element.as<ClampedPi<double>>()) return pi->ki;
  if (const auto* integral = element.as<ResetIntegrator<double>>()) return integral->gain;
  if (const auto* integral = element.as<StopResetIntegrator<double>>()) return integral->gain;
  return std::nullopt;
}

bool resets_integral(const Element& element) {
  return element.as<ResetIntegrator<double>>() != nullptr || element.as<StopResetIntegrator<double>>() != nullptr;
}

}  // namespace limcycle
