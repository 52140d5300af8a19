#include "limcycle/analysis/study/remedy/hunts.hpp"

#include <algorithm>
#include <stdexcept>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/loop_in_time.hpp"

namespace limcycle {
namespace {

/// The first of the outcomes with this property, as a clause; empty if there is none.
template <class Property>
std::string clause_of(const PredictReport& found, const Property& property) {
  const auto one = std::ranges::find_if(found.outcomes, property);
  return one == found.outcomes.end() ? std::string() : one->start + ": " + one->why;
}

bool is_stable(const Cycle& cycle) { return cycle.stable == true; }

void judge(HuntsAnswer& answer, const std::vector<std::string>& may_diverge) {
  const PredictReport& found = answer.found;
  const auto is = [](Outcome outcome) { return [=](const OutcomeOfStart& one) { return one.outcome == outcome; }; };
  const auto decide = [&](Hunts hunts, std::string why) {
    if (why.empty()) return false;
    answer.hunts = hunts;
    answer.why = std::move(why);
    return true;
  };
  if (std::ranges::any_of(found.cycles, is_stable)) {
    const std::string reached =
        clause_of(found, [&](const OutcomeOfStart& one) { return one.cycle && is_stable(found.cycles[*one.cycle]); });
    decide(Hunts::yes, reached.empty() ? "a stable cycle that no start reaches" : reached);
    return;
  }
  if (decide(Hunts::yes, clause_of(found, is(Outcome::irregular)))) return;
  if (found.status == Status::interrupted) {
    decide(Hunts::undecided, "interrupted");
    return;
  }
  const auto open = [](const OutcomeOfStart& one) {
    return one.outcome == Outcome::undecided || one.outcome == Outcome::cycle;  // of a cycle that is not stable
  };
  if (decide(Hunts::undecided, clause_of(found, open))) return;
  if (decide(Hunts::neutral, clause_of(found, is(Outcome::family)))) return;
  // Between the starts, motions are followed on purpose to where they diverge.
  const auto diverges = [&](const OutcomeOfStart& one) {
    return one.outcome == Outcome::divergence && !one.probe &&
           std::ranges::find(may_diverge, one.start) == may_diverge.end();
  };
  if (decide(Hunts::diverges, clause_of(found, diverges))) return;
  decide(Hunts::no, "every start comes to rest or slides steadily");
}

/// The state for a loop with the same states but perhaps more elements, whose modes then begin anew; empty for others.
std::optional<LoopState> carried_to(const Loop& loop, const MotionState& from) {
  if (state_names(loop) != from.names) return std::nullopt;
  if (from.state.modes.size() == loop.elements.size()) return from.state;
  LoopField field(loop);
  LoopState state{from.state.x, {}};
  field.start(state.x, 0.0);
  state.modes = field.modes();
  return state;
}

}  // namespace

std::string_view to_string(Hunts hunts) {
  switch (hunts) {
    case Hunts::no:
      return "no";
    case Hunts::yes:
      return "yes";
    case Hunts::neutral:
      return "neutral";
    case Hunts::diverges:
      return "diverges";
    case Hunts::undecided:
      break;
  }
  return "undecided";
}

HuntsAnswer hunts(const Loop& loop, const Judging& judging) try {
  PredictOptions options = judging.predict;
  options.methods = {false, false, false};
  options.progress = {};
  HuntsAnswer answer;
  answer.found = predict(loop, options);
  judge(answer, judging.may_diverge);
  return answer;
} catch (const std::invalid_argument& refused) {
  return {.hunts = Hunts::undecided, .why = std::string("could not be simulated: ") + refused.what()};
}

Hunts hunts_of(const Settled& motion) {
  switch (motion.outcome) {
    case Outcome::rest:
    case Outcome::sliding:
      return Hunts::no;
    case Outcome::cycle:
      return motion.shot && motion.shot->cycle.stable == true ? Hunts::yes : Hunts::undecided;
    case Outcome::irregular:
      return Hunts::yes;
    case Outcome::divergence:
      return Hunts::diverges;
    case Outcome::family:
      return Hunts::neutral;
    case Outcome::undecided:
      break;
  }
  return Hunts::undecided;
}

MotionState motion_state(const Cycle& cycle, const Loop& loop) {
  return {cycle.start, state_names(loop_in_time(loop, 0.0).treated.loop)};
}

std::optional<Settled> settled_from(const Loop& loop, const MotionState& motion, const SearchBox& box,
                                    const PredictOptions& options, long steps) {
  const Loop time = loop_in_time(loop, 0.0).treated.loop;
  const auto from = carried_to(time, motion);
  if (!from) return std::nullopt;
  SettleOptions settings = cycle_search(time, box, options.accuracy, options.stop);
  if (steps > 0) {
    settings.max_steps = steps;
    settings.fewest_turns = 0;
  }
  return settle(time, *from, settings);
}

Judging hurried(Judging judging) {
  judging.predict.starts = std::min(judging.predict.starts, 2);
  judging.predict.load_step = false;
  return judging;
}

Judging judging_of_variants(const PredictOptions& predict, const PredictReport& found) {
  Judging judging{predict};
  judging.predict.progress = {};
  judging.predict.search = found.search;
  for (const OutcomeOfStart& one : found.outcomes)
    if (one.outcome == Outcome::divergence && !one.probe) judging.may_diverge.push_back(one.start);
  return judging;
}

}  // namespace limcycle
