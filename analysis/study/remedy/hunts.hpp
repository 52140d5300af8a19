#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Whether a loop hunts from any of the starts of predict().
enum class Hunts {
  no,         ///< every start comes to rest or slides steadily
  yes,        ///< there is a stable cycle, or a permanent motion without a period
  neutral,    ///< it does not hunt, and one start oscillates for ever with an amplitude of its own (a centre)
  diverges,   ///< it does not hunt, and one start diverges
  undecided,  ///< no hunting was found, and one start was not decided
};

std::string_view to_string(Hunts hunts);

/// The answer for one loop.
struct HuntsAnswer {
  Hunts hunts = Hunts::undecided;
  std::string why;  ///< one clause: what decided
  PredictReport found = {};
};

/// How loops are judged.
struct Judging {
  PredictOptions predict;                  ///< its methods do not matter: the loops are judged in time
  std::vector<std::string> may_diverge{};  ///< names of starts that may diverge
};

/// Asks predict() in time: from its starts, between them, from the stops of the body. Cost: that of predict() without
/// methods; status interrupted is undecided.
HuntsAnswer hunts(const Loop& loop, const Judging& judging);

/// What one motion shows: yes only for a stable cycle or a permanent motion without a period, no for one that comes to
/// rest or slides steadily.
Hunts hunts_of(const Settled& motion);

/// A state on a motion, and the names of the states of its loop, by which another loop knows if they are its own.
struct MotionState {
  LoopState state;
  std::vector<std::string> names;
};
/// Of a cycle of the loop.
MotionState motion_state(const Cycle& cycle, const Loop& loop);

/// Where the loop goes from a state on the hunting motion of another one with the same states: a cycle may be stable
/// where no start of predict() comes upon it. Elements that only this one has begin anew. `steps`: as of SettleOptions;
/// 0: its own. Empty if the states are others.
std::optional<Settled> settled_from(const Loop& loop, const MotionState& motion, const SearchBox& box,
                                    const PredictOptions& options, long steps = 0);

/// The same from two starts alone.
Judging hurried(Judging judging);

/// For variants of a loop that was judged with `predict`: the same starts, and those may diverge that did.
Judging judging_of_variants(const PredictOptions& predict, const PredictReport& found);

}  // namespace limcycle
