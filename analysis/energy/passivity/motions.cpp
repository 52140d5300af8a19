#include "limcycle/analysis/energy/passivity/motions.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace limcycle {
namespace {

/// Time constants (s) of the states at a creeping speed, after slides of several speeds and lengths.
std::vector<double> time_constants(const Element& element, double speed, double way) {
  std::vector<double> found;
  SupplyMarch march(element, 1e-6);
  ElementSlopes slopes(element);
  const double creep = 1e-9 * speed;
  for (const double fast : {1e-2, 1.0, 1e2}) {
    for (const double far : {0.3, 3.0, 30.0}) {
      for (const double direction : {1.0, -1.0}) {
        const double v = direction * fast * speed;
        const SignalPiece slide{far * way / (fast * speed), v, v}, after{1.0, direction * creep, direction * creep};
        ElementPoint at = march.virgin(slide);
        if (march.cross(slide, at) != Status::converged || !march.settle(after, at)) continue;
        const auto& table = slopes.response(march.input(after, 0.0, at.x), at.mode, at.z.data());
        for (Eigen::Index i = 0; i < slopes.states(); ++i) {
          const double rate = std::abs(table(1 + i, 2 + i));
          if (std::isfinite(rate) && rate > 1e3 * creep / way) found.push_back(1.0 / rate);
        }
      }
    }
  }
  return found;
}

/// Sizes at which an element that is not a friction law may change its output: its own parameters.
double largest_parameter(const Element& element, std::string_view unit) {
  double largest = 0.0;
  const auto values = element.values();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const auto* number = std::get_if<double>(&values[i]))
      if (element.parameters()[i].unit == unit && element.parameters()[i].key != "slope")
        largest = std::max(largest, std::abs(*number));
  return largest;
}

Stroke stroke_of(const MotionScales& scales, double signal, double length, bool by_time, bool ramp = false) {
  const double size = std::clamp(std::abs(signal), scales.least, scales.reach);
  return {signal < 0.0 ? -1 : 1, by_time, ramp, std::log10(size), std::log10(length)};
}

/// Signals that go there and back and stay, and squares (for delayed responses).
std::vector<Strokes> strokes_of_inputs(const MotionScales& scales) {
  std::vector<Strokes> all;
  const double a = scales.signal, t = scales.longest;
  const auto to = [&](double share, double time, bool ramp) {
    return stroke_of(scales, share * a, time * t, true, ramp);
  };
  for (const double there : {0.1, 0.3, 0.6, 1.0, 1.5, 2.5, 4.5})
    for (const double back : {-3.0, -1.5, 1.5, 3.0})
      all.push_back({to(back, 0.01, true), to(back, 0.01, false), to(there, 0.01, true), to(there, 10.0, false)});
  for (const double half : {0.3, 1.0, 1.6}) all.push_back({to(3.0, half, false), to(-3.0, half, false)});
  return all;
}

std::vector<Strokes> strokes_of_velocity(const MotionScales& scales) {
  std::vector<Strokes> all;
  const double v = scales.signal, d = scales.way;
  const auto by_way = [&](double speed, double way, bool ramp = false) {
    return stroke_of(scales, speed, way * d, false, ramp);
  };
  const auto creep = [&](double speed) { return stroke_of(scales, speed, 30.0 * scales.longest, true); };
  for (const double far : {2.0, 10.0, 50.0, 250.0})
    for (const double fast : {10.0 * v, 1e3 * v})
      for (const double slow : {1e-3 * v, 1e-6 * v, 1e-9 * v})
        all.push_back({by_way(fast, far), creep(slow), by_way(-fast, far), creep(-slow)});
  // The same with the springs released at the speed of the creep: at any higher one a stretched spring would slip.
  const double fast = 10.0 * v, slow = 1e-3 * v;
  for (const double far : {1.0, 4.0, 16.0})
    for (const double back : {1.0, 4.0})
      all.push_back(
          {by_way(fast, far), creep(slow), by_way(-slow, back), by_way(-fast, far), creep(-slow), by_way(slow, back)});
  for (const double far : {1.0, 5.0, 50.0, 500.0})
    for (const double step : {1.0, 10.0, 1e2, 1e4})
      for (const double way : {0.03, 0.3, 1.0, 10.0})
        all.push_back({by_way(1e-2 * v, far), by_way(std::max(step * scales.damping, 10.0 * step * v), way)});
  all.push_back({by_way(1e-6 * v, 5e3), by_way(100.0 * scales.damping + v, 1.0)});
  for (const double high : {0.3 * v, v, 3.0 * v})
    for (const double low : {1e-2, 1e-1}) all.push_back({by_way(high, 1e-3, true), by_way(low * high, 300.0, true)});
  return all;
}

}  // namespace

MotionScales motion_scales(const Element& element, double top_speed) {
  MotionScales scales;
  if (port_of(element) == DrivenBy::input) {
    const double own = largest_parameter(element, "1"), time = largest_parameter(element, "s");
    if (own > 0.0) scales.signal = own;
    scales.shortest = scales.longest = time > 0.0 ? time : 1.0;
    scales.least = 1e-3 * scales.signal, scales.most = 10.0 * scales.signal;
    scales.reach = scales.most;
    return scales;
  }
  const Scales own = element.scales();
  scales.signal = own.velocity < infinite ? own.velocity : 1e-3;
  scales.way = own.displacement < infinite ? own.displacement : 0.1 * scales.signal;
  std::vector<double> times = time_constants(element, scales.signal, scales.way);
  if (times.empty()) times.push_back(scales.way / scales.signal);
  scales.shortest = std::ranges::min(times), scales.longest = std::ranges::max(times);
  ElementSlopes slopes(element);
  const std::vector<double> rest(static_cast<std::size_t>(element.states()), 0.0);
  const double damping = slopes.response({0.0, 1e-3 * scales.signal, infinite}, {}, rest.data())(0, 1);
  if (std::isfinite(damping) && damping > 0.0) scales.damping = own.output / damping;
  scales.least = 1e-9 * scales.signal;
  scales.most = std::min(top_speed, std::max(1e3 * scales.signal, 100.0 * scales.damping));
  scales.reach = std::min(top_speed, std::max(scales.most, 1e5 * scales.damping));
  scales.least = std::min(scales.least, 1e-3 * scales.most);
  return scales;
}

std::vector<SignalPiece> pieces_of(const Strokes& strokes, DrivenBy port) {
  std::vector<SignalPiece> pieces;
  double last = strokes.back().sign * std::pow(10.0, strokes.back().size);
  for (const Stroke& stroke : strokes) {
    const double to = stroke.sign * std::pow(10.0, stroke.size), from = stroke.ramp ? last : to;
    const double speed = 0.5 * (std::abs(from) + std::abs(to)), length = std::pow(10.0, stroke.length);
    const double duration = stroke.by_time || port == DrivenBy::input ? length : length / speed;
    last = to;
    if (from == to && !pieces.empty() && pieces.back().from == to && pieces.back().to == to)
      pieces.back().duration += duration;
    else
      pieces.push_back({duration, from, to});
  }
  return pieces;
}

Strokes random_strokes(const MotionScales& scales, DrivenBy port, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto between = [&](double low, double high) {
    return std::log10(low) + unit(random) * (std::log10(high) - std::log10(low));
  };
  Strokes strokes(2 + static_cast<std::size_t>(5.0 * unit(random)));
  for (Stroke& stroke : strokes) {
    stroke.sign = unit(random) < 0.5 ? 1 : -1;
    stroke.ramp = unit(random) < 0.25;
    stroke.by_time = port == DrivenBy::input || unit(random) < 0.3;
    stroke.size = between(scales.least, scales.most);
    stroke.length = stroke.by_time ? between(0.03 * scales.shortest, 100.0 * scales.longest)
                                   : between(1e-2 * scales.way, 300.0 * scales.way);
  }
  return strokes;
}

std::vector<Strokes> known_strokes(const MotionScales& scales, DrivenBy port) {
  return port == DrivenBy::input ? strokes_of_inputs(scales) : strokes_of_velocity(scales);
}

}  // namespace limcycle
