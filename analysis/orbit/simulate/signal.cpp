#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"

namespace limcycle {
namespace {

/// Triangle wave of unit slope between -1 and 1, starting at 0 upwards, as a function of the distance travelled.
double triangle(double path) {
  const double turn = std::fmod(path + 1.0, 4.0);
  return turn < 2.0 ? turn - 1.0 : 3.0 - turn;
}

}  // namespace

double Signal::at(double t) const {
  if (kind == Kind::constant) return value;
  if (kind == Kind::table) {
    const auto next = std::ranges::upper_bound(times, t);
    if (next == times.begin()) return values.front();
    if (next == times.end()) return values.back();
    const auto i = static_cast<std::size_t>(next - times.begin());
    const double share = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
  }
  if (t < start) return 0.0;
  switch (kind) {
    case Kind::step:
      return value;
    case Kind::ramp:
      return rate * (t - start);
    case Kind::sine:
      return value * std::sin(frequency * (t - start));
    default:
      return value * triangle(rate * (t - start) / value);  // zigzag
  }
}

double Signal::slope(double t) const {
  if (kind == Kind::table) {
    const auto next = std::ranges::upper_bound(times, t);
    if (next == times.begin() || next == times.end()) return 0.0;
    const auto i = static_cast<std::size_t>(next - times.begin());
    return (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
  }
  if (t < start) return 0.0;
  switch (kind) {
    case Kind::ramp:
      return rate;
    case Kind::sine:
      return value * frequency * std::cos(frequency * (t - start));
    case Kind::zigzag:
      return std::fmod(rate * (t - start) / value + 1.0, 4.0) < 2.0 ? rate : -rate;
    default:
      return 0.0;
  }
}

std::vector<double> Signal::breaks(double until) const {
  std::vector<double> found;
  if (kind == Kind::table) found = times;
  if (kind == Kind::step || kind == Kind::ramp || kind == Kind::sine || kind == Kind::zigzag) found.push_back(start);
  if (kind == Kind::zigzag)
    for (double t = start + value / rate; t < until && found.size() < 1000000; t += 2.0 * value / rate)
      found.push_back(t);
  std::erase_if(found, [&](double t) { return !(t > 0.0 && t < until); });
  return found;
}

}  // namespace limcycle
