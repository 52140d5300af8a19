#include <algorithm>
#include <cmath>

#include "limcycle/analysis/frequency/describing_function/error_band.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr long most_tests = 20000;

double middle_of(Interval w) { return std::sqrt(w.low * w.high); }

}  // namespace

/// Holds every gain at these amplitudes: samples, widened by the largest step between neighbours, within [alpha, beta]
/// (a gain is a mean of slopes).
Interval ErrorBand::gains_between(double amplitude_min, double amplitude_max) const {
  constexpr int samples = 400;
  Interval range{infinite, -infinite};
  double before = gain(amplitude_min), step = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double psi = gain(amplitude_min * std::pow(amplitude_max / amplitude_min, double(i) / samples));
    step = std::max(step, std::abs(psi - before));
    range = {std::min(range.low, psi), std::max(range.high, psi)};
    before = psi;
  }
  return {std::max(alpha(), range.low - step), std::min(beta(), range.high + step)};
}

/// Lowest frequency (not below `least`) from which on the incremental circle criterion holds at all frequencies.
double ErrorBand::circle_from(double least) const {
  double from = std::max(least, response_.scale());
  for (int i = 0; i < 200 && !(response_.growth(from) > std::abs(centre_) + gamma_); ++i) from *= 2.0;
  if (!(response_.growth(from) > std::abs(centre_) + gamma_)) return infinite;
  for (double width = 0.25; from > least && width > 1e-7;) {
    const double next = std::max(least, from * (1.0 - width));
    if (response_.farther_than(gamma_, centre_, {next, from})) {
      from = next;
      width = std::min(0.25, 2.0 * width);
    } else {
      width *= 0.5;
    }
  }
  return from;
}

/// True if an oscillation with its gain in `gains` is excluded at every frequency of the interval.
bool ErrorBand::excluded(Interval w, Interval gains, double circle) const {
  const double reach = sigma(w);
  if (std::isfinite(reach)) {
    const auto q = response_.inverse(w);
    const double beside = -q.centre.real() - std::clamp(-q.centre.real(), gains.low, gains.high);
    if (std::hypot(beside, q.centre.imag()) - q.radius > reach) return true;
  }
  for (double k = 1.0; k * w.low < circle; k += 2.0)
    if (!response_.farther_than(gamma_, centre_, {k * w.low, k * w.high})) return false;
  return true;
}

Absence ErrorBand::absence(const SearchBox& box) const {
  Absence answer;
  answer.box = box;
  const Interval gains = gains_between(box.amplitude_min, box.amplitude_max);
  const double circle = circle_from(box.frequency_min);
  std::vector<Interval> cells, open;  // cells: a stack, the lowest frequencies on top
  const double end = std::min(box.frequency_max, circle);
  constexpr int initial = 128;
  const auto grid = [&](int i) {
    return i == initial ? end : box.frequency_min * std::pow(end / box.frequency_min, double(i) / initial);
  };
  if (end > box.frequency_min)
    for (int i = initial; i-- > 0;) cells.push_back({grid(i), grid(i + 1)});
  for (long tests = 0; !cells.empty(); ++tests) {
    const Interval w = cells.back();
    cells.pop_back();
    if (tests < most_tests && excluded(w, gains, circle)) continue;
    const double middle = middle_of(w), width = w.high / w.low - 1.0;
    const bool hopeless = width < 2e-3 && (width < 1e-6 || !excluded({middle, middle}, gains, circle));
    if (tests >= most_tests || hopeless) {
      if (!open.empty() && open.back().high >= w.low)
        open.back().high = w.high;
      else
        open.push_back(w);
      continue;
    }
    cells.push_back({middle, w.high});
    cells.push_back({w.low, middle});
  }
  answer.undecided = open;
  if (open.empty()) {
    answer.verdict = BandVerdict::proved;
    answer.why =
        circle <= box.frequency_min
            ? "no half-wave symmetric oscillation is possible, since the incremental circle criterion holds from " +
                  short_number(box.frequency_min) + " rad/s on"
            : "no half-wave symmetric oscillation is possible, since no error disc meets -Psi";
  } else {
    answer.why = "a half-wave symmetric oscillation is not excluded between " + short_number(open.front().low) +
                 " and " + short_number(open.back().high) + " rad/s" +
                 (open.size() > 1 ? " (in " + std::to_string(open.size()) + " intervals)" : "");
  }
  return answer;
}

}  // namespace limcycle
