#include "limcycle/analysis/frequency/kernels/linear_period.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/lanes/elimination.hpp"

namespace limcycle {

std::optional<LinearPeriod> LinearPeriod::of(const Element& element) {
  if (const auto* lugre = element.as<LuGre<double>>()) return LinearPeriod(Law(*lugre));
  if (const auto* dahl = element.as<Dahl<double>>(); dahl != nullptr && dahl->is_linear_in_state())
    return LinearPeriod(Law(*dahl));
  return std::nullopt;
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

std::optional<PeriodicState> LinearPeriod::find(const PrescribedMotion& motion, const PeriodMesh& mesh, int stages,
                                                bool half, HarmonicSums& sums) {
  const RadauIIA& table = radau_iia(stages);
  nodes_.clear();
  place(motion, mesh.first, table);
  if (!half) place(motion, mesh.second, table);
  std::visit(
      [&](const auto& law) {
        for (Node& node : nodes_) {
          node.rate = law.linear_rate(node.motion.in);
          node.output = law.linear_output(node.motion.in);
        }
      },
      law_);
  march(table, motion.frequency());
  const Node& last = nodes_.back();
  const double lost = half ? 1.0 + last.homogeneous : 1.0 - last.homogeneous;
  if (lost < 1e-12) return std::nullopt;
  const double start = (half ? -last.particular : last.particular) / lost;
  double peak = std::abs(start);
  for (const Node& node : nodes_) {
    const double z = node.particular + start * node.homogeneous, rate = node.rate.source - node.rate.decay * z;
    peak = std::max(peak, std::abs(z));
    sums.node(node.motion, node.weight, node.output.stiffness * z + node.output.damping * rate + node.output.rest);
  }
  const double own = std::visit([](const auto& law) { return law.state_scale(0); }, law_);
  PeriodicState found;
  found.status = std::isfinite(peak) ? Status::converged : Status::not_finite;
  found.state.z = {start};
  found.state.sensitivity = {last.homogeneous};
  found.symmetric = half;
  found.defect = 1e-15 * std::max(1.0, 1.0 / lost);
  found.scale = {peak > 0.0 ? std::min(own, peak) : own};
  return found;
}

}  // namespace limcycle
