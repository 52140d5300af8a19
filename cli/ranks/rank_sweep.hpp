/// @file
/// One sweep on all ranks of a job. Rank 0 is the writer: it owns the store, the progress bar and every file, hands out
/// points to ranks with room for more, and computes too. The others compute, and send rows only.
///
/// A rank holds one piece in each of its threads and a second one for each, to hide the latency of messages behind
/// computing; towards the end no second ones are handed out, so that no points wait in a queue. A piece has as many
/// blocks as take `piece_seconds`, or more if there are so many ranks that the writer would receive too many messages.
/// asked too often.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "limcycle/analysis/sweep.hpp"

namespace limcycle {

/// Another rank failed. The message names it.
class RankFailure : public std::runtime_error {
 public:
  RankFailure(const std::string& message, int code) : std::runtime_error(message), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

/// Thrown on ranks other than 0 when a sweep is over: the rest of the command runs on rank 0.
struct ShareDone {};

/// run_sweep() on all ranks, for rank 0; `threads` of the options as there, except that 0 means one. `identity`
/// identifies the sweep: a rank with another one (an older case file on its disk, say) ends the job. `interrupted` also
/// if another rank was asked to stop. Throws the exception of a thread of this rank, or RankFailure; rows that arrived
/// were passed to the sink before. The first sweep of a command is shared; the others have left before a second one,
/// which rank 0 computes alone.
Status run_on_ranks(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink,
                    const SweepOptions& options, const std::string& identity);

/// The share of every other rank. Throws ShareDone, or the exception of compute.
[[noreturn]] void serve_ranks(const SweepTask& task, int threads, const std::string& identity);

}  // namespace limcycle
