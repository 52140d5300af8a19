/// @file
/// One sweep on all ranks of a job. Rank 0 is the writer: it has the store, the bar and every file, hands out points to
/// whoever has room for more, and computes too. The others compute, and say nothing but rows.
///
/// A rank holds one piece in each of its threads and one more for each, so that the way of a message hides behind
/// computing; towards the end the second ones are not handed out, for nobody shall wait for points that lie in a queue.
/// A piece is as many blocks as take `piece_seconds`, and longer where there are so many ranks that the writer would be
/// asked too often.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "limcycle/analysis/sweep.hpp"

namespace limcycle {

/// Another rank could not go on. The message says which.
class RankFailure : public std::runtime_error {
 public:
  RankFailure(const std::string& message, int code) : std::runtime_error(message), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

/// Thrown on ranks other than 0 when a sweep is over: what remains of the command is for rank 0.
struct ShareDone {};

/// run_sweep() on all ranks, for rank 0; `threads` of the options as there, but 0 means one. `identity` says what the
/// sweep is: another rank with another one (an older case file on its disk, say) ends the job. `interrupted` also if
/// another rank was told to stop. Throws what a thread of this rank threw, or RankFailure; rows that arrived went to
/// the sink before. The first sweep of a command is shared; the others have left when a second one comes, which rank 0
/// computes alone.
Status run_on_ranks(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink,
                    const SweepOptions& options, const std::string& identity);

/// The share of every other rank. Throws ShareDone, or what compute threw.
[[noreturn]] void serve_ranks(const SweepTask& task, int threads, const std::string& identity);

}  // namespace limcycle
