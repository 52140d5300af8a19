/// @file
/// How a job of several ranks comes to its end. Rank 0 says that it is over, whether all is computed, somebody was told
/// to stop, or something failed; each other rank says its last word, and what was wrong with it; rank 0 tells the user.
#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/ranks.hpp"

namespace limcycle {

/// How this process ends, and what it has to say for it (nothing: all is well).
struct Ending {
  int code = 0;
  std::string message;
};

/// Where the job stands for this process.
struct RankJob {
  bool end_said = false;   ///< by rank 0, or heard from it
  std::vector<bool> left;  ///< on rank 0: which ranks said their last word
};

RankJob& rank_job();

/// On rank 0: have all others said their last word?
bool all_others_left();

/// On rank 0: tells the others, once.
void say_end();

/// On rank 0: the last word of another rank; without a message it had nothing to complain of.
Ending hear_last(const RankMessage& message);

/// The end of the job, called by every process as its last act: waits for the others. Returns what another rank
/// complained of, on rank 0, which is the one that says it.
Ending end_ranks(const Ending& ending);

}  // namespace limcycle
