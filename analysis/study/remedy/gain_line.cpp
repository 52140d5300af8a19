#include "limcycle/analysis/study/remedy/gain_line.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "limcycle/analysis/study/remedy/linear_costs.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

/// L of the loop with these two gains.
std::optional<OpenLoop> with_gains(LoopParts parts, double kp, double kd) {
  auto& pid = std::get<Pid>(parts.controller);
  pid.kp = kp;
  pid.kd = kd;
  std::string why;
  return open_loop(parts, why);
}

struct At {
  double w, value;
};

/// Zero of f between two points of unlike sign, to rounding: the Illinois form of regula falsi.
double zero_between(const std::function<double(double)>& f, At a, At b) {
  constexpr int most_rounds = 100;
  for (int i = 0; i < most_rounds && b.value != 0.0 && std::abs(a.w - b.w) > 4e-16 * b.w; ++i) {
    const double w = (a.w * b.value - b.w * a.value) / (b.value - a.value), value = f(w);
    if (value * b.value < 0.0)
      a = b;
    else
      a.value *= 0.5;
    b = {w, value};
  }
  return b.w;
}

/// Roots of a x^2 + 2 b x + c = 0, the smaller first; empty without real ones.
std::optional<std::pair<double, double>> real_roots(double a, double b, double c) {
  const double under = b * b - a * c;
  if (!(under >= 0.0) || a == 0.0) return std::nullopt;
  const double q = -(b + std::copysign(std::sqrt(under), b)), one = q / a, other = q != 0.0 ? c / q : one;
  return std::pair(std::min(one, other), std::max(one, other));
}

}  // namespace

std::optional<GainLine> GainLine::of(const LoopParts& parts, Keeps keeps) {
  const auto* pid = std::get_if<Pid>(&parts.controller);
  if (pid == nullptr || !(pid->kp > 0.0) || !(pid->kd > 0.0)) return std::nullopt;
  const auto rest = with_gains(parts, 0.0, 0.0), one_kp = with_gains(parts, 1.0, 0.0),
             one_kd = with_gains(parts, 0.0, 1.0);
  const auto crossover = highest_crossover(parts);
  if (!rest || !one_kp || !one_kd || !crossover) return std::nullopt;
  const auto at = [](const OpenLoop& open) { return [L = open.L](double w) { return L(Complex(0.0, w)); }; };
  const auto beyond_rest = [&](const OpenLoop& open) {
    return [L = open.L, base = rest->L](double w) { return L(Complex(0.0, w)) - base(Complex(0.0, w)); };
  };
  GainLine line(at(*rest), beyond_rest(*one_kp), beyond_rest(*one_kd), keeps);
  line.crossover_ = *crossover;
  const Complex L = line.rest_(*crossover) + pid->kp * line.by_kp_(*crossover) + pid->kd * line.by_kd_(*crossover);
  line.phase_margin_ = std::arg(-L);
  if (keeps == Keeps::bandwidth) {
    line.larger_root_ = true;
    const auto larger = line.kd_for_bandwidth(pid->kp);
    line.larger_root_ = larger && std::abs(*larger - pid->kd) <= 1e-6 * pid->kd;
  }
  const auto own = line.kd(pid->kp);
  if (!own || std::abs(*own - pid->kd) > 1e-6 * pid->kd) return std::nullopt;
  return line;
}

std::optional<double> GainLine::kd(double kp) const {
  const auto found = keeps_ == Keeps::bandwidth ? kd_for_bandwidth(kp) : kd_for_phase_margin(kp);
  return found && *found >= 0.0 && std::isfinite(*found) ? found : std::nullopt;
}

std::optional<double> GainLine::kd_for_bandwidth(double kp) const {
  const Complex a = rest_(crossover_) + kp * by_kp_(crossover_), b = by_kd_(crossover_);
  const auto roots = real_roots(std::norm(b), (a * std::conj(b)).real(), std::norm(a) - 1.0);
  if (!roots) return std::nullopt;
  return larger_root_ ? roots->second : roots->first;
}

/// kd as the real part; the imaginary part is zero where L has the phase margin.
Complex GainLine::kd_and_fault(double kp, double w) const {
  return -(rest_(w) + kp * by_kp_(w) + std::polar(1.0, phase_margin_)) / by_kd_(w);
}

std::optional<double> GainLine::kd_for_phase_margin(double kp) const {
  constexpr double factor = 1.1;
  constexpr int most = 150;  // a factor of a million either way
  const auto fault = [&](double w) { return kd_and_fault(kp, w).imag(); };
  const double middle = fault(crossover_);
  if (std::abs(middle) <= 1e-12 * std::abs(kd_and_fault(kp, crossover_))) return kd_and_fault(kp, crossover_).real();
  double w[2] = {crossover_, crossover_}, value[2] = {middle, middle};
  for (int i = 0; i < most; ++i)
    for (const int side : {0, 1}) {
      const double next = side == 0 ? w[0] * factor : w[1] / factor, now = fault(next);
      if (now * value[side] <= 0.0) {
        return kd_and_fault(kp, zero_between(fault, {w[side], value[side]}, {next, now})).real();
      }
      w[side] = next;
      value[side] = now;
    }
  return std::nullopt;
}

}  // namespace limcycle
