#pragma once
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

/// For variants of a loop that was judged with `predict`: the same starts, and those may diverge that did.
Judging judging_of_variants(const PredictOptions& predict, const PredictReport& found);

}  // namespace limcycle
