#include "limcycle/analysis/energy/loop/loop_dissipation.hpp"

namespace limcycle {
namespace {

/// Answer on the absence of cycles, for a loop with friction or without.
Answer absence(const LoopDissipation& of, const Loop& loop) {
  return loop.ports.empty() || !loop.ports.back().opposes ? of.sector.no_cycle() : of.passivity;
}

}  // namespace

LoopDissipation loop_dissipation(const Loop& loop, const LoopDissipationOptions& options) {
  LoopDissipation result{RubbingImpedance(loop), {}, {}, CircleCriterion(loop), {}, {}, {}};
  result.rest_is_passive = result.impedance.rest_is_passive().answer;
  result.passivity = result.impedance.no_cycle(options.deficit);
  result.no_cycle = absence(result, loop);
  if (options.stop && options.stop()) {
    result.stuck.answer = result.stuck.attracts = result.sliding.stable = {Decision::undecided, "interrupted"};
    return result;
  }
  StuckOptions stuck;
  stuck.march = options.march;
  stuck.stop = options.stop;
  result.stuck = stuck_set(loop, stuck);
  result.sliding = sliding_stability(loop);
  return result;
}

}  // namespace limcycle
