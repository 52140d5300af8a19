#include "limcycle/analysis/orbit/measure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {
namespace {

/// Cubic through values and slopes (times h) at 0 and 1.
struct Cubic01 {
  double y0, y1, s0, s1;
  double at(double u) const {
    const double left = 1.0 - u;
    return left * y0 + u * y1 - u * left * ((1.0 - 2.0 * u) * (y1 - y0) + u * s1 - left * s0);
  }
  /// Coefficients of the derivative s0 + b u + c u^2.
  double b() const { return 6.0 * (y1 - y0) - 4.0 * s0 - 2.0 * s1; }
  double c() const { return 3.0 * (s0 + s1) - 6.0 * (y1 - y0); }
};

Cubic01 piece(const std::vector<double>& t, const std::vector<double>& y, const std::vector<double>& rate,
              std::size_t i) {
  const double h = t[i + 1] - t[i];
  return {y[i], y[i + 1], h * rate[i], h * rate[i + 1]};
}

/// The element that a user looks at: the friction if there is one, else the last in the loop.
std::size_t element_of_interest(const Loop& loop) { return loop.elements.size() - 1; }

/// |v| below which a body counts as sticking: vs/100, or rest to rounding for laws without a Stribeck velocity.
double sticking_speed(const Loop& loop, const Trace& trace) {
  if (!loop.ports[element_of_interest(loop)].rubs) return -1.0;
  const Scales scales = std::visit([](const auto& e) { return e.scales(); }, loop.elements[element_of_interest(loop)]);
  if (std::isfinite(scales.velocity)) return scales.velocity / 100.0;
  double fastest = 0.0;
  for (const double v : trace.velocity) fastest = std::max(fastest, std::abs(v));
  return 1e-10 * fastest;
}

double sticking_time(const Trace& trace, double limit) {
  double stuck = 0.0;
  for (std::size_t i = 0; i + 1 < trace.t.size(); ++i) {
    const double h = trace.t[i + 1] - trace.t[i];
    const double v0 = std::abs(trace.velocity[i]), v1 = std::abs(trace.velocity[i + 1]);
    if (v0 <= limit && v1 <= limit) {
      stuck += h;
    } else if (limit > 0.0 && (v0 <= limit) != (v1 <= limit)) {
      const double share = (limit - v0) / (v1 - v0);  // steps are short where v changes
      stuck += h * (v0 <= limit ? share : 1.0 - share);
    }
  }
  return stuck;
}

/// Harmonics 0..H of a periodic signal given with its rate, as in input_harmonics().
Eigen::VectorXcd harmonics(const std::vector<double>& t, const std::vector<double>& y, const std::vector<double>& rate,
                           double period, int H) {
  const double w = 2.0 * std::numbers::pi / period;
  // Gauss-Legendre, 4 points a step: exact for the cubic, and the steps are short against the period.
  constexpr std::array<double, 4> node{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                       0.93056815579702629};
  constexpr std::array<double, 4> weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                         0.17392742256872693};
  Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(H + 1);
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const Cubic01 cubic = piece(t, y, rate, i);
    const double h = t[i + 1] - t[i];
    for (std::size_t k = 0; k < node.size(); ++k) {
      const double part = cubic.at(node[k]) * h * weight[k], angle = w * (t[i] + node[k] * h);
      for (int n = 0; n <= H; ++n) sum(n) += part * std::complex<double>(std::sin(n * angle), std::cos(n * angle));
    }
  }
  sum *= 2.0 / period;
  sum(0) *= 0.5;
  return sum;
}

}  // namespace

Eigen::VectorXcd input_harmonics(const Cycle& cycle, int H) {
  const Trace& trace = cycle.trace;
  // The rate of the input: a rubbing velocity may differ from it by a constant, and the input is periodic.
  const double drift =
      harmonics(trace.t, trace.velocity, std::vector<double>(trace.t.size(), 0.0), cycle.period, 0)(0).imag();
  std::vector<double> rate = trace.velocity;
  for (double& v : rate) v -= drift;
  return harmonics(trace.t, trace.input, rate, cycle.period, H);
}

void append(Trace& trace, LoopField& field, const State& x, const State& dx, double t) {
  const std::size_t i = element_of_interest(field.loop());
  trace.t.push_back(t);
  trace.y.push_back(field.y(x));
  trace.rate.push_back(field.y_rate(dx));
  trace.input.push_back(field.input(i).x);
  trace.velocity.push_back(field.input(i).v);
  trace.output.push_back(field.output(i));
}

Status record(const Loop& loop, const LoopState& from, double duration, double rtol, int resolution, Trace& trace) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, rtol));
  march.begin(from.x, 0.0);
  march.limit_step(duration / resolution);
  State dx;
  field.rate(from.x, dx, 0.0);
  append(trace, field, from.x, dx, 0.0);
  while (march.t() < duration) {
    const Status status = march.step(duration);
    if (status != Status::converged) return status;
    if (march.last().switched)
      append(trace, field, march.last().x1, march.last().dx1, march.t());  // rates may jump here
    field.rate(march.x(), dx, march.t());
    append(trace, field, march.x(), dx, march.t());
    if (march.steps() > 2000000) return Status::max_iterations;
  }
  return Status::converged;
}

Extremes extremes(const Trace& trace) {
  Extremes found{trace.y.front(), trace.y.front()};
  const auto include = [&](double y) {
    found.low = std::min(found.low, y);
    found.high = std::max(found.high, y);
  };
  for (const double y : trace.y) include(y);
  for (std::size_t i = 0; i + 1 < trace.t.size(); ++i) {
    const Cubic01 cubic = piece(trace.t, trace.y, trace.rate, i);
    if (cubic.s0 * cubic.s1 >= 0.0) continue;
    const double b = cubic.b(), c = cubic.c();
    const double root = std::sqrt(std::max(0.0, b * b - 4.0 * c * cubic.s0));
    const double q = -0.5 * (b + (b < 0.0 ? -root : root));
    for (const double u : {q / c, cubic.s0 / q})
      if (u > 0.0 && u < 1.0) include(cubic.at(u));
  }
  return found;
}

void measure(const Loop& loop, Cycle& cycle) {
  const Trace& trace = cycle.trace;
  const auto [low, high] = extremes(trace);
  cycle.amplitude = 0.5 * (high - low);
  const Eigen::VectorXcd y = harmonics(trace.t, trace.y, trace.rate, cycle.period, 1);
  cycle.offset = y(0).imag();
  cycle.first_harmonic = std::abs(y(1));
  cycle.sticking_fraction = std::clamp(sticking_time(trace, sticking_speed(loop, trace)) / cycle.period, 0.0, 1.0);
}

}  // namespace limcycle
