#include "limcycle/analysis/study/margin_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/cycle_search.hpp"
#include "limcycle/analysis/study/output_per_input.hpp"

namespace limcycle {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double beyond = 1e-2;    ///< how far past a lost cycle, relative, one looks whether the loop still hunts
constexpr double at_limit = 1e-9;  ///< relative: the scale of a branch is logarithmic
constexpr int successors = 3;      ///< other cycles that are followed in turn

}  // namespace

SideSearch::SideSearch(const MarginParameter& parameter, bool up, const MarginOptions& options,
                       std::function<void(double)> progress)
    : parameter_(parameter),
      options_(options),
      progress_(std::move(progress)),
      limit_(up ? parameter.value * options.factor : parameter.value / options.factor) {}

SideSearch::Lost SideSearch::follow(const Cycle& cycle, double p, double limit) {
  ContinuationOptions continuing;
  continuing.from = p;
  continuing.to = limit;
  continuing.downwards = false;
  continuing.until_event = true;
  continuing.accuracy = options_.accuracy;
  continuing.first_step = 0.1;
  continuing.max_step = 0.6;
  continuing.max_points = 150;
  continuing.stop = options_.predict.stop;
  continuing.progress = progress_;
  const Branch branch = continue_cycle(parameter_.family, cycle, p, continuing);
  if (branch.points.empty() || branch.events.empty())
    return {p, unknown, branch.why.empty() ? "the cycle could not be followed" : branch.why, Lost::Kind::failed,
            cycle.start};
  LoopState last = cycle.start;
  for (const auto& point : branch.points)
    if (point.cycle.stable == true) last = point.cycle.start;
  const BranchEvent& event = branch.events.back();
  const bool reached = event.type == BranchEvent::Type::end && std::abs(event.parameter / limit - 1.0) < at_limit;
  const bool cut = branch.status == Status::max_iterations || branch.status == Status::interrupted;
  return {event.parameter,
          event.error,
          event.why,
          reached ? Lost::Kind::border
          : cut   ? Lost::Kind::failed
                  : Lost::Kind::lost,
          std::move(last),
          event.type == BranchEvent::Type::end ? std::nullopt : std::optional(event.type),
          event.type == BranchEvent::Type::end ? std::nullopt : std::optional(branch.points.at(event.point).cycle)};
}

MarginSide SideSearch::found(MarginSide::What what, const Lost& lost, std::string why) {
  return {what, lost.value, lost.error, std::move(why), lost.event, lost.cycle};
}

std::optional<Cycle> SideSearch::cycle_at(double p, const LoopState* from, Outcome& outcome) {
  const auto loop = parameter_.family(p);
  outcome = Outcome::undecided;
  if (!loop) return std::nullopt;
  const SearchBox box = default_search_box(*loop);
  const double widest = output_per_input(*loop) * box.amplitude_max;
  const SettleOptions settling = cycle_search(*loop, box, options_.accuracy, options_.predict.stop);
  std::vector<LoopState> starts;
  const LoopState rest = displaced(*loop, widest);
  if (from && from->x.size() == rest.x.size()) starts.push_back(*from);
  starts.push_back(rest);
  starts.push_back(displaced(*loop, 0.01 * widest));
  for (const LoopState& start : starts) {
    auto settled = settle(*loop, start, settling);
    if (settled.shot && settled.shot->cycle.stable == true) {
      outcome = Outcome::cycle;
      return std::move(settled.shot->cycle);
    }
    // What goes on for ever in another way has not ended.
    const bool persists = settled.outcome == Outcome::family || settled.outcome == Outcome::irregular;
    if (outcome == Outcome::undecided && !persists) outcome = settled.outcome;
    if (settled.outcome == Outcome::divergence || stopped()) break;
  }
  return std::nullopt;
}

MarginSide SideSearch::where_hunting_ends(const std::vector<Cycle>& cycles) {
  using What = MarginSide::What;
  const auto stable = std::ranges::find(cycles, std::optional<bool>(true), &Cycle::stable);
  Cycle cycle = *stable;
  double p = parameter_.value;
  for (int i = 0; i <= successors; ++i) {
    const Lost lost = follow(cycle, p, limit_);
    if (lost.kind == Lost::Kind::border)
      return {What::none, 0.0, 0.0, "it hunts all the way to " + short_number(limit_, 5)};
    if (lost.kind == Lost::Kind::failed) return {What::unknown, 0.0, unknown, lost.why};
    const double step = limit_ > p ? beyond : -beyond;
    double next = lost.value * (1.0 + (parameter_.value > 0.0 ? step : -step));
    if (std::abs(std::log(next / parameter_.value)) > std::abs(std::log(limit_ / parameter_.value))) next = limit_;
    if (!parameter_.family(next)) return found(What::ends, lost, lost.why);
    Outcome outcome{};
    auto other = cycle_at(next, &lost.last, outcome);
    if (stopped()) break;
    if (!other) {
      if (outcome != Outcome::undecided) {
        const std::string after = outcome == Outcome::divergence
                                      ? "; beyond it the motion diverges"
                                      : "; beyond it the motion ends in " + std::string(to_string(outcome));
        MarginSide side = found(What::ends, lost, lost.why + after);
        side.diverges = outcome == Outcome::divergence;
        return side;
      }
      if (!lost.event && std::isnan(lost.error))  // neither side of the end is understood
        return {What::unknown, 0.0, unknown,
                "the cycle was lost near " + short_number(lost.value, 5) + ": " + lost.why +
                    "; what the motion does just beyond was not decided"};
      return found(What::ends, lost, lost.why + "; what the motion does just beyond was not decided");
    }
    cycle = std::move(*other);
    p = next;
  }
  return {What::unknown, 0.0, unknown,
          "one cycle takes over from the next; the last was lost near " + short_number(p, 5)};
}

MarginSide SideSearch::where_hunting_begins() {
  using What = MarginSide::What;
  const int steps = std::max(1, static_cast<int>(std::ceil(options_.scan_per_decade * std::log10(options_.factor))));
  double last = parameter_.value;
  for (int i = 1; i <= steps && !stopped(); ++i) {
    const double p = parameter_.value * std::pow(limit_ / parameter_.value, static_cast<double>(i) / steps);
    if (progress_) progress_(static_cast<double>(i) / (steps + 1));
    if (!parameter_.family(p))
      return {What::none, 0.0, 0.0,
              "none up to " + short_number(last, 5) + "; the case is not valid at " + short_number(p, 5)};
    Outcome outcome{};
    const auto cycle = cycle_at(p, nullptr, outcome);
    if (outcome == Outcome::divergence)
      return {What::none, 0.0, 0.0,
              "none up to " + short_number(last, 5) + "; at " + short_number(p, 5) + " the motion diverges"};
    if (cycle) {
      const Lost lost = follow(*cycle, p, parameter_.value);
      if (lost.kind == Lost::Kind::lost) return found(What::begins, lost, lost.why);
      if (lost.kind == Lost::Kind::border)
        return {What::begins, parameter_.value, 0.0,
                "the cycle found at " + short_number(p, 5) +
                    " reaches back to the parameter's own value: the loop hunts there "
                    "from starts that were not tried"};
      return {What::begins, p, unknown,
              "it hunts at " + short_number(p, 5) + "; where that begins could not be followed: " + lost.why};
    }
    last = p;
  }
  return {What::none, 0.0, 0.0, "it does not hunt up to " + short_number(last, 5)};
}

}  // namespace limcycle
