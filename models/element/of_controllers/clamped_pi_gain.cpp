#include "limcycle/models/element/of_controllers/clamped_pi_gain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "limcycle/models/element/of_controllers/clamped_pi.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
constexpr int most_turns = 100;
constexpr double turn = 2.0 * std::numbers::pi, never = std::numeric_limits<double>::infinity();

/// First angle after `now` that is `angle` and whole turns.
double after(double now, double angle) {
  constexpr double same = 1e-12;
  const double next = angle + turn * std::ceil((now - angle) / turn);
  return next > now + same ? next : next + turn;
}

/// a sin(theta) + b cos(theta) + c.
struct Wave {
  double a = 0.0, b = 0.0, c = 0.0;

  double at(double theta) const { return a * std::sin(theta) + b * std::cos(theta) + c; }
  /// The next angle at which it falls through 0.
  double falls(double now) const {
    const double size = std::hypot(a, b);
    if (!(std::abs(c) < size)) return never;
    return after(now, std::numbers::pi - std::asin(-c / size) - std::atan2(b, a));
  }
  /// Integral times e^(-j theta), conjugated: of the sine in the real part, of the cosine in the imaginary part.
  Complex harmonic(double from, double to) const {
    const auto primitive = [&](double t) {
      const double sine = std::sin(t), cosine = std::cos(t), mixed = 0.5 * sine * sine, twice = 0.5 * sine * cosine;
      return Complex(a * (0.5 * t - twice) + b * mixed - c * cosine, a * mixed + b * (0.5 * t + twice) + c * sine);
    };
    return primitive(to) - primitive(from);
  }
};

Wave scaled(const Wave& wave, double factor) { return {factor * wave.a, factor * wave.b, factor * wave.c}; }
Wave raised(Wave wave, double by) {
  wave.c += by;
  return wave;
}

/// The element under A sin(theta), its modes and switches those of ClampedPi itself.
class Turns {
 public:
  Turns(double kp, double ki, double limit, double A, double w)
      : w_(w), limit_(limit), proportional_{kp * A, 0.0, 0.0}, push_{ki * A, 0.0, 0.0}, way_(ki * A / w) {
    element_.kp = kp;
    element_.ki = ki;
    element_.limit = limit;
    mode_ = element_.start(input(0.0, A, w), {&z_, 1});
    A_ = A;
  }

  /// The next turn of the input: the integral of the output times e^(-j theta). False if it switches without end.
  bool turn_once(Complex& sum) {
    constexpr double same = 1e-9;  // a switch at the very end belongs to this turn
    const double end = theta_ + turn;
    sum = 0.0;
    for (int switches = 0; switches < 40; ++switches) {
      const auto [next, fired] = next_switch();
      const double to = next <= end + same ? next : end;
      sum += (mode_.value == 0 ? command() : Wave{0.0, 0.0, side() * limit_}).harmonic(theta_, to);
      if (std::abs(mode_.value) <= 1) z_ += way_ * (std::cos(theta_) - std::cos(to));
      theta_ = to;
      if (next <= end + same) mode_ = element_.next(input(theta_, A_, w_), mode_, {&z_, 1}, fired);
      if (theta_ < end - same) continue;
      theta_ -= turn;
      return true;
    }
    return false;
  }
  double integral() const { return z_; }
  void begin_with(double z) { z_ = z; }
  std::int64_t mode() const { return mode_.value; }

 private:
  static Input<double> input(double theta, double A, double w) {
    return {A * std::sin(theta), A * w * std::cos(theta), 0.0};
  }
  double side() const { return mode_.value > 0 ? 1.0 : -1.0; }
  /// u as long as the mode lasts.
  Wave command() const {
    if (std::abs(mode_.value) <= 1) return {proportional_.a, -way_, z_ + way_ * std::cos(theta_)};
    return raised(proportional_, z_);
  }
  /// When the guards of the mode fall through 0, and which of them first.
  std::pair<double, int> next_switch() const {
    const double s = side();
    Wave first, second;
    switch (std::abs(mode_.value)) {
      case 0:
        first = raised(scaled(command(), -1.0), limit_);
        second = raised(command(), limit_);
        break;
      case 1:
        first = raised(scaled(command(), s), -limit_);
        second = scaled(push_, -s);
        break;
      case 2:
        first = raised(scaled(command(), s), -limit_);
        second = scaled(push_, s);
        break;
      default:
        first = {s * push_.a, s * proportional_.a * w_, 0.0};
        second = {0.0, -s * proportional_.a * w_, 0.0};
    }
    const double at_first = first.falls(theta_), at_second = second.falls(theta_);
    return at_first <= at_second ? std::pair(at_first, 0) : std::pair(at_second, 1);
  }

  ClampedPi<double> element_;
  double A_ = 0.0, w_, limit_;
  Wave proportional_, push_;
  double way_;  ///< amplitude of the integral within the limit
  double theta_ = 0.0, z_ = 0.0;
  Mode mode_;
};

}  // namespace

std::optional<Complex> clamped_pi_gain(double kp, double ki, double limit, double A, double w) {
  const Complex within(kp, -ki / w);
  if (A * std::abs(within) <= limit) return within;
  Turns turns(kp, ki, limit, A, w);
  Complex sum;
  double last_before = 0.0, last_after = 0.0;
  for (int i = 0; i < most_turns; ++i) {
    const double before = turns.integral();
    const std::int64_t mode = turns.mode();
    if (!turns.turn_once(sum)) return std::nullopt;
    const double after = turns.integral();
    const bool repeats = i > 0 && mode == turns.mode();
    if (repeats && std::abs(after - before) <= 1e-13 * limit) return sum / (std::numbers::pi * A);
    // Where a turn changes the integral little, the periodic state is far: a secant leads there.
    const double slope = (after - last_after) / (before - last_before);
    if (repeats && mode == 0 && slope > 0.2 && slope < 1.0)
      turns.begin_with(std::clamp(before + (after - before) / (1.0 - slope), -limit, limit));
    last_before = before;
    last_after = after;
  }
  return std::nullopt;
}

}  // namespace limcycle
