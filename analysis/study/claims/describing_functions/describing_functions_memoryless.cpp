#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Numbers = std::vector<double>;
using Complex = std::complex<double>;

const std::string control = "python-control, describing functions; checked by computation";
const std::string memoryless_by_computation =
    "describing function by FFT of the sampled output and by quadrature split at the switches at the printed points, "
    "by "
    "quadrature at random ones, without the closed form";

Element relay(double level, double hysteresis, double dead_zone) {
  Relay<double> element;
  element.level = level;
  element.hysteresis = hysteresis;
  element.dead_zone = dead_zone;
  return element;
}

/// Two numbers over two decades each, and an amplitude over a given range of multiples of the second.
std::function<GainPoint(RandomPoints&)> two_numbers(double least, double most) {
  return [least, most](RandomPoints& random) {
    const Numbers p{random.log_between(0.1, 10.0), random.log_between(0.1, 10.0)};
    return GainPoint{p, p[1] * random.log_between(least, most)};
  };
}

GainClaim ideal_relay() {
  GainFormula f;
  f.names = {{"M", ""}};
  f.element = [](const Numbers& p) { return relay(p[0], 0.0, 0.0); };
  f.gain = [](const GainPoint& at) -> Complex { return 4.0 * at.p[0] / (pi * at.amplitude); };
  f.printed = {{{{1.0}, 2.0}, 0.636620, 1e-6}};
  f.draw = [](RandomPoints& random) {
    return GainPoint{{random.log_between(0.01, 100.0)}, random.log_between(1e-3, 1e3)};
  };
  return {{"A1",
           "The describing function of an ideal relay of level M falls with 1/A.",
           "N = 4 M/(pi A)",
           "textbook; not opened",
           Evidence::knowledge,
           "M > 0, A > 0",
           memoryless_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

GainClaim relay_with_dead_zone() {
  GainFormula f;
  f.names = {{"M", ""}, {"d", ""}};
  f.element = [](const Numbers& p) { return relay(p[0], 0.0, p[1]); };
  f.gain = [](const GainPoint& at) -> Complex {
    const double A = at.amplitude, u = at.p[1] / A;
    return u >= 1.0 ? 0.0 : 4.0 * at.p[0] / (pi * A) * std::sqrt((1.0 - u) * (1.0 + u));
  };
  f.printed = {{{{1.0, 0.5}, 2.0}, 0.616404, 1e-6}};
  f.draw = two_numbers(0.3, 100.0);
  return {{"A4",
           "A relay with dead zone of half-width d has a describing function that is zero up to A = d.",
           "N = 4 M/(pi A) sqrt(1 - (d/A)^2) for A > d, else 0",
           "textbook; not opened; checked by computation",
           Evidence::knowledge,
           "M, d > 0; A from 0.3 d to 100 d",
           memoryless_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

/// Below its hysteresis a relay does not switch: N is undefined, the output is its constant initial value.
void check_no_switching(ClaimChecks& checks, const ClaimOptions&) {
  for (const double A : {0.1, 0.499}) {
    const auto df = computed_gain(relay(1.0, 0.5, 0.0), {A, 1.0, 0.0}, true, 1e-8);
    if (!df.answered()) return checks.stop(df.status);
    const std::string at = place({{"M", 1.0}, {"h", 0.5}, {"A", A}});
    checks.equal(at, "|mean output| of a relay that does not switch", "", 1.0, std::abs(df.mean), 1e-13);
    checks.equal(at, "first harmonic of its output", "", 0.0, std::abs(df.gain) * A, 1e-13);
  }
}

GainClaim relay_with_hysteresis() {
  GainFormula f;
  f.names = {{"M", ""}, {"h", ""}};
  f.element = [](const Numbers& p) { return relay(p[0], p[1], 0.0); };
  f.gain = [](const GainPoint& at) {
    const double A = at.amplitude, u = at.p[1] / A;
    return 4.0 * at.p[0] / (pi * A) * Complex(std::sqrt((1.0 - u) * (1.0 + u)), -u);
  };
  f.printed = {{{{1.0, 0.5}, 2.0}, {0.616404, -0.159155}, 1e-6}};
  f.draw = two_numbers(1.01, 100.0);
  f.once = check_no_switching;
  return {{"A5",
           "A relay with hysteresis of half-width h lags: its describing function has a negative imaginary part. Below "
           "A = h it does not switch, and there is no describing function.",
           "N = 4 M/(pi A) (sqrt(1 - (h/A)^2) - j h/A)",
           control,
           Evidence::read,
           "M, h > 0; A from 1.01 h to 100 h; no switching for A < h",
           memoryless_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

GainClaim saturated() {
  GainFormula f;
  f.names = {{"k", ""}, {"delta", ""}};
  f.element = [](const Numbers& p) {
    Saturation<double> element;
    element.slope = p[0];
    element.limit = p[0] * p[1];
    return element;
  };
  f.gain = [](const GainPoint& at) -> Complex { return at.p[0] * share_inside(at.p[1] / at.amplitude); };
  f.printed = {{{{1.0, 0.5}, 2.0}, 0.314962, 1e-6}};
  f.draw = two_numbers(0.3, 100.0);
  return {{"A6",
           "Describing function of a saturation of slope k that breaks at delta.",
           "N = k (2/pi)(asin(delta/A) + (delta/A) sqrt(1 - (delta/A)^2)) for A > delta, else k",
           control,
           Evidence::read,
           "k, delta > 0; A from 0.3 delta to 100 delta",
           memoryless_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

GainClaim dead_zone() {
  GainFormula f;
  f.names = {{"k", ""}, {"delta", ""}};
  f.element = [](const Numbers& p) {
    DeadZone<double> element;
    element.slope = p[0];
    element.half_width = p[1];
    return element;
  };
  f.gain = [](const GainPoint& at) -> Complex { return at.p[0] * (1.0 - share_inside(at.p[1] / at.amplitude)); };
  f.printed = {{{{1.0, 0.5}, 2.0}, 0.685038, 1e-6}};
  f.draw = two_numbers(0.3, 100.0);
  return {{"A6b",
           "A dead zone of half-width delta is what a saturation leaves of a straight line.",
           "N = k - N of A6; 0 for A <= delta",
           "textbook; not opened",
           Evidence::knowledge,
           "k, delta > 0; A from 0.3 delta to 100 delta",
           memoryless_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

GainClaim backlash() {
  GainFormula f;
  f.names = {{"h", ""}};
  f.element = [](const Numbers& p) {
    Backlash<double> element;
    element.half_gap = p[0];
    return element;
  };
  f.gain = [](const GainPoint& at) -> Complex {
    const double u = at.p[0] / at.amplitude;
    if (u >= 1.0) return 0.0;
    return {0.5 * (1.0 + share_inside(1.0 - 2.0 * u)), -4.0 / pi * u * (1.0 - u)};
  };
  f.printed = {{{{0.5}, 2.0}, {0.804499, -0.238732}, 1e-6}, {{{1.0}, 2.0}, {0.5, -0.318310}, 1e-6}};
  f.draw = [](RandomPoints& random) {
    const double h = random.log_between(0.1, 10.0);
    return GainPoint{{h}, h * random.log_between(0.3, 100.0)};
  };
  return {
      {"A7",
       "Friction-controlled backlash (play) of slope 1 and half-gap h lags; it passes nothing on up to A = h.",
       "N = (1 + f(1 - 2 h/A))/2 - j (4/pi)(h/A)(1 - h/A), f(u) = (2/pi)(asin u + u sqrt(1 - u^2)); 0 for A <= h",
       "python-control (friction_backlash_nonlinearity), which cites Gelb and Vander Velde (1968), item 48; checked "
       "by computation",
       Evidence::read,
       "h > 0; A from 0.3 h to 100 h",
       memoryless_by_computation,
       ClaimVerdict::holds,
       {}},
      f};
}

GainClaim cubic() {
  GainFormula f;
  f.names = {{"c", ""}};
  f.element = [](const Numbers& p) {
    Cubic<double> element;
    element.coefficient = p[0];
    return element;
  };
  f.gain = [](const GainPoint& at) -> Complex { return 0.75 * at.p[0] * at.amplitude * at.amplitude; };
  f.printed = {{{{1.0}, 2.0}, 3.0, 1e-6}};
  f.draw = [](RandomPoints& random) { return GainPoint{{random.between(-3.0, 3.0)}, random.log_between(1e-3, 1e3)}; };
  return {{"A10",
           "The describing function of a cubic grows with the square of the amplitude.",
           "N = (3/4) c A^2",
           "textbook; not opened",
           Evidence::knowledge,
           "any c, A > 0",
           memoryless_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

}  // namespace

std::vector<GainClaim> memoryless_gain_claims() {
  return {ideal_relay(), relay_with_dead_zone(), relay_with_hysteresis(), saturated(), dead_zone(), backlash(),
          cubic()};
}

}  // namespace limcycle
