#include "limcycle/analysis/energy/passivity/bounds.hpp"
#include "limcycle/analysis/golden_maximum.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "limcycle/analysis/energy/one_state/one_state_law.hpp"
#include "limcycle/analysis/energy/passivity/reference_march.hpp"

namespace limcycle {
namespace {

/// The largest |F| over the reachable states and the velocities.
class LargestForce {
 public:
  explicit LargestForce(const OneStateLaw& law) : law_(law) {}

  ForceBound run() {
    const double scale = law_.law().state_scale(0);
    const double low = std::max(law_.low(), -1e6 * scale), high = std::min(law_.high(), 1e6 * scale);
    constexpr int count = 96;
    for (int k = 0; k <= count; ++k) scan(low + (high - low) * k / count);
    for (int round = 0; round < 3; ++round) refine(low, high, (high - low) / count);
    best_.up_to_speed = law_.top_speed();
    best_.kind = BoundKind::exact;
    if (!std::isfinite(law_.low()) || !std::isfinite(law_.high()) || grows()) best_.value = infinite;
    return best_;
  }

 private:
  double force(double z, double v) const {
    const OneStatePoint point = law_.at(z, v);
    return point.exists ? std::abs(point.force) : 0.0;
  }
  void offer(double z, double v) {
    const double value = force(z, v);
    if (value > best_.value) best_.value = value, best_.z = z, best_.v = v;
  }
  void scan(double z) {
    for (const double speed : law_.speeds())
      for (const double v : {speed, -speed}) offer(z, v);
  }
  void refine(double low, double high, double step) {
    const double a = std::max(low, best_.z - step), b = std::min(high, best_.z + step);
    offer(golden_maximum([&](double z) { return force(z, best_.v); }, a, best_.z, b, 60), best_.v);
    const auto& speeds = law_.speeds();
    const double speed = std::abs(best_.v), side = std::copysign(1.0, best_.v);
    const auto above = std::ranges::upper_bound(speeds, speed);
    const auto below = std::ranges::lower_bound(speeds, speed);
    const double from = below == speeds.begin() ? speed : *std::prev(below);
    const double to = above == speeds.end() ? speed : *above;
    const auto at_speed = [&](double log_speed) { return force(best_.z, side * std::exp(log_speed)); };
    offer(best_.z, side * std::exp(golden_maximum(at_speed, std::log(from), std::log(speed), std::log(to), 60)));
  }
  /// Without a limit of the speed: true if the force still rises beyond the last speed evaluated.
  bool grows() const {
    if (std::isfinite(law_.top_speed()) || law_.rate_independent()) return false;
    return force(best_.z, 10.0 * best_.v) > 1.5 * best_.value && std::abs(best_.v) >= law_.speeds().back();
  }

  const OneStateLaw& law_;
  ForceBound best_;
};

/// Speeds and displacements of the inputs of a search.
class Inputs {
 public:
  Inputs(const Element& law, const BoundsOptions& options) : random_(options.seed) {
    const Scales scales = law.scales();
    // A law without a size of its own is the same at any size.
    const bool has_way = std::isfinite(scales.displacement), has_velocity = std::isfinite(scales.velocity);
    way_ = has_way ? scales.displacement : has_velocity ? 1e-3 * scales.velocity : 1e-6;
    const double velocity = has_velocity ? scales.velocity : 10.0 * way_;
    top_ = std::min(options.top_speed, 1e3 * velocity);
    slow_ = std::min(1e-2 * velocity, top_);
  }

  VelocityCycle next(long number) {
    VelocityCycle input;
    const double sense = number % 2 == 0 ? 1.0 : -1.0;
    if (number % 3 == 0) {  // load slowly, then jump to the top speed, the same way or back
      const double back = number % 6 < 3 ? 1.0 : -1.0;
      add(input, sense * slow_, 40.0 * way_);
      add(input, sense * back * top_, between(0.1, 30.0) * way_);
      add(input, -sense * slow_, between(0.1, 30.0) * way_);
    } else {
      const int pieces = 3 + static_cast<int>(number % 5);
      for (int k = 0; k < pieces; ++k) {
        const double side = std::uniform_real_distribution<>(-1.0, 1.0)(random_);
        add(input, std::copysign(between(slow_, top_), side), between(0.01, 30.0) * way_);
      }
    }
    return input;
  }

 private:
  double between(double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<>(0.0, 1.0)(random_));
  }
  static void add(VelocityCycle& input, double v, double way) {
    const double from = input.time.empty() ? 0.0 : input.period();
    for (const double t : {from, from + way / std::abs(v)}) {
      input.time.push_back(t);
      input.velocity.push_back(v);
    }
  }

  std::mt19937_64 random_;
  double way_ = 0.0, slow_ = 0.0, top_ = 0.0;
};

Bounds one_state_bounds(const Element& law, double top_speed) {
  const OneStateLaw one(law, top_speed);
  Bounds result;
  result.states = {{one.low(), one.high(), BoundKind::exact}};
  result.force = LargestForce(one).run();
  return result;
}

}  // namespace

std::string_view to_string(BoundKind kind) {
  return kind == BoundKind::exact ? "exact" : kind == BoundKind::analytic ? "analytic" : "searched";
}

WorstSeen worst_seen(const Element& law, const BoundsOptions& options) {
  WorstSeen seen;
  seen.low.assign(static_cast<std::size_t>(law.states()), infinite);
  seen.high.assign(static_cast<std::size_t>(law.states()), -infinite);
  ReferenceMarchOptions run;
  run.tolerance = 1e-9;
  run.max_steps = 20'000;
  run.stop = options.stop;
  run.watch = [&](const Input<double>& in, Mode mode, std::span<const double> z) {
    for (std::size_t i = 0; i < z.size(); ++i) {
      seen.low[i] = std::min(seen.low[i], z[i]);
      seen.high[i] = std::max(seen.high[i], z[i]);
    }
    seen.force = std::max(seen.force, std::abs(law.output({0.0, in.v, in.drive}, mode, z)));
  };
  Inputs inputs(law, options);
  for (; seen.inputs < options.inputs && !(options.stop && options.stop()); ++seen.inputs)
    if (reference_march_virgin(law, inputs.next(seen.inputs), 2, run).status != Status::converged) ++seen.unfinished;
  return seen;
}

Bounds bounds(const Element& element, const BoundsOptions& options) {
  if (!element.is_friction()) throw std::invalid_argument("bounds are of a friction law");
  if (!(options.top_speed > 0.0))
    throw std::invalid_argument("a top speed must be positive, not " + std::to_string(options.top_speed));
  Bounds result;
  if (OneStateLaw::fits(element)) {
    result = one_state_bounds(element, options.top_speed);
  } else {
    // Bounds that follow from the equations of the law.
    for (const auto& [low, high] : element.state_bounds()) result.states.push_back({low, high, BoundKind::analytic});
    if (const auto force = element.force_bound(options.top_speed))
      result.force = {*force, options.top_speed, BoundKind::analytic};
  }
  result.seen = worst_seen(element, options);
  if (options.stop && options.stop()) result.status = Status::interrupted;
  if (result.states.empty() && options.inputs > 0)
    for (std::size_t i = 0; i < result.seen.low.size(); ++i)
      result.states.push_back({result.seen.low[i], result.seen.high[i], BoundKind::searched});
  return result;
}

}  // namespace limcycle
