#include "limcycle/analysis/orbit/branch/branch_end.hpp"

#include <cmath>
#include <limits>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Elements that switch, in order, in one period from `start`.
std::optional<std::vector<std::size_t>> switches(const Loop& loop, const LoopState& start, double period) {
  std::vector<std::size_t> order;
  LoopField field(loop);
  if (field.size() != start.x.size()) return std::nullopt;
  field.modes() = start.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-9));
  march.begin(start.x, 0.0);
  while (march.t() < period) {
    if (march.steps() > 100000 || march.step(period) != Status::converged) return std::nullopt;
    if (march.last().switched) order.push_back(*march.last().switched);
  }
  return order;
}

struct Line {
  double p, previous;
};

/// Zero of the line through the first two points, and through the second and the third.
Line zero(const std::vector<std::pair<double, double>>& last, double power) {
  const auto between = [&](std::size_t i) {
    const auto [p0, v0] = last[i];
    const auto [p1, v1] = last[i + 1];
    const double a = std::pow(v0, power), b = std::pow(v1, power);
    return p0 - a * (p0 - p1) / (a - b);
  };
  return {between(0), between(1)};
}

/// p* of p = p* + a exp(-b T) through three points (p, 1/T) of falling T, by bisection for b.
double exponential_limit(const std::pair<double, double>* points) {
  const double p0 = points[0].first, T0 = 1.0 / points[0].second, to_next = points[1].first - p0,
               to_last = points[2].first - p0;
  // The share of p falls from the share of the T to 0 as b grows.
  const double near = T0 - 1.0 / points[1].second, far = T0 - 1.0 / points[2].second, share = to_next / to_last;
  const auto of = [&](double b) { return std::expm1(b * near) / std::expm1(b * far); };
  double low = 1e-9 / far, high = 700.0 / far;
  if (!(of(low) > share && of(high) < share)) return unknown;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double b = 0.5 * (low + high);
    (of(b) > share ? low : high) = b;
  }
  return p0 - to_last / std::expm1(0.5 * (low + high) * far);
}

/// The last point and up to three before it, apart by a factor of 1.3 or more: neighbours after tiny steps carry no
/// information.
std::vector<std::pair<double, double>> history(const EndEvidence& evidence, double (*value)(const Cycle&)) {
  std::vector<std::pair<double, double>> list;
  for (const BranchPoint* point : evidence.last) {
    const double here = value(point->cycle);
    if (list.empty() || here > 1.3 * list.back().second) list.emplace_back(point->parameter, here);
    if (list.size() == 4) break;
  }
  return list;
}

double amplitude_of(const Cycle& cycle) { return cycle.amplitude; }
double rate_of(const Cycle& cycle) { return 1.0 / cycle.period; }
double smallness_of(const Cycle& cycle) { return 1.0 / cycle.amplitude; }

/// A zero counts if it lies ahead, and no farther than a few of the last steps, or than a part in 1e3 of the parameter.
std::optional<Vanishing> zero_ahead(const EndEvidence& evidence, double (*value)(const Cycle&), const auto& law) {
  const auto list = history(evidence, value);
  const auto found = law(list);
  if (!found) return std::nullopt;
  const double step = list[0].first - list[1].first, ahead = found->parameter - list[0].first;
  const bool near = std::abs(ahead) < 30.0 * std::abs(step) || std::abs(ahead) < 1e-3 * std::abs(list[0].first);
  return ahead * step >= 0.0 && near ? found : std::nullopt;
}

double relative(double error, double parameter) { return parameter != 0.0 ? error / std::abs(parameter) : error; }

std::optional<EndDiagnosis> faded(const EndEvidence& evidence) {
  const Cycle& cycle = evidence.last.front()->cycle;
  const bool small = cycle.amplitude < 0.02 * evidence.largest_amplitude;
  const bool large = cycle.amplitude > 100.0 * evidence.first_amplitude;
  const bool slow = cycle.period > 30.0 * evidence.shortest_period;
  if (!small && !large && !slow) return std::nullopt;
  const auto at = small || large ? zero_ahead(evidence, small ? amplitude_of : smallness_of, vanishing)
                                 : zero_ahead(evidence, rate_of, slowing);
  if (!at) return std::nullopt;
  EndDiagnosis end{at->parameter, relative(at->error, at->parameter), "", true};
  const std::string place = short_number(at->parameter, 6);
  if (small)
    end.why = "the amplitude falls to zero: the cycle shrinks into rest at " + place;
  else if (large)
    end.why = "the amplitude grows without bound towards " + place;
  else
    end.why = "the period grows without bound towards " + place;
  if (small && slow) end.why += ", while its period grows without bound";
  if (slow && cycle.sticking_fraction > 0.5) end.why += ": it sticks longer and longer";
  return end;
}

std::string by_status(const EndEvidence& evidence) {
  switch (evidence.failure) {
    case Status::chattering:
      return "switches accumulate (chattering): the motion cannot be carried past them";
    case Status::max_iterations:
      return "the motion no longer comes back to where it started within the step budget";
    case Status::not_finite:
      return "the state leaves the range of numbers: the motion from there diverges";
    case Status::interrupted:
      return "interrupted";
    default:
      return "";
  }
}

/// Explains the end if the orbit just beyond it switches in another order.
std::string by_switches(BranchMap& map, const BranchSpot& spot, double direction) {
  const auto here = map.loop(spot.s());
  const auto order = switches(*here, spot.value.start, spot.cycle.period);
  if (!order) return "";
  for (const double step : {1e-3, 1e-2, 3e-2}) {
    const auto beyond = map.loop(spot.s() + direction * step);
    if (!beyond) return "";
    const auto next = switches(*beyond, spot.value.start, spot.cycle.period);
    if (!next) return "the motion just beyond cannot be carried through one period";
    if (*next == *order) continue;
    if (next->empty() && !order->empty())
      return "just beyond, the motion no longer switches" +
             std::string(spot.cycle.sticking_fraction > 0.0 ? " or sticks" : "");
    return "the order of switches changes there (" + std::to_string(order->size()) + " in a period before, " +
           std::to_string(next->size()) +
           " just beyond): a grazing or a lost stick, and no cycle that continues this "
           "one was found";
  }
  return "";
}

}  // namespace

std::optional<Vanishing> vanishing(const std::vector<std::pair<double, double>>& last) {
  if (last.size() < 3 || !(last[0].second < last[1].second) || !(last[1].second < last[2].second)) return std::nullopt;
  const Line straight = zero(last, 1.0), squared = zero(last, 2.0);
  const auto spread = [](const Line& line) { return std::abs(line.p - line.previous); };
  const Line& better = spread(straight) <= spread(squared) ? straight : squared;
  if (!std::isfinite(better.p) || !std::isfinite(better.previous)) return std::nullopt;
  return Vanishing{better.p, spread(better) + 1e-3 * std::abs(better.p - last[0].first)};
}

std::optional<Vanishing> slowing(const std::vector<std::pair<double, double>>& last) {
  const auto by_rate = vanishing(last);
  if (!by_rate || last.size() < 4) return by_rate;
  const double here = exponential_limit(last.data()), before = exponential_limit(last.data() + 1);
  const double error = std::abs(here - before) + 1e-3 * std::abs(here - last[0].first);
  return std::isfinite(error) && error < by_rate->error ? Vanishing{here, error} : by_rate;
}

EndDiagnosis diagnose_end(BranchMap& map, const BranchSpot& spot, const EndEvidence& evidence) {
  if (auto end = faded(evidence)) return *end;
  EndDiagnosis end;
  end.parameter = evidence.last.front()->parameter;
  end.error = unknown;
  end.understood = true;
  if (evidence.on_purpose) {
    const double largest = spot.multipliers.empty() ? 0.0 : std::abs(spot.multipliers.front());
    end.why = largest > 100.0 ? "the cycle is so unstable (multiplier " + short_number(largest, 6) +
                                    ") that its branch could only be followed in ever smaller steps"
                              : "the orbit has become too small, too large or too slow to be followed";
    return end;
  }
  if (evidence.invalid) {
    const bool structure = map.loop(spot.s() + evidence.direction * 1e-6 * ParameterScale::length) != nullptr;
    end.why = structure ? "beyond it the loop has another number of states, or is no longer symmetric"
                        : "beyond it the case is not valid";
    return end;
  }
  end.why = by_status(evidence);
  if (end.why.empty()) end.why = by_switches(map, spot, evidence.direction);
  if (end.why.empty()) {
    end.understood = false;
    end.why =
        "the branch could not be followed any farther (the corrector does not converge even for the smallest "
        "step), and the reason was not recognised";
  }
  return end;
}

}  // namespace limcycle
