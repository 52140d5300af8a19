#include "limcycle/analysis/motion/lane_march/lane_loop.hpp"

#include <array>
#include <cstddef>

#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {
namespace {

using Eigen::Index;

bool is_usual(const LuGre<double>& law) {
  return law.curve.index == 0 && law.delta == 2.0 && law.symmetric() && law.has_constant_damping();
}

std::array<double, 10> law_numbers(const Element& element) {
  if (const auto* dahl = element.as<Dahl<double>>()) return {dahl->Fc, dahl->sigma0};
  const auto& law = law_of<LuGre<double>>(element);
  return {law.Fs,
          law.Fc,
          law.Fs_minus,
          law.Fc_minus,
          law.sigma0 * law.vs,
          law.sigma1 * law.vs,
          law.sigma2 * law.vs,
          law.vd / law.vs,
          law.delta};
}

}  // namespace

std::optional<LaneShape> lane_shape(const Loop& loop) {
  const auto n = static_cast<int>(loop.states());
  if (n < LaneKernels::fewest_states || n > LaneKernels::most_states) return std::nullopt;
  if (loop.delay > 0.0 || loop.elements.size() != 1) return std::nullopt;
  if (loop.ports.front().selection_of || !loop.ports.front().D_v.isZero(0.0)) return std::nullopt;
  if (const auto* lugre = loop.elements.front().as<LuGre<double>>()) {
    if (is_usual(*lugre)) return LaneShape{LaneShape::Law::usual_lugre, n};
    return LaneShape{LaneShape::Law::lugre, n, lugre->curve.index, lugre->delta, !lugre->has_constant_damping()};
  }
  if (const auto* dahl = loop.elements.front().as<Dahl<double>>(); dahl && dahl->is_linear_in_state())
    return LaneShape{LaneShape::Law::dahl, n};
  return std::nullopt;
}

LaneKernel kernel_for(const LaneKernels& kernels, const LaneShape& shape) {
  switch (shape.law) {
    case LaneShape::Law::usual_lugre:
      return kernels.usual_lugre[shape.states];
    case LaneShape::Law::lugre:
      return kernels.lugre[shape.states];
    default:
      return kernels.dahl[shape.states];
  }
}

double lane_unit(const Loop& loop) {
  const auto* lugre = loop.elements.front().as<LuGre<double>>();
  return lugre ? lugre->vs : 1.0;
}

void write_lane(const Loop& loop, const ErrorWeights& weights, const State& start, double* rows, int lanes) {
  const Index n = loop.states();
  const LaneRows at{static_cast<int>(n)};
  const double unit = lane_unit(loop);
  const std::ptrdiff_t stride = lanes;
  const auto put = [&](int row, double value) { rows[row * stride] = value; };
  for (int row = 0; row < at.count(); ++row) put(row, 0.0);
  const Eigen::VectorXd outside = loop.E * loop.external;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) put(at.A(i, j), loop.A(i, j));
    put(at.B() + i, loop.B(i, 0));
    put(at.C_v() + i, loop.ports.front().C_v(i) / unit);
    put(at.C_y() + i, loop.C_y(i));
    put(at.outside() + i, outside(i));
  }
  for (int i = 0; i <= n; ++i) {
    const double scale = i < n ? 1.0 : 1.0 / unit;
    put(at.atol() + i, weights.atol[static_cast<std::size_t>(i)] * scale);
    put(at.state() + i, start[static_cast<std::size_t>(i)] * scale);
  }
  put(LaneRows::rtol, weights.rtol);
  put(LaneRows::speed_outside, loop.ports.front().c_v.dot(loop.external) / unit);
  int row = LaneRows::law;
  for (const double number : law_numbers(loop.elements.front())) put(row++, number);
}

void read_lane(const Loop& loop, const double* rows, int lanes, int row, State& out) {
  const auto n = static_cast<std::size_t>(loop.states());
  out.resize(n + 1);
  const std::ptrdiff_t stride = lanes;
  for (std::size_t i = 0; i <= n; ++i) out[i] = rows[(row + static_cast<int>(i)) * stride];
  out[n] *= lane_unit(loop);
}

}  // namespace limcycle
