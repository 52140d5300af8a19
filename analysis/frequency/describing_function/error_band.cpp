#include "limcycle/analysis/frequency/describing_function/error_band.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr long most_blocks = 20000;  ///< of harmonics; beyond: taken as not filtered
constexpr long most_cells = 200000;

Interval at(double w) { return {w, w}; }

}  // namespace

std::string_view to_string(BandVerdict verdict) { return verdict == BandVerdict::proved ? "proved" : "undecided"; }

std::optional<std::string> ErrorBand::not_applicable(const Loop& loop) {
  if (loop.elements.size() != 1) return "the theorem is for one nonlinear element";
  const Element& element = loop.elements[0];
  const auto slopes = element.slope_bounds();
  if (!slopes || !element.odd()) return "the theorem needs a memoryless, odd element with bounded slopes";
  if (const auto [alpha, beta] = *slopes; alpha > 0.0 || beta < 0.0)
    return "the slopes of the element exclude 0, so that poles of G on the imaginary axis would go unnoticed";
  if (!loop.measured.empty()) return "the theorem needs a rational G, and this one is measured";
  if (loop.delay > 0.0) return "the theorem needs a rational G, without delay";
  if (!loop.ports[0].D.isZero(0.0)) return "the theorem needs a strictly proper G";
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  const double input = (loop.ports[0].C * rest + loop.ports[0].c * loop.external).value();
  if (!exact || std::abs(input) > 1e-12) return "the theorem needs a loop without bias";
  if (!RationalResponse::of(loop)) return "the polynomials of G cannot be computed accurately";
  return std::nullopt;
}

ErrorBand::ErrorBand(const Loop& loop)
    : element_([&loop] {
        if (const auto why = not_applicable(loop)) throw std::invalid_argument("error band: " + *why);
        return loop.elements[0];
      }()),
      response_(*RationalResponse::of(loop)) {
  const auto [alpha, beta] = *element_.slope_bounds();
  centre_ = 0.5 * (alpha + beta);
  gamma_ = 0.5 * (beta - alpha);
}

/// Orders are taken one by one where the infimum may lie, and in blocks where a bound over the whole block of
/// frequencies shows that it does not.
double ErrorBand::rho(Interval w) const {
  double least = infinite, first = 3.0, count = 1.0;
  for (long i = 0; i < most_blocks; ++i) {
    if (response_.growth(first * w.low) - std::abs(centre_) >= least) return least;
    const double last = first + 2.0 * (count - 1.0);
    const double bound = response_.distance(centre_, {first * w.low, last * w.high});
    if (count > 1.0 && bound < least) {
      count = std::floor(0.5 * count);
      continue;
    }
    least = std::min(least, bound);
    if (least <= gamma_) return least;  // not filtered; the margin does not matter
    first = last + 2.0;
    count *= 2.0;
  }
  return 0.0;
}

double ErrorBand::sigma(Interval w) const {
  const double rho_least = rho(w);
  return rho_least > gamma_ ? gamma_ * gamma_ / (rho_least - gamma_) : infinite;
}

double ErrorBand::gain(double amplitude) const {
  const auto exact = element_.exact_describing_function(amplitude, 1.0, 0.0);
  if (exact) return exact->real();
  DfOptions options;
  options.harmonics = 1;
  options.accuracy = 1e-12;
  return describing_function(element_, {amplitude, 1.0, 0.0}, options).gain.real();
}

/// First frequency away from the root at which the imaginary part alone exceeds the disc; empty if the band meets
/// frequencies that are not filtered before, or has no such end within a factor of 100.
std::optional<double> ErrorBand::edge_frequency(double inside, double direction) const {
  const auto outside_of_band = [this](double w) { return std::abs(response_.inverse(w).imag()) > sigma(at(w)); };
  const double last = inside * std::pow(100.0, direction);
  for (double step = 1e-6; direction * (last - inside) > 0.0; step = std::min(1.2 * step, 0.01)) {
    double outside = inside * std::exp(direction * step);
    if (!filtered(outside)) return std::nullopt;
    if (outside_of_band(outside)) {
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + outside);
        (outside_of_band(middle) ? outside : inside) = middle;
      }
      return outside;
    }
    inside = outside;
  }
  return std::nullopt;
}

/// Upper bound, to 1e-7 beta, of sign times the gains whose points -Psi lie in a disc of the interval (Psi between
/// -Re 1/G +- sqrt(sigma^2 - Im^2 1/G)); by branch and bound. Empty where a frequency in it is not filtered.
std::optional<double> ErrorBand::highest(Interval frequency, double sign) const {
  const auto bound = [&](Interval w) {
    const auto q = response_.inverse(w);
    const double reach = sigma(w), imaginary = std::max(0.0, std::abs(q.centre.imag()) - q.radius);
    if (!std::isfinite(reach) || !std::isfinite(q.radius)) return infinite;
    if (imaginary > reach) return -infinite;  // no point of the axis within reach
    return -sign * q.centre.real() + q.radius + std::sqrt((reach - imaginary) * (reach + imaginary));
  };
  struct Cell {
    double bound;
    Interval w;
    bool operator<(const Cell& other) const { return bound < other.bound; }
  };
  std::priority_queue<Cell> cells;
  double best = -infinite;
  const auto add = [&](Interval w) {
    best = std::max(best, bound(at(0.5 * (w.low + w.high))));
    cells.push({bound(w), w});
  };
  const double tolerance = 1e-7 * std::max(std::abs(alpha()), std::abs(beta()));
  add(frequency);
  for (long i = 0; i < most_cells; ++i) {
    const Cell top = cells.top();
    if (top.bound <= best + tolerance) return top.bound;
    const double middle = 0.5 * (top.w.low + top.w.high);
    if (top.w.high - top.w.low < 1e-13 * middle) return std::nullopt;
    cells.pop();
    add({top.w.low, middle});
    add({middle, top.w.high});
  }
  return std::nullopt;
}

std::optional<Interval> ErrorBand::gains(Interval frequency) const {
  const auto high = highest(frequency, 1.0), low = highest(frequency, -1.0);
  if (!high || !low) return std::nullopt;
  return Interval{-*low, *high};
}

/// First amplitude away from the root whose gain is outside the interval; empty if there is none within 1e9.
std::optional<double> ErrorBand::edge_amplitude(double inside, double direction, Interval gains) const {
  const auto is_outside = [&](double a) {
    const double psi = gain(a);
    return psi < gains.low || psi > gains.high;
  };
  const double last = inside * std::pow(1e9, direction);
  for (double step = 1e-6; direction * (last - inside) > 0.0; step = std::min(1.2 * step, 0.1)) {
    double outside = inside * std::exp(direction * step);
    if (is_outside(outside)) {
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + outside);
        (is_outside(middle) ? outside : inside) = middle;
      }
      return outside;
    }
    inside = outside;
  }
  return std::nullopt;
}

Existence ErrorBand::existence(double frequency, double amplitude) const {
  Existence answer;
  const auto undecided = [&answer](std::string why) {
    answer.why = std::move(why);
    return answer;
  };
  if (!filtered(frequency))
    return undecided("the loop does not filter enough at " + short_number(frequency) +
                     " rad/s for a proof: rho is at most " + short_number(rho(frequency)) +
                     ", half the range of slopes is " + short_number(gamma_));
  if (!(std::abs(response_.inverse(frequency) + gain(amplitude)) <= sigma(frequency)))
    return undecided("the point is no root of the describing function");
  const auto low = edge_frequency(frequency, -1.0), high = edge_frequency(frequency, 1.0);
  if (!low || !high) return undecided("the band of error discs reaches frequencies at which the loop does not filter");
  const Interval w{*low, *high};
  if ((response_.inverse(w.low).imag() > 0.0) == (response_.inverse(w.high).imag() > 0.0))
    return undecided("the band of error discs touches -Psi without crossing it");
  const auto psi = gains(w);
  if (!psi) return undecided("the band of error discs reaches frequencies at which the loop does not filter");
  const auto least = edge_amplitude(amplitude, -1.0, *psi), most = edge_amplitude(amplitude, 1.0, *psi);
  if (!least || !most)
    return undecided(std::string("-Psi does not cross the band of error discs completely: it stays inside towards ") +
                     (least ? "large" : "small") + " amplitudes");
  if ((gain(*least) > psi->high) == (gain(*most) > psi->high))
    return undecided("-Psi turns back inside the band of error discs");
  answer.verdict = BandVerdict::proved;
  answer.frequency = w;
  answer.amplitude = {*least, *most};
  answer.why = "the error discs are crossed completely between " + short_number(w.low) + " and " +
               short_number(w.high) + " rad/s and input amplitudes " + short_number(*least) + " and " +
               short_number(*most);
  return answer;
}

}  // namespace limcycle
