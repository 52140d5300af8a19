#include "limcycle/analysis/orbit/cycle/measure.hpp"

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
  /// Zero of the derivative, if it has opposite signs at the ends.
  double turn() const {
    const double root = std::sqrt(std::max(0.0, b() * b() - 4.0 * c() * s0));
    const double q = -0.5 * (b() + (b() < 0.0 ? -root : root));
    const double one = q / c(), other = s0 / q;
    return std::clamp(one > 0.0 && one < 1.0 ? one : other, 0.0, 1.0);
  }
};

Cubic01 piece(const std::vector<double>& t, const std::vector<double>& y, const std::vector<double>& rate,
              std::size_t i) {
  const double h = t[i + 1] - t[i];
  return {y[i], y[i + 1], h * rate[i], h * rate[i + 1]};
}

/// The element of interest: the friction if there is one, else the last in the loop.
std::size_t element_of_interest(const Loop& loop) { return loop.elements.size() - 1; }

/// |v| below which a body counts as sticking: vs/100, or rest to rounding for laws without a Stribeck velocity.
double sticking_speed(const Loop& loop, const Trace& trace) {
  if (!loop.ports[element_of_interest(loop)].rubs) return -1.0;
  const Scales scales = loop.elements[element_of_interest(loop)].scales();
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

/// True if the rubbing displacement is no combination of the states. It is then the sum of the trapezia under the
/// velocity.
bool rubs_along_no_state(const Port& port) { return port.rubs && port.C.isZero(0.0); }

/// Harmonics 0..H of a periodic signal given with its rate, as in input_harmonics().
Eigen::VectorXcd harmonics(const std::vector<double>& t, const std::vector<double>& y, const std::vector<double>& rate,
                           double period, int H) {
  const double w = 2.0 * std::numbers::pi / period;
  // Gauss-Legendre, 4 points a step: exact for the cubic. A step that is long for the highest harmonic is divided.
  constexpr std::array<double, 4> node{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                       0.93056815579702629};
  constexpr std::array<double, 4> weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                         0.17392742256872693};
  Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(H + 1);
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const Cubic01 cubic = piece(t, y, rate, i);
    const double h = t[i + 1] - t[i];
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::ceil(h * w * H)));
    for (std::size_t k = 0; k < node.size() * parts; ++k) {
      const std::size_t part = k / node.size(), point = k % node.size();
      const double at = (static_cast<double>(part) + node[point]) / static_cast<double>(parts);
      const double angle = w * (t[i] + at * h), share = h * weight[point] / static_cast<double>(parts);
      const std::complex<double> turn(std::cos(angle), -std::sin(angle));
      std::complex<double> term(0.0, cubic.at(at) * share);  // j e^(-j n angle) = sin + j cos
      sum(0) += term;
      for (int n = 1; n <= H; ++n) sum(n) += term *= turn;
    }
  }
  sum *= 2.0 / period;
  sum(0) *= 0.5;
  return sum;
}

/// Origin of the rubbing displacement in a trace, because a body far from zero moves by micrometres.
double rubbing_origin(const Loop& loop, const Port& port) { return port.rubs ? (port.c * loop.external).value() : 0.0; }

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

Eigen::VectorXcd output_harmonics(const Cycle& cycle, int H) {
  const Trace& trace = cycle.trace;
  return harmonics(trace.t, trace.y, trace.rate, cycle.period, H);
}

void append(Trace& trace, LoopField& field, const State& x, const State& dx, double t) {
  const std::size_t i = element_of_interest(field.loop());
  const Port& port = field.loop().ports[i];
  const double travelled =
      !rubs_along_no_state(port) || trace.t.empty()
          ? 0.0
          : trace.input.back() + 0.5 * (t - trace.t.back()) * (trace.velocity.back() + field.input(i).v);
  trace.t.push_back(t);
  trace.y.push_back(field.y(x));
  trace.y_origin = field.loop().output_origin;
  trace.rate.push_back(field.y_rate(dx));
  trace.input.push_back(field.input(i).x - rubbing_origin(field.loop(), port) + travelled);
  trace.velocity.push_back(field.input(i).v);
  trace.output.push_back(field.output(i));
}

void append(Trace& trace, LoopField& field, const March& march) {
  if (march.last().switched) append(trace, field, march.last().x1, march.last().dx1, march.t());  // rates may jump
  State dx;
  field.rate(march.x(), dx, march.t());
  append(trace, field, march.x(), dx, march.t());
}

Status record(const Loop& loop, const LoopState& from, double duration, double rtol, int resolution, Trace& trace) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, rtol));
  march.begin(from.x, 0.0);
  march.limit_step(duration / resolution);
  append(trace, field, march);
  while (march.t() < duration) {
    const Status status = march.step(duration);
    if (status != Status::converged) return status;
    append(trace, field, march);
    if (march.steps() > 2000000) return Status::max_iterations;
  }
  return Status::converged;
}

void append_reflected(const Loop& loop, const Eigen::VectorXd& centre, Trace& trace) {
  const Port& port = loop.ports[element_of_interest(loop)];
  const double y_middle = loop.C_y.dot(centre.transpose());
  const double input_middle = rubs_along_no_state(port)
                                  ? 0.5 * (trace.input.front() + trace.input.back())
                                  : (port.C * centre + port.c * loop.external).value() - rubbing_origin(loop, port);
  const double half = trace.t.back();
  const std::size_t count = trace.t.size();
  for (std::size_t i = 1; i < count; ++i) {
    trace.t.push_back(half + trace.t[i]);
    trace.y.push_back(2.0 * y_middle - trace.y[i]);
    trace.rate.push_back(-trace.rate[i]);
    trace.input.push_back(2.0 * input_middle - trace.input[i]);
    trace.velocity.push_back(-trace.velocity[i]);
    trace.output.push_back(-trace.output[i]);
  }
}

void LocatedExtremes::include(double y, double at) {
  if (y < low) {
    low = y;
    low_at = at;
  }
  if (y > high) {
    high = y;
    high_at = at;
  }
}

void LocatedExtremes::include(LoopField& field, March& march, std::size_t index) {
  const Step& step = march.last();
  const double h = step.t1 - step.t0;
  const auto at = static_cast<double>(index);
  const Cubic01 cubic{field.y(step.x0), field.y(step.x1), h * field.y_rate(step.dx0), h * field.y_rate(step.dx1)};
  include(cubic.y0, at);
  include(cubic.y1, at + 1.0);
  if (cubic.s0 * cubic.s1 >= 0.0) return;
  const double share = cubic.turn();
  double y = cubic.at(share);
  if (!step.switched) {
    State x, dx;
    march.within(share, x);
    field.rate(x, dx, step.t0 + share * h);
    const double rate = h * field.y_rate(dx), bend = cubic.b() + 2.0 * cubic.c() * share;
    const double left = bend != 0.0 ? 0.5 * rate * rate / bend : 0.0;
    y = field.y(x) - (std::abs(left) < std::abs(cubic.y1 - cubic.y0) ? left : 0.0);
  }
  include(y, at + share);
}

Extremes extremes(const Trace& trace) {
  const auto [low, high] = std::ranges::minmax(trace.y);
  Extremes found{low, high};
  for (std::size_t i = 0; i + 1 < trace.t.size(); ++i) {
    const Cubic01 cubic = piece(trace.t, trace.y, trace.rate, i);
    if (cubic.s0 * cubic.s1 >= 0.0) continue;
    const double y = cubic.at(cubic.turn());
    found = {std::min(found.low, y), std::max(found.high, y)};
  }
  return found;
}

void measure(const Loop& loop, Cycle& cycle) {
  const Trace& trace = cycle.trace;
  const auto [low, high] = extremes(trace);
  cycle.amplitude = 0.5 * (high - low);
  const Eigen::VectorXcd y = harmonics(trace.t, trace.y, trace.rate, cycle.period, 1);
  cycle.offset = cycle.trace.y_origin + y(0).imag();
  cycle.first_harmonic = std::abs(y(1));
  cycle.sticking_fraction = std::clamp(sticking_time(trace, sticking_speed(loop, trace)) / cycle.period, 0.0, 1.0);
}

}  // namespace limcycle
