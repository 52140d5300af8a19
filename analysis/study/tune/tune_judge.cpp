#include "limcycle/analysis/study/tune/tune_judge.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/loop_in_time.hpp"
#include "limcycle/analysis/study/remedy/linear_costs.hpp"

namespace limcycle {
namespace {

bool is_stopped(const TuneQuestion& question) {
  return question.judging.predict.stop && question.judging.predict.stop();
}

void conclude(TunePoint& point, TuneOutcome outcome, std::string why) {
  point.outcome = outcome;
  point.why = std::move(why);
}

TuneOutcome outcome_of(Hunts hunts) {
  switch (hunts) {
    case Hunts::no:
      return TuneOutcome::feasible;
    case Hunts::yes:
      return TuneOutcome::hunts;
    case Hunts::neutral:
      return TuneOutcome::neutral;
    case Hunts::diverges:
      return TuneOutcome::diverges;
    case Hunts::undecided:
      break;
  }
  return TuneOutcome::undecided;
}

constexpr long few_steps = 5'000;      ///< in which a motion that settles soon comes to rest
constexpr double still_settled = 0.1;  ///< share of the step, of an error at rest
constexpr long steps_of_a_motion = 60'000;
constexpr int resolution = 500;  ///< of the horizon of ise

Loop loop_in_time_of(const LoopParts& parts) { return loop_in_time(build_loop(parts), 0.0).treated.loop; }

SettleOptions settings_of(const Loop& time, const TuneQuestion& question) {
  const PredictOptions& options = question.judging.predict;
  return cycle_search(time, *options.search, options.accuracy, options.stop);
}

/// The outcome of a run that is none of a feasible point.
void conclude_by(TunePoint& point, const Settled& run, const Loop& loop, const std::string& from = "from the step: ") {
  const Hunts shown = hunts_of(run);
  if (shown == Hunts::no) return;
  conclude(point, outcome_of(shown), from + run.why);
  if (shown == Hunts::yes && run.shot) point.hunting = motion_state(run.shot->cycle, loop);
}

/// hunts(), and the motions of points nearby.
void judge_in_full(TunePoint& point, const Loop& loop, const TuneQuestion& question,
                   std::span<const MotionState> nearby) {
  HuntsAnswer answer = hunts(loop, question.judging);
  if (answer.hunts == Hunts::undecided && is_stopped(question)) return;
  for (const Cycle& one : answer.found.cycles)
    if (one.stable == true) point.hunting = motion_state(one, loop);
  if (answer.hunts != Hunts::no) return conclude(point, outcome_of(answer.hunts), std::move(answer.why));
  const PredictOptions& options = question.judging.predict;
  for (const MotionState& motion : nearby) {
    const auto run = settled_from(loop, motion, *options.search, options, steps_of_a_motion);
    if (is_stopped(question)) return;
    if (!run || hunts_of(*run) == Hunts::no) continue;
    return conclude_by(point, *run, loop, "from the hunting motion of a point nearby: ");
  }
  conclude(point, TuneOutcome::feasible, std::move(answer.why));
}

void set_cost(TunePoint& point, TuneCost cost, double value) {
  if (std::isfinite(value)) point.costs[static_cast<std::size_t>(cost)] = value;
}

/// The first limit that is exceeded, as a clause.
std::string above_limit(const TunePoint& point, const TuneQuestion& question) {
  for (std::size_t i = 0; i < point.costs.size(); ++i) {
    const auto &cost = point.costs[i], &limit = question.limits[i];
    if (limit && cost && *cost > *limit)
      return std::string(tune_cost_names[i]) + " is " + short_number(*cost) + ", above " + short_number(*limit);
  }
  return {};
}

bool is_above_limit(TunePoint& point, const TuneQuestion& question) {
  std::string why = above_limit(point, question);
  if (why.empty()) return false;
  conclude(point, TuneOutcome::above_limit, std::move(why));
  return true;
}

/// A point by itself.
void judge_alone(TunePoint& point, const TuneQuestion& question, std::span<const MotionState> nearby) try {
  const auto parts = question.loop_with(point.values);
  if (!parts) return conclude(point, TuneOutcome::invalid, "these values break a rule of the loop");
  if (!question.wants(TuneCost::settling)) {
    const Settled run = run_from_step(*parts, question);
    if (is_stopped(question)) return;
    const Hunts shown = hunts_of(run);
    if (shown != Hunts::no && shown != Hunts::diverges)
      return conclude_by(point, run, build_loop(*parts));  // this may be allowed
  }
  judge_in_full(point, build_loop(*parts), question, nearby);
} catch (const std::invalid_argument& refused) {
  conclude(point, TuneOutcome::undecided, std::string("could not be simulated: ") + refused.what());
}

}  // namespace

std::string_view to_string(TuneOutcome outcome) {
  switch (outcome) {
    case TuneOutcome::feasible:
      return "feasible";
    case TuneOutcome::hunts:
      return "hunts";
    case TuneOutcome::neutral:
      return "neutral";
    case TuneOutcome::diverges:
      return "diverges";
    case TuneOutcome::undecided:
      return "undecided";
    case TuneOutcome::unstable:
      return "unstable";
    case TuneOutcome::fragile:
      return "fragile";
    case TuneOutcome::above_limit:
      return "above-limit";
    case TuneOutcome::invalid:
      return "invalid";
    case TuneOutcome::not_judged:
      break;
  }
  return "not-judged";
}

std::string_view to_string(TunePoint::Part part) {
  switch (part) {
    case TunePoint::Part::own:
      return "own";
    case TunePoint::Part::design:
      return "design";
    case TunePoint::Part::search:
      return "search";
    case TunePoint::Part::neighbour:
      break;
  }
  return "neighbour";
}

void look_at(TunePoint& point, const TuneQuestion& question) try {
  if (is_stopped(question)) return;
  const auto parts = question.loop_with(point.values);
  if (!parts) return conclude(point, TuneOutcome::invalid, "these values break a rule of the loop");
  if (question.linear) {
    const LinearCosts linear = linear_costs(*parts, 0.0);
    if (!linear.stable) return conclude(point, TuneOutcome::unstable, "the loop without friction is unstable");
    if (question.wants(TuneCost::ms) && linear.peak_sensitivity)
      set_cost(point, TuneCost::ms, *linear.peak_sensitivity);
    if (is_above_limit(point, question)) return;
  }
  if (question.wants(TuneCost::ise))
    if (const auto found = squared_error_of(*parts, question)) set_cost(point, TuneCost::ise, found->value);
  if (is_above_limit(point, question) || !question.wants(TuneCost::settling)) return;
  const Settled run = run_from_step(*parts, question, few_steps);
  if (is_stopped(question)) return;
  conclude_by(point, run, build_loop(*parts));
  if (point.outcome != TuneOutcome::not_judged || run.trace.y.empty()) return;
  const double off = std::abs(parts->reference - run.trace.y_origin - run.trace.y.back());
  if (off > still_settled * question.step)  // friction that holds the body at the start settles nothing
    return conclude(point, TuneOutcome::above_limit,
                    "it comes to rest " + short_number(off) + " from the set-point, more than a tenth of the step");
  set_cost(point, TuneCost::settling, step_numbers(run.trace, run.trace.y.front()).settling_time);
  is_above_limit(point, question);
} catch (const std::invalid_argument& refused) {
  conclude(point, TuneOutcome::undecided, std::string("could not be simulated: ") + refused.what());
}

Settled run_from_step(const LoopParts& parts, const TuneQuestion& question, long steps) {
  const Loop time = loop_in_time_of(parts);
  SettleOptions options = settings_of(time, question);
  options.max_steps = steps;
  options.fewest_turns = 0;
  return settle(time, displaced(time, question.step), options);
}

std::optional<SquaredError> squared_error_of(const LoopParts& parts, const TuneQuestion& question) {
  const Loop time = loop_in_time_of(parts);
  const SettleOptions options = settings_of(time, question);
  Trace run;
  const Status status = record(time, displaced(time, question.step), question.horizon, options.rtol, resolution, run);
  // Switching that accumulates ends a march at rest.
  if ((status != Status::converged && status != Status::chattering) || run.y.empty()) return std::nullopt;
  return squared_error(run, parts.reference, question.horizon);
}

void judge(TunePoint& point, const TuneQuestion& question, std::span<const MotionState> nearby) {
  judge_alone(point, question, nearby);
  if (point.outcome != TuneOutcome::feasible || !question.margin) return;
  for (const auto& values : question.margin(point.values)) {
    if (values.empty()) continue;
    TunePoint other{values};
    judge_alone(other, question, nearby);
    if (other.outcome == TuneOutcome::feasible) continue;
    point.outcome = other.outcome == TuneOutcome::not_judged ? other.outcome : TuneOutcome::fragile;
    point.why = "within the margin it is " + std::string(to_string(other.outcome)) + ": " + other.why;
    point.hunting = other.hunting;
    return;
  }
}

}  // namespace limcycle
