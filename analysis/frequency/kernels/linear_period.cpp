#include "limcycle/analysis/frequency/kernels/linear_period.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>

namespace limcycle {

std::optional<LinearPeriod> LinearPeriod::of(const Element& element) {
  if (const auto* lugre = element.as<LuGre<double>>()) return LinearPeriod(Law(*lugre));
  if (const auto* dahl = element.as<Dahl<double>>()) {
    if (dahl->is_linear_in_state()) return LinearPeriod(Law(*dahl));
    return std::nullopt;
  }
  if (element.states() != 1 || element.has_modes() || element.follows_position()) return std::nullopt;
  return LinearPeriod(Law(Supposed(element)));
}

double LinearPeriod::Supposed::rate(const Input<double>& in, double z) const {
  double dz = 0.0;
  element_.rate(in, Mode{}, {&z, 1}, {&dz, 1});
  return dz;
}

LinearRate<double> LinearPeriod::Supposed::linear_rate(const Input<double>& in) const {
  const double source = rate(in, 0.0);
  return {source, (source - rate(in, scale_)) / scale_};
}

bool LinearPeriod::Supposed::agrees(const Input<double>& in, const LinearRate<double>& linear, double z) const {
  constexpr double rounding = 1e-12;
  const double slowed = linear.decay * z;
  return std::abs(rate(in, z) - (linear.source - slowed)) <= rounding * (std::abs(linear.source) + std::abs(slowed));
}

void LinearPeriod::place(const PrescribedMotion& motion, const std::vector<Panel>& panels, const RadauIIA& table) {
  const auto s = static_cast<std::size_t>(table.stages);
  for (const Panel& panel : panels) {
    const double width = panel.to - panel.from;
    for (std::size_t i = 0; i < s; ++i) {
      Node& node = nodes_.emplace_back();
      node.motion = motion.at(panel.anchor, i + 1 == s ? panel.to : panel.from + table.c[i] * width);
      node.weight = table.b[i] * width;
      node.width = width;
    }
  }
}

void LinearPeriod::march(const RadauIIA& table, double frequency) {
  with_stages(table.stages, [&]<int S> {
    LinearPair pair;
    for (std::size_t first = 0; first < nodes_.size(); first += S)
      pair = solve_linear_panel<S>(
          table, nodes_[first].width / frequency, pair, [&](std::size_t i) { return nodes_[first + i].rate; },
          [&](std::size_t i, const LinearPair& here) { nodes_[first + i].pair = here; });
  });
}

/// The output of the motion that begins in the state `start`, into `sums`; its largest state. Empty if the rate is not
/// linear there.
std::optional<double> LinearPeriod::integrate(double start, HarmonicSums& sums) const {
  return std::visit(
      [&]<class L>(const L& law) -> std::optional<double> {
        double peak = std::abs(start);
        for (const Node& node : nodes_) {
          const Input<double>& in = node.motion.in;
          const double z = node.pair.from(start);
          peak = std::max(peak, std::abs(z));
          if constexpr (std::same_as<L, Supposed>) {
            if (!law.agrees(in, node.rate, z)) return std::nullopt;
            sums.node(node.motion, node.weight, law.output(in, z));
          } else {
            const LinearOutput<double> output = law.linear_output(in);
            const double rate = node.rate.source - node.rate.decay * z;
            sums.node(node.motion, node.weight, output.stiffness * z + output.damping * rate + output.rest);
          }
        }
        return peak;
      },
      law_);
}

std::optional<PeriodicState> LinearPeriod::find(const PrescribedMotion& motion, const PeriodMesh& mesh, int stages,
                                                bool half, HarmonicSums& sums) {
  if (!is_linear_) return std::nullopt;
  const RadauIIA& table = radau_iia(stages);
  nodes_.clear();
  place(motion, mesh.first, table);
  if (!half) place(motion, mesh.second, table);
  std::visit(
      [&](const auto& law) {
        for (Node& node : nodes_) node.rate = law.linear_rate(node.motion.in);
      },
      law_);
  march(table, motion.frequency());
  const Node& last = nodes_.back();
  const double lost = half ? 1.0 + last.pair.homogeneous : 1.0 - last.pair.homogeneous;
  if (lost < 1e-12) return std::nullopt;
  const double start = (half ? -last.pair.particular : last.pair.particular) / lost;
  const auto peak = integrate(start, sums);
  is_linear_ = peak.has_value();
  if (!peak) return std::nullopt;
  const double own = std::visit([](const auto& law) { return law.state_scale(0); }, law_);
  PeriodicState found;
  found.status = std::isfinite(*peak) ? Status::converged : Status::not_finite;
  found.state.z = {start};
  found.state.sensitivity = {last.pair.homogeneous};
  found.symmetric = half;
  found.defect = 1e-15 * std::max(1.0, 1.0 / lost);
  found.scale = {*peak > 0.0 ? std::min(own, *peak) : own};
  return found;
}

}  // namespace limcycle
