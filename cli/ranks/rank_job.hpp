/// @file
/// End of a job of several ranks. Rank 0 announces it, whether all is computed, a rank was asked to stop, or an error
/// occurred; each other rank sends its final message, with its error; rank 0 reports to the user.
#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/ranks/ranks.hpp"

namespace limcycle {

/// Exit code of this process and its error message (empty: none).
struct Ending {
  int code = 0;
  std::string message;
};

/// State of the job for this process.
struct RankJob {
  bool end_said = false;   ///< by rank 0, or received from it
  std::vector<bool> left;  ///< on rank 0: the ranks that sent their final message
};

RankJob& rank_job();

/// On rank 0: true if all others sent their final message.
bool all_others_left();

/// On rank 0: announces the end to the others, once.
void say_end();

/// On rank 0: the final message of another rank; an empty text means no error.
Ending hear_last(const RankMessage& message);

/// The end of the job, called by every process as its last act: waits for the others. Returns, on rank 0, the error of
/// another rank, which rank 0 reports.
Ending end_ranks(const Ending& ending);

}  // namespace limcycle
