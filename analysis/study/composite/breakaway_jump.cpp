#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"

/// @file
/// The jump of N at the break-away force: its location, and roots of the balance within it.

namespace limcycle {
namespace {

using Complex = std::complex<double>;

/// Half-width of the jump, relative to the force: within it, the time of break-away depends on digits that are unknown.
constexpr double front_width = 1e-4;

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }
double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }

}  // namespace

/// Guess from two known neighbours, on a straight line over the logarithm of the frequency; 0: none is known.
double CompositeBalance::guess_front(double frequency) const {
  double nearest = infinite, next = infinite, at[2] = {0.0, 0.0}, force[2] = {0.0, 0.0};
  for (const auto& [key, value] : fronts_) {
    const double place = std::log(key.first / frequency), apart = std::abs(place);
    if (apart < nearest) {
      next = nearest;
      at[1] = at[0];
      force[1] = force[0];
      nearest = apart;
      at[0] = place;
      force[0] = value;
    } else if (apart < next && place != at[0]) {
      next = apart;
      at[1] = place;
      force[1] = value;
    }
  }
  if (!std::isfinite(next) || std::abs(at[1] - at[0]) < 1e-6) return force[0];
  return force[0] - at[0] * (force[1] - force[0]) / (at[1] - at[0]);
}

/// Break-away force and N on either side. The force is cached: it is needed at every amplitude of a frequency.
CompositeBalance::Front CompositeBalance::front(double frequency, double accuracy) {
  const double relative = accuracy > 1e-5 ? 0.3 * front_width : 1e-9;
  const auto key = std::pair(frequency, relative);
  auto known = fronts_.find(key);
  if (known == fronts_.end()) {
    known = fronts_.emplace(key, element_.break_away(frequency, relative, guess_front(frequency))).first;
  }
  return {known->second, {}, {}, 0.0, 0.0};
}

/// The force of the jump for polishing, which needs it at ever new frequencies close together. It only has to be smooth
/// and much nearer to the jump than front_width: a parabola through three of them is, for about a hundredth of the
/// marches. The first parabola that covers a frequency is kept for it, so that a coordinate keeps its meaning.
double CompositeBalance::smooth_front(double frequency) {
  constexpr double apart = 0.01, reach = 0.02;  // of ln w
  const auto at = [&](const SmoothFront& known) {
    const double x = std::log(frequency / known.frequency);
    return known.force + x * (known.slope + x * known.bend);
  };
  for (const SmoothFront& known : smooth_fronts_)
    if (std::abs(std::log(frequency / known.frequency)) <= reach) return at(known);
  constexpr double exact = 1e-12;
  const double before = front(frequency * std::exp(-apart), exact).force, here = front(frequency, exact).force,
               after = front(frequency * std::exp(apart), exact).force;
  smooth_fronts_.push_back(
      {frequency, here, (after - before) / (2.0 * apart), (after - 2.0 * here + before) / (2.0 * apart * apart)});
  return here;
}

/// The force at a coordinate that keeps the jump at 1: below it U itself, above it 1 + (ln)^2/2 + ..., because N
/// departs from the jump like a square root.
double CompositeBalance::side_force(double coordinate, double frequency, bool above, double accuracy) {
  const double leap = accuracy > 1e-5 ? front(frequency, accuracy).force : smooth_front(frequency);
  return above ? leap * (1.0 + front_width) * std::cosh(std::log(coordinate)) : leap * (1.0 - front_width) * coordinate;
}

/// Along the jump: 1 - K N is 0 on the straight line between its two sides where they point in opposite directions.
void CompositeBalance::search_front(const Window& window, const CompositeSearchOptions& options,
                                    CompositeSearch& found) {
  const auto sides = [&](double w, double accuracy) {
    Front f = front(w, accuracy);
    near_.reset();
    const CompositeResponse low = solve(f.force * (1.0 - front_width), w, accuracy, false);
    near_.reset();
    const CompositeResponse high = solve(f.force * (1.0 + front_width), w, accuracy, false);
    near_.reset();
    f.below = f.above = {std::nan(""), std::nan("")};
    if (low.status == Status::converged) f.below = residue(low.gain, w);
    if (high.status == Status::converged) f.above = residue(high.gain, w);
    f.sticking_below = low.sticking_fraction;
    f.sticking_above = high.sticking_fraction;
    return f;
  };
  const int n = std::clamp(static_cast<int>(8.0 * std::log10(window.high / window.low)), 12, 60);
  const double ratio = std::log(window.high / window.low) / n;
  double w0 = window.low;
  Front last = sides(w0, options.coarse_accuracy);
  for (int i = 1; i <= n; ++i) {
    if (ended_early(options, found)) {
      found.notes.emplace_back("the search in the jump at break-away: step limit reached, solutions may be missing");
      return;
    }
    const double w1 = window.low * std::exp(ratio * i);
    const Front now = sides(w1, options.coarse_accuracy);
    const double c0 = cross(last.below, last.above), c1 = cross(now.below, now.above);
    if (c0 * c1 < 0.0) {
      double low = w0, high = w1, at_low = c0, at_high = c1;
      Front f = last;
      double w = w0;
      for (int k = 0; k < 30 && high - low > 1e-5 * low; ++k) {
        w = k % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * at_low / (at_low - at_high);
        f = sides(w, 1e-6);
        const double c = cross(f.below, f.above);
        if (!std::isfinite(c) || c == 0.0) break;
        ((c < 0.0) == (at_low < 0.0) ? low : high) = w;
        ((c < 0.0) == (at_low < 0.0) ? at_low : at_high) = c;
      }
      last = now;
      w0 = w1;
      if (!(dot(f.below, f.above) < 0.0)) continue;
      const double share = std::abs(f.below) / (std::abs(f.below) + std::abs(f.above));
      const double step = 1e-3;
      const Front later = sides(w * (1.0 + step), 1e-6);
      const Complex along = ((1.0 - share) * (later.below - f.below) + share * (later.above - f.above)) / step;
      const int index = cross(f.above - f.below, along) > 0.0 ? 1 : -1;
      CompositeRoot root = describe(f.force, w, 1.0 / rest_of_loop(w), index);
      root.residual = std::abs(cross(f.below, f.above)) / std::abs(f.above - f.below);
      root.sticking_fraction = (1.0 - share) * f.sticking_below + share * f.sticking_above;
      root.on_break_away_front = true;
      root.note = "lies in the leap of N at break-away (U = " + short_number(f.force) +
                  " N), between x1 = " + short_number(std::abs((1.0 - f.below) / rest_of_loop(w)) * f.force) +
                  " m and " + short_number(std::abs((1.0 - f.above) / rest_of_loop(w)) * f.force) +
                  " m: a first-harmonic balance is hardly a prediction there";
      found.roots.push_back(root);
    }
    last = now;
    w0 = w1;
  }
}

}  // namespace limcycle
