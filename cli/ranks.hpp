/// @file
/// The processes of one job on one or many machines: "ranks", started by mpirun or srun. What is said between them is
/// text or raw bytes, and only rank 0 is spoken to and speaks to the others. ranks.cpp is the only file that knows MPI,
/// which is optional when the program is built; run by itself, or as the only rank, the program never starts it.
#pragma once
#include <optional>
#include <string>

#include "limcycle/analysis/lanes/isa.hpp"

namespace limcycle {

/// Takes this process into its job, if a launcher started it as one of several; no other function below may be called
/// before. Throws InputError if it is one of several that cannot find each other, for each would do all the work and
/// write the same files.
void join_ranks();

/// Ends what join_ranks() began. Waits for the other ranks to do the same; but where a signal told this one to stop, it
/// ends the process with `code` half a second later: a launcher that stops the job may not answer any more.
void leave_ranks(int code);

/// Ends all ranks of the job at once, also those that do not answer.
[[noreturn]] void abort_ranks(int code);

int rank();        ///< 0 .. rank_count()-1
int rank_count();  ///< 1 where the program runs by itself
bool built_for_ranks();

/// Whether mpirun or the like started this process, be it the only one: what is then a terminal need not be a person's.
bool was_launched();

/// "rank 3 on node17".
std::string rank_name();

/// The widest instruction set that all ranks have, so that it does not matter for the bytes of a result who computed
/// what.
Isa isa_of_ranks();

/// What one rank says to another. Numbers travel as this machine writes them.
struct RankMessage {
  int other = 0;  ///< who it is from or for
  int kind = 0;
  std::string content;
};

/// Returns at once. Messages from one rank to another arrive in order. On the main thread only.
void send_to_rank(RankMessage message);

/// The next message, if one has arrived. On the main thread only, which must call it often: messages also leave by it.
std::optional<RankMessage> message_from_ranks();

}  // namespace limcycle
