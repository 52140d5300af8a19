#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {
namespace {

Loop mass_with(const Element& law, double mass) {
  Mass plant;
  plant.mass = mass;
  LoopParts parts;
  parts.plant = plant;
  parts.friction = law;
  return build_loop(parts);
}

/// A body that is not affected by the law that rubs on it.
Loop moved_law(const Element& law) {
  StateSpacePlant plant;
  plant.A = Eigen::Matrix2d{{0.0, 1.0}, {0.0, 0.0}};
  plant.B = Eigen::Vector2d(0.0, 1.0);
  plant.C = Eigen::RowVector2d(1.0, 0.0);
  plant.B_friction = Eigen::Vector2d::Zero();
  LoopParts parts;
  parts.plant = plant;
  parts.friction = law;
  return build_loop(parts);
}

class Recorder {
 public:
  Recorder(LoopField& field, const Signal& force, ForcedRun& run) : field_(field), force_(force), run_(run) {}

  void add(const State& x, double t) {
    field_.rate(x, dx_, t);
    run_.t.push_back(t);
    run_.x.push_back(field_.input(0).x);
    run_.v.push_back(field_.input(0).v);
    run_.F.push_back(field_.output(0));
    run_.u.push_back(force_.at(t));
  }

 private:
  LoopField& field_;
  const Signal& force_;
  ForcedRun& run_;
  State dx_;
};

}  // namespace

namespace {

ForcedRun run_driven(const Loop& loop, bool stateless, StepperKind stepper, const Signal& force,
                     const ForcedOptions& options) {
  LoopField field(loop);
  double next_break = infinite;
  field.set_external([&](double time, External& value, External& rate) {
    // Up to a break the signal is continued smoothly, so that the step that ends there has no kink.
    const double t = std::min(time, std::nextafter(next_break, 0.0));
    value = loop.external;
    rate.setZero();
    value(external_force) += force.at(t) + (time - t) * force.slope(t);
    rate(external_force) = force.slope(t);
  });
  std::vector<std::pair<double, bool>> ends;  // of steps; true: the signal has a kink there
  for (const double t : force.breaks(options.duration)) ends.emplace_back(t, true);
  for (const double t : options.samples)
    if (t < options.duration) ends.emplace_back(t, false);
  ends.emplace_back(options.duration, false);
  std::ranges::sort(ends);
  const auto break_after = [&](double t) {
    const auto next = std::ranges::find_if(ends, [t](const auto& end) { return end.second && end.first > t; });
    return next == ends.end() ? infinite : next->first;
  };
  ForcedRun run;
  Recorder record(field, force, run);
  State x(field.size(), 0.0);
  next_break = break_after(0.0);
  field.start(x, 0.0);
  March march(field, stepper, loop_weights(loop, options.rtol));
  march.limit_step(options.longest_step);
  march.begin(x, 0.0);
  record.add(x, 0.0);
  for (const auto& [end, bends] : ends) {
    while (march.t() < end) {
      if (options.stop && options.stop()) run.status = Status::interrupted;
      const auto modes = field.modes();
      if (run.status == Status::converged) run.status = march.step(end);
      run.steps = march.steps();
      if (run.status != Status::converged) return run;
      if (stateless && march.last().switched && march.last().t1 == march.t()) {
        // The force just before the switch, which may jump there for a law without a state.
        const auto after = std::exchange(field.modes(), modes);
        record.add(march.x(), march.t());
        field.modes() = after;
      }
      record.add(march.x(), march.t());
      if (run.x.back() >= options.until_displacement) return run;
    }
    if (!bends) continue;
    next_break = break_after(end);
    march.begin(march.x(), march.t());
  }
  return run;
}

}  // namespace

ForcedRun run_forced(const Element& law, const Signal& force, const ForcedOptions& options) {
  return run_driven(mass_with(law, options.mass), law.states() == 0, StepperKind::automatic, force, options);
}

ForcedRun run_accelerated(const Element& law, const Signal& acceleration, const ForcedOptions& options,
                          const std::string& stepper) {
  return run_driven(moved_law(law), law.states() == 0, stepper_kind(stepper), acceleration, options);
}

std::size_t ForcedRun::at(double time) const {
  const auto next = std::ranges::upper_bound(t, time);
  return next == t.begin() ? 0 : static_cast<std::size_t>(next - t.begin()) - 1;
}

double ForcedRun::displacement(double time) const {
  const std::size_t i = at(time);
  if (i + 1 >= t.size()) return x[i];
  const double h = t[i + 1] - t[i], s = (time - t[i]) / h;
  return x[i] + s * s * (3.0 - 2.0 * s) * (x[i + 1] - x[i]) + h * s * (1.0 - s) * ((1.0 - s) * v[i] - s * v[i + 1]);
}

double ForcedRun::time_of(double position) const {
  std::size_t i = 0;
  while (i < x.size() && x[i] < position) ++i;
  if (i == 0 || i >= x.size()) return NAN;
  double low = t[i - 1], high = t[i];
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (displacement(middle) < position ? low : high) = middle;
  }
  return high;
}

double ForcedRun::mean_displacement(double from, double to) const {
  double sum = 0.0, weights = 0.0;
  const double pi = 3.14159265358979;
  const auto weight = [&](double time) { return 1.0 - std::cos(2.0 * pi * (time - from) / (to - from)); };
  const double origin = displacement(from);
  double before = from, x_before = 0.0;
  for (std::size_t i = at(from) + 1; i < t.size() && before < to; ++i) {
    const double now = std::min(t[i], to), x_now = displacement(now) - origin, dt = now - before;
    if (!(dt > 0.0)) continue;
    const double middle = 0.5 * (before + now), x_middle = displacement(middle) - origin;
    sum += dt / 6.0 * (weight(before) * x_before + 4.0 * weight(middle) * x_middle + weight(now) * x_now);
    weights += dt / 6.0 * (weight(before) + 4.0 * weight(middle) + weight(now));
    before = now;
    x_before = x_now;
  }
  return origin + sum / weights;
}

Signal signal_through(std::vector<double> times, std::vector<double> values) {
  Signal signal;
  signal.kind = Signal::Kind::table;
  signal.times = std::move(times);
  signal.values = std::move(values);
  return signal;
}

namespace {

/// Slope at sample i of the parabola through it and its neighbours, and its second derivative.
struct Parabola {
  double slope = 0.0, second = 0.0;
};
Parabola parabola(const std::vector<double>& t, const std::vector<double>& y, std::size_t i) {
  const double a = t[i] - t[i - 1], b = t[i + 1] - t[i];
  if (!(a > 0.0 && b > 0.0)) return {NAN, NAN};
  const double left = (y[i] - y[i - 1]) / a, right = (y[i + 1] - y[i]) / b;
  return {(left * b + right * a) / (a + b), 2.0 * (right - left) / (a + b)};
}

}  // namespace

Peak peak_of(const std::vector<double>& t, const std::vector<double>& values, std::size_t end) {
  const auto last = values.begin() + static_cast<std::ptrdiff_t>(std::min(end + 1, values.size()));
  const auto i = static_cast<std::size_t>(std::max_element(values.begin(), last) - values.begin());
  Peak peak{i, values[i]};
  if (i < 2 || i + 2 >= values.size() || i >= end) return peak;
  // A corner is not a parabola, and its own sample is the peak: its curvature differs from that of its neighbours.
  const Parabola here = parabola(t, values, i), before = parabola(t, values, i - 1), after = parabola(t, values, i + 1);
  if (here.second < 0.0 && here.second > 4.0 * before.second && here.second > 4.0 * after.second)
    peak.value -= here.slope * here.slope / (2.0 * here.second);
  return peak;
}

double area(const std::vector<double>& x, const std::vector<double>& y, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t i = from + 1; i <= to && i < x.size(); ++i) sum += 0.5 * (y[i] + y[i - 1]) * (x[i] - x[i - 1]);
  return sum;
}

}  // namespace limcycle
