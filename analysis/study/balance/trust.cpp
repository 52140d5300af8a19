#include "limcycle/analysis/study/balance/trust.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

constexpr int highest_harmonic = 7;
constexpr Interval unbounded{0.0, infinite};

bool rubs(const Loop& loop, std::size_t i) { return loop.ports[i].rubs; }

std::string percent(double share) { return short_number(100.0 * share, 2) + " %"; }

/// Fills filter_ratio, worst_harmonic and harmonic_residual: sizes of the harmonics that return to the element's input.
void measure_filter(const Loop& loop, const FirstHarmonicBalance& balance, double A, double w, Trust& trust) {
  DfOptions options;
  options.harmonics = highest_harmonic;
  const double bias = balance.bias(A, w, 1e-9);
  const auto df = describing_function(loop.elements[balance.main_element()], {A, w, bias}, options);
  std::array<double, highest_harmonic + 1> back{};
  for (int n = 1; n <= highest_harmonic; ++n)
    back[static_cast<std::size_t>(n)] =
        std::abs(balance.response(A, w, n) * df.harmonics[static_cast<std::size_t>(n - 1)]);
  double sum = 0.0;
  for (std::size_t n = 2; n < back.size(); ++n) sum += back[n] * back[n] / (back[1] * back[1]);
  trust.harmonic_residual = std::isfinite(sum) ? std::sqrt(sum) : infinite;
  trust.filter_ratio = back[3] / back[1];
  for (const std::size_t n : {std::size_t{2}, std::size_t{5}})
    if ((n == 5 || !df.symmetric) && !(back[n] / back[1] <= trust.filter_ratio)) {
      trust.filter_ratio = back[n] / back[1];
      trust.worst_harmonic = static_cast<int>(n);
    }
  if (!std::isfinite(trust.filter_ratio)) trust.filter_ratio = infinite;
}

/// Share of a period in which |V + A w cos| < vs/100.
double sticking(const Loop& loop, const FirstHarmonicBalance& balance, double A, double w) {
  const std::size_t main = balance.main_element();
  if (!rubs(loop, main)) return 0.0;
  const Scales scales = loop.elements[main].scales();
  if (!std::isfinite(scales.velocity)) return 0.0;
  const double slow = scales.velocity / 100.0, V = balance.mean_velocity();
  const auto phase = [&](double v) { return std::acos(std::clamp((v - V) / (A * w), -1.0, 1.0)); };
  return (phase(-slow) - phase(slow)) / std::numbers::pi;
}

/// Amplitude of y's first harmonic over that of the element's input. With one element this is a property of the linear
/// part alone, even if N does not exist there.
double output_ratio(const Loop& loop, const FirstHarmonicBalance& balance, double A, double w) {
  if (loop.elements.size() == 1) return std::abs(loop.output_response(w)(0) / loop.element_response(w)(0, 0));
  const double input = std::abs(balance.gain(A, w, 1e-9) * A * balance.response(A, w, 1));
  return balance.output_amplitude(A, w) / input;
}

/// Amplitude of y over the band: the ratio over the frequencies (samples, widened by the largest step between
/// neighbours) times the amplitude of the input.
Interval of_output(const Loop& loop, const FirstHarmonicBalance& balance, double A, const Band& band, int samples) {
  const Interval w = band.frequency;
  if (!std::isfinite(w.high) || !std::isfinite(band.input_amplitude.high)) return unbounded;
  double before = output_ratio(loop, balance, A, w.low), step = 0.0;
  Interval range{before, before};
  for (int i = 1; i <= samples; ++i) {
    const double ratio = output_ratio(loop, balance, A, w.low + (w.high - w.low) * i / samples);
    if (!std::isfinite(ratio)) return unbounded;
    step = std::max(step, std::abs(ratio - before));
    range = {std::min(range.low, ratio), std::max(range.high, ratio)};
    before = ratio;
  }
  return {std::max(0.0, range.low - step) * band.input_amplitude.low, (range.high + step) * band.input_amplitude.high};
}

/// Image of the disc of radius sigma about 1/G in the plane of G, unless it is ten times as large as G (or unbounded).
std::optional<ErrorDisc> disc_of_G(double frequency, Complex inverse, double sigma) {
  const double left = std::norm(inverse) - sigma * sigma;
  if (!(sigma < 0.95 * std::abs(inverse)) || !std::isfinite(left)) return std::nullopt;
  return ErrorDisc{frequency, std::conj(inverse) / left, sigma / left};
}

/// Derivatives of f = 1 + N G with respect to ln A and ln w, by differences on the sides on which N exists.
struct Slopes {
  Complex amplitude, frequency;
};
Slopes slopes_at(const FirstHarmonicBalance& balance, double A, double w) {
  constexpr double step = 1e-3, accuracy = 1e-8;
  const auto slope = [&](double to_A, double to_w) {
    const auto f = [&](double s) { return balance(A * std::exp(s * to_A), w * std::exp(s * to_w), accuracy); };
    const Complex up = f(step), down = f(-step);
    if (std::isfinite(std::abs(up)) && std::isfinite(std::abs(down))) return (up - down) / (2.0 * step);
    const bool above = std::isfinite(std::abs(up));
    return ((above ? up : down) - f(0.0)) / (above ? step : -step);
  };
  return {slope(1.0, 0.0), slope(0.0, 1.0)};
}

/// A first-order band beyond a factor of 10 has no meaning.
Interval about(double value, double reach) {
  if (!(reach < std::log(10.0))) return unbounded;
  return {value * std::exp(-reach), value * std::exp(reach)};
}

Band heuristic_band(const Loop& loop, const FirstHarmonicBalance& balance, double A, double w, double residual) {
  Band band{.frequency = unbounded, .amplitude = unbounded, .input_amplitude = unbounded, .discs = {}, .why = {}};
  const Slopes d = slopes_at(balance, A, w);
  const double det = std::abs((std::conj(d.amplitude) * d.frequency).imag());
  const double radius = residual / (1.0 - residual) * (1.0 + std::abs(d.amplitude));
  const bool bounded = residual < 0.9 && std::isfinite(radius) && det > 1e-9 * std::norm(d.frequency);
  if (!bounded) {
    band.why =
        "no bounded band: " + std::string(residual < 0.9 ? "amplitude and frequency are not determined separately"
                                                         : "the harmonics are as large as the first");
    return band;
  }
  const double in_A = radius * std::abs(d.frequency) / det, in_w = radius * std::abs(d.amplitude) / det;
  band.frequency = about(w, in_w);
  band.input_amplitude = about(A, in_A);
  band.amplitude = of_output(loop, balance, A, band, loop.elements.size() == 1 ? 64 : 8);
  const Complex inverse = -1.0 / balance.response(A, w, 1);
  if (const auto disc = disc_of_G(w, inverse, radius * std::abs(inverse))) band.discs.push_back(*disc);
  band.why = "heuristic: the size of the returning harmonics times the slope of N";
  return band;
}

std::optional<Band> rigorous_band(const Loop& loop, const ErrorBand& discs, const FirstHarmonicBalance& balance,
                                  double A, double w, std::string& why_not) {
  const Existence found = discs.existence(w, A);
  if (found.verdict != BandVerdict::proved) {
    why_not = found.why;
    return std::nullopt;
  }
  Band band{BandKind::rigorous, BandVerdict::proved, found.frequency, {}, found.amplitude, {}, found.why};
  band.amplitude = of_output(loop, balance, A, band, 64);
  constexpr int drawn = 9;
  for (int i = 0; i < drawn; ++i) {
    const double at = band.frequency.low + (band.frequency.high - band.frequency.low) * i / (drawn - 1);
    if (const auto disc = disc_of_G(at, discs.inverse_response(at), discs.sigma(at))) band.discs.push_back(*disc);
  }
  return band;
}

/// Largest relative distance of the ends of an interval from a value inside.
double reach(Interval interval, double value) {
  return std::max(interval.high / value - 1.0, 1.0 - interval.low / value);
}

std::string in_words(const Trust& trust, const FirstHarmonicBalance& balance, const Loop& loop, double A, double w) {
  static constexpr std::array<const char*, 6> names{"", "", "second", "third", "", "fifth"};
  const std::string name = names[static_cast<std::size_t>(trust.worst_harmonic)];
  const double ratio = trust.filter_ratio;
  std::string text = !std::isfinite(ratio) ? "the " + name + " harmonic meets a resonance of the loop"
                     : ratio < 0.01        ? "the loop filters the harmonics well"
                     : ratio < 0.05        ? "the loop filters the " + name + " harmonic fairly well"
                     : ratio < 0.15        ? "the loop filters the " + name + " harmonic poorly"
                                           : "the loop hardly filters the " + name + " harmonic";
  const double error = std::max(reach(trust.band.input_amplitude, A), reach(trust.band.frequency, w));
  text += ratio < 0.05 && error > 0.2 ? ", but the balance is sensitive: " : ": ";
  if (trust.band.kind == BandKind::rigorous)
    text += "a cycle within " + percent(error) + " of it is proved";
  else if (error < 1.0)
    text += "expect errors of up to about " + percent(error);
  else
    text += "amplitude and frequency may be far off";
  if (!rubs(loop, balance.main_element())) return text;
  const bool has_speed = std::isfinite(loop.elements[balance.main_element()].scales().velocity);
  if (!has_speed) return text + "; a sinusoid never rests, so sticking is not represented";
  if (trust.sticking_fraction > 0.0) text += "; the sinusoid sticks for " + percent(trust.sticking_fraction);
  return text;
}

}  // namespace

std::string_view to_string(BandKind kind) { return kind == BandKind::rigorous ? "rigorous" : "heuristic"; }

Trust trust(const Loop& loop, const FirstHarmonicBalance& balance, double amplitude, double frequency) {
  Trust result;
  measure_filter(loop, balance, amplitude, frequency, result);
  result.sticking_fraction = sticking(loop, balance, amplitude, frequency);
  std::optional<Band> proved;
  std::string why_not;
  if (const auto why = ErrorBand::not_applicable(loop))
    why_not = *why;
  else
    proved = rigorous_band(loop, ErrorBand(loop), balance, amplitude, frequency, why_not);
  if (proved) {
    result.band = *proved;
  } else {
    result.band = heuristic_band(loop, balance, amplitude, frequency, result.harmonic_residual);
    result.band.why += "; " + why_not;
  }
  result.sentence = in_words(result, balance, loop, amplitude, frequency);
  return result;
}

std::optional<Absence> absence(const Loop& loop, const SearchBox& box) {
  if (ErrorBand::not_applicable(loop)) return std::nullopt;
  return ErrorBand(loop).absence(box);
}

}  // namespace limcycle
