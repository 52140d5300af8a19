#include "limcycle/analysis/study/continuation/one_sided_margin.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "limcycle/analysis/orbit/settle/stop_map.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"

namespace limcycle {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
/// Relative distances past a lost cycle at which simulations decide if the loop still hunts: farther if they do not
/// decide, as close to a pitchfork, where the succeeding cycles are reached slowly.
constexpr double beyond_lost[] = {1e-2, 3e-2, 0.1};
constexpr double at_limit = 1e-9;  ///< relative: the scale of a branch is logarithmic
constexpr int successors = 3;      ///< largest number of other cycles followed in turn

}  // namespace

OneSidedMargin::OneSidedMargin(const MarginParameter& parameter, bool up, const MarginOptions& options,
                               std::function<void(double)> progress)
    : parameter_(parameter),
      options_(options),
      progress_(std::move(progress)),
      limit_(up ? parameter.value * options.factor : parameter.value / options.factor) {}

OneSidedMargin::Lost OneSidedMargin::follow(const Cycle& cycle, double p, double limit) {
  ContinuationOptions continuing;
  continuing.from = p;
  continuing.to = limit;
  continuing.downwards = false;
  continuing.until_event = true;
  continuing.accuracy = options_.accuracy;
  continuing.first_step = 0.1;
  continuing.max_step = 0.6;
  continuing.max_points = 150;
  continuing.max_steps = options_.steps_a_branch;
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

MarginSide OneSidedMargin::found(MarginSide::What what, const Lost& lost, std::string why) {
  return {what, lost.value, lost.error, std::move(why), lost.event, lost.cycle};
}

OneSidedMargin::Reached OneSidedMargin::reached_at(double p, const std::vector<LoopState>& from) {
  const auto loop = parameter_.family(p);
  if (!loop) return {};
  const SearchBox box = default_search_box(*loop);
  const double widest = output_per_input(*loop) * box.amplitude_max;
  const SettleOptions settling = cycle_search(*loop, box, options_.accuracy, options_.predict.stop);
  std::vector<LoopState> starts{displaced(*loop, widest), displaced(*loop, 0.01 * widest)};
  std::ranges::copy_if(from, std::inserter(starts, starts.begin()),
                       [&](const LoopState& state) { return state.x.size() == starts.back().x.size(); });
  Reached reached;
  bool open = false;
  for (const LoopState& start : starts) {
    auto settled = settle(*loop, start, settling);
    if (settled.shot && settled.shot->cycle.stable == true) return {std::move(settled.shot->cycle), Outcome::cycle};
    if (stopped()) return {};
    // A motion that continues for ever in another way has not ended.
    const bool ended = settled.outcome == Outcome::rest || settled.outcome == Outcome::sliding ||
                       settled.outcome == Outcome::divergence;
    open = open || !ended;
    reached.irregular = reached.irregular || settled.outcome == Outcome::irregular;
    if (ended && reached.outcome == Outcome::undecided) reached.outcome = settled.outcome;
    if (settled.outcome == Outcome::divergence && from.empty()) return reached;
  }
  if (open) reached.outcome = Outcome::undecided;
  // A cycle that is nearly lost attracts from so near that only the map from stop to stop finds it.
  auto map = from.empty() || open ? std::nullopt : StopMap::of(*loop, settling.rtol, options_.predict.stop);
  if (!map) return reached;
  for (const double place : map->growing(widest * box.amplitude_min / box.amplitude_max, widest)) {
    auto settled = settle(*loop, map->held_at(place), settling);
    if (settled.shot && settled.shot->cycle.stable == true) return {std::move(settled.shot->cycle), Outcome::cycle};
  }
  return reached;
}

MarginSide OneSidedMargin::beyond(const Lost& lost, std::optional<Cycle>& other, double& at) {
  using What = MarginSide::What;
  std::vector<LoopState> starts{lost.last};
  std::ranges::copy(starts_, std::back_inserter(starts));
  const double outwards = std::abs(limit_) > std::abs(parameter_.value) ? 1.0 : -1.0;
  for (const double reach : beyond_lost) {
    double next = lost.value * (1.0 + outwards * reach);
    if (std::abs(std::log(next / parameter_.value)) > std::abs(std::log(limit_ / parameter_.value))) next = limit_;
    const bool first = reach == beyond_lost[0];
    if (!parameter_.family(next)) {
      if (first) return at_validity(lost);
      break;
    }
    Reached reached = reached_at(next, starts);
    if (reached.cycle) {
      other = std::move(reached.cycle);
      at = next;
      return {};
    }
    if (stopped()) return {};
    if (reached.outcome != Outcome::undecided) {
      const bool diverges = reached.outcome == Outcome::divergence;
      const std::string after =
          diverges ? " the motion diverges" : " the motion ends in " + std::string(to_string(reached.outcome));
      const std::string where = first && !diverges ? "; beyond it" : "; at " + short_number(next, 5);
      MarginSide side = found(What::ends, lost, lost.why + where + after);
      side.diverges = diverges;
      if (diverges) side.diverges_at = next;
      // Where the branch turns back there is no such cycle beyond.
      if (first && std::isnan(lost.error)) return with_error(std::move(side), next, starts);
      if (first || lost.event == BranchEvent::Type::fold) return side;
      side.why = "the cycle is lost at " + short_number(lost.value, 5) + ": " + lost.why + "; at " +
                 short_number(next, 5) + after + "; the motion between the two was not determined";
      side.value = next;
      side.error = unknown;
      return side;
    }
    if (next == limit_) break;
  }
  // Where the branch turns back there is no such cycle beyond; one that loses its symmetry or its stability may
  // continue as another.
  if (lost.event == BranchEvent::Type::fold)
    return found(What::ends, lost, lost.why + "; whether the loop hunts on another cycle beyond it was not determined");
  return {What::unknown, lost.value, unknown,
          "the cycle is lost at " + short_number(lost.value, 5) + ": " + lost.why +
              "; whether the loop hunts beyond it was not determined"};
}

/// An end that no equation locates, beyond which at `ended` the loop hunts no more: where simulations show it at a
/// thousandth beyond it, that bounds its error; else by bisection.
MarginSide OneSidedMargin::with_error(MarginSide side, double ended, const std::vector<LoopState>& from) {
  constexpr double close = 1e-3;
  const double next = side.value * std::pow(ended / side.value, close / std::abs(std::log(ended / side.value)));
  const Reached reached = reached_at(next, from);
  if (stopped()) return {};
  if (reached.cycle || reached.irregular) return by_bisection(side.what, next, ended, from);
  if (reached.outcome != Outcome::undecided) side.error = close;
  return side;
}

/// What a simulation at p from this state comes to; undecided if the case is not valid there.
Outcome OneSidedMargin::outcome_from(const LoopState& state, double p) const {
  const auto loop = parameter_.family(p);
  if (!loop) return Outcome::undecided;
  return settle(*loop, state, cycle_search(*loop, default_search_box(*loop), options_.accuracy, options_.predict.stop))
      .outcome;
}

/// True unless a simulation from this state at the limit is known to end elsewhere than in a cycle.
bool OneSidedMargin::stays(const LoopState& state) const {
  const Outcome outcome = outcome_from(state, limit_);
  return outcome != Outcome::rest && outcome != Outcome::sliding && outcome != Outcome::divergence;
}

/// The side of a branch beyond whose end the case is not valid: the cycle ends there (as where Fs comes down to Fc), or
/// it is there to the last.
MarginSide OneSidedMargin::at_validity(const Lost& lost) const {
  constexpr double hair = 1e-6;
  const double inwards = lost.value + hair * (parameter_.value - lost.value);
  const double last = parameter_.family(lost.value) ? lost.value : inwards;
  const Outcome outcome = outcome_from(lost.last, last);
  if (outcome != Outcome::cycle && outcome != Outcome::irregular) return found(MarginSide::What::ends, lost, lost.why);
  return {MarginSide::What::none, lost.value, 0.0,
          "it hunts all the way to " + short_number(lost.value, 5) + ", beyond which the case is not valid"};
}

/// Where simulations cease to come to a cycle or to a motion without a period, between one value at which they do and
/// another at which they do not. For a branch that a step left across its end, as where a relay just fails to switch,
/// and for one whose end tells nothing about what is stable there.
MarginSide OneSidedMargin::by_bisection(MarginSide::What what, double hunts, double rests,
                                        const std::vector<LoopState>& from) {
  constexpr double narrow = 1e-3;
  while (std::abs(std::log(rests / hunts)) > narrow && !stopped()) {
    const double middle = hunts * std::sqrt(rests / hunts);
    const Reached reached = reached_at(middle, from);
    (reached.cycle || reached.irregular ? hunts : rests) = middle;
  }
  if (stopped()) return {};
  const std::string side = what == MarginSide::What::ends ? "no longer come" : "come";
  return {what,
          rests,
          std::abs(rests / hunts - 1.0),
          "by bisection of the outcome: simulations " + side + " to a cycle or to a motion without a period",
          std::nullopt,
          std::nullopt};
}

MarginSide OneSidedMargin::where_hunting_ends(const std::vector<Cycle>& cycles) {
  using What = MarginSide::What;
  starts_.clear();
  for (const Cycle& one : cycles)
    if (one.stable == true) starts_.push_back(one.start);
  Cycle cycle = *std::ranges::find(cycles, std::optional<bool>(true), &Cycle::stable);
  double p = parameter_.value;
  for (int i = 0; i <= successors; ++i) {
    const Lost lost = follow(cycle, p, limit_);
    if (lost.kind == Lost::Kind::border && !stopped() && !stays(lost.last))
      return by_bisection(What::ends, p, limit_, starts_);
    if (lost.kind == Lost::Kind::border)
      return {What::none, limit_, 0.0, "it hunts all the way to " + short_number(limit_, 5)};
    if (lost.kind == Lost::Kind::failed) return {What::unknown, lost.value, unknown, lost.why};
    std::optional<Cycle> other;
    MarginSide side = beyond(lost, other, p);
    if (!other) return side;
    cycle = std::move(*other);
    if (p == limit_) return {What::none, limit_, 0.0, "it hunts at " + short_number(limit_, 5) + ", on another cycle"};
  }
  return {What::unknown, p, unknown, "followed across several branches; the last was lost near " + short_number(p, 5)};
}

std::optional<Cycle> OneSidedMargin::before(const Lost& lost, double& at, bool& decided) {
  const double own = parameter_.value;
  const double inwards = std::abs(lost.value) > std::abs(own) ? -1.0 : 1.0;
  decided = false;
  for (const double reach : beyond_lost) {
    at = lost.value * (1.0 + inwards * reach);
    if (inwards * (std::abs(at) - std::abs(own)) > 0.0) at = own;
    Reached reached = reached_at(at, {lost.last});
    if (reached.cycle) return std::move(reached.cycle);
    decided = reached.outcome != Outcome::undecided;
    if (decided || stopped() || at == own) break;
  }
  return std::nullopt;
}

MarginSide OneSidedMargin::back_from(Cycle cycle, double p) {
  using What = MarginSide::What;
  const double own = parameter_.value;
  const auto reaches_back = [&] {
    return MarginSide{What::begins, own, 0.0,
                      "the cycle found at " + short_number(p, 5) +
                          " reaches back to the parameter's own value: the loop hunts there from starts that were not "
                          "tried"};
  };
  for (int i = 0; i <= successors; ++i) {
    const Lost lost = follow(cycle, p, own);
    if (lost.kind == Lost::Kind::border) return reaches_back();
    if (lost.kind == Lost::Kind::failed)
      return {What::begins, p, unknown,
              "it hunts at " + short_number(p, 5) + "; where that begins could not be followed: " + lost.why};
    double at = own;
    bool decided = false;
    auto other = before(lost, at, decided);
    if (!other) {
      if (decided && std::isnan(lost.error)) return by_bisection(What::begins, p, at, {lost.last});
      MarginSide side = found(What::begins, lost, lost.why);
      if (decided) return side;
      side.why += "; whether the loop hunts on another cycle before it was not determined";
      if (lost.event != BranchEvent::Type::fold) side.error = unknown;  // where the branch turns back, the cycle begins
      return side;
    }
    p = at;
    if (p == own) return reaches_back();
    cycle = std::move(*other);
  }
  return {What::begins, p, unknown,
          "it hunts at " + short_number(p, 5) + "; followed across several branches, not to where that begins"};
}

MarginSide OneSidedMargin::where_hunting_begins() {
  using What = MarginSide::What;
  const int steps = std::max(1, static_cast<int>(std::ceil(options_.scan_per_decade * std::log10(options_.factor))));
  double last = parameter_.value;
  std::optional<double> open;
  for (int i = 1; i <= steps && !stopped(); ++i) {
    const double p = parameter_.value * std::pow(limit_ / parameter_.value, static_cast<double>(i) / steps);
    if (progress_) progress_(static_cast<double>(i) / (steps + 1));
    if (!parameter_.family(p))
      return {What::none, last, 0.0,
              "none up to " + short_number(last, 5) + "; the case is not valid at " + short_number(p, 5)};
    const Reached reached = reached_at(p, {});
    if (reached.outcome == Outcome::divergence)
      return {
          What::none,   p,
          unknown,      "none up to " + short_number(last, 5) + "; at " + short_number(p, 5) + " the motion diverges",
          std::nullopt, std::nullopt,
          true};
    if (reached.cycle) return back_from(*reached.cycle, p);
    if (reached.irregular) return by_bisection(What::begins, p, last, {});
    if (reached.outcome == Outcome::undecided && !open) open = p;
    last = p;
  }
  if (open)
    return {What::unknown, 0.0, unknown,
            "no cycle was reached up to " + short_number(last, 5) + ", but simulations at " + short_number(*open, 5) +
                " did not decide"};
  return {What::none, last, 0.0, "it does not hunt up to " + short_number(last, 5)};
}

}  // namespace limcycle
