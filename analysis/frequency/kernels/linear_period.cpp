#include "limcycle/analysis/frequency/kernels/linear_period.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <stdexcept>

#include "limcycle/analysis/lanes/elimination.hpp"

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

template <int S>
void LinearPeriod::solve(const RadauIIA& table, double frequency) {
  double particular = 0.0, homogeneous = 1.0;
  for (std::size_t first = 0; first < nodes_.size(); first += S) {
    const double step = nodes_[first].width / frequency;
    double m[S][S], x[S], y[S];
    for (int i = 0; i < S; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const LinearRate<double>& rate = nodes_[first + row].rate;
      for (int j = 0; j < S; ++j) m[i][j] = table.inverse[row * S + static_cast<std::size_t>(j)];
      m[i][i] += rate.decay * step;
      x[i] = rate.source * step + table.row_sum[row] * particular;
      y[i] = table.row_sum[row] * homogeneous;
    }
    eliminate(m, x, y);
    for (int i = 0; i < S; ++i) {
      nodes_[first + static_cast<std::size_t>(i)].particular = x[i];
      nodes_[first + static_cast<std::size_t>(i)].homogeneous = y[i];
    }
    particular = x[S - 1];
    homogeneous = y[S - 1];
  }
}

void LinearPeriod::march(const RadauIIA& table, double frequency) {
  switch (table.stages) {
    case 4:
      return solve<4>(table, frequency);
    case 5:
      return solve<5>(table, frequency);
    case 6:
      return solve<6>(table, frequency);
    case 7:
      return solve<7>(table, frequency);
    case 8:
      return solve<8>(table, frequency);
    case 9:
      return solve<9>(table, frequency);
    case 10:
      return solve<10>(table, frequency);
    default:
      throw std::invalid_argument("period of a linear law: 4 to 10 stages");
  }
}

/// The output of the motion that begins in the state `start`, into `sums`; its largest state. Empty if the rate is not
/// linear there.
std::optional<double> LinearPeriod::integrate(double start, HarmonicSums& sums) const {
  return std::visit(
      [&]<class L>(const L& law) -> std::optional<double> {
        double peak = std::abs(start);
        for (const Node& node : nodes_) {
          const Input<double>& in = node.motion.in;
          const double z = node.particular + start * node.homogeneous;
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
  const double lost = half ? 1.0 + last.homogeneous : 1.0 - last.homogeneous;
  if (lost < 1e-12) return std::nullopt;
  const double start = (half ? -last.particular : last.particular) / lost;
  const auto peak = integrate(start, sums);
  is_linear_ = peak.has_value();
  if (!peak) return std::nullopt;
  const double own = std::visit([](const auto& law) { return law.state_scale(0); }, law_);
  PeriodicState found;
  found.status = std::isfinite(*peak) ? Status::converged : Status::not_finite;
  found.state.z = {start};
  found.state.sensitivity = {last.homogeneous};
  found.symmetric = half;
  found.defect = 1e-15 * std::max(1.0, 1.0 / lost);
  found.scale = {*peak > 0.0 ? std::min(own, *peak) : own};
  return found;
}

}  // namespace limcycle
