/// @file
/// The processes of one job on one or many machines: "ranks", started by mpirun or srun. Messages are text or raw
/// bytes, and only between rank 0 and another rank. ranks.cpp is the only file that uses MPI, which is optional in a
/// build; a program run by itself, or as the only rank, never starts it.
#pragma once
#include <optional>
#include <string>

#include "limcycle/analysis/lanes/isa.hpp"

namespace limcycle {

/// Takes this process into its job, if a launcher started it as one of several; to be called before all other functions
/// below. Throws InputError if it is one of several that cannot find each other, since each would do all the work and
/// write the same files.
void join_ranks();

/// Ends what join_ranks() began. Waits for the other ranks to do the same; but if a signal asked this one to stop, it
/// ends the process with `code` half a second later: a launcher that stops the job may not respond any more.
void leave_ranks(int code);

/// Ends all ranks of the job at once, even those that do not respond.
[[noreturn]] void abort_ranks(int code);

int rank();        ///< 0 .. rank_count()-1
int rank_count();  ///< 1 if the program runs by itself
bool built_for_ranks();

/// True if mpirun or the like started this process, even as the only one: its terminal need not be a person's.
bool was_launched();

/// "rank 3 on node17".
std::string rank_name();

/// The widest instruction set that all ranks have, so that the bytes of a result do not depend on the rank.
Isa isa_of_ranks();

/// A message from one rank to another. Numbers are in this machine's binary format.
struct RankMessage {
  int other = 0;  ///< sender or receiver
  int kind = 0;
  std::string content;
};

/// Returns at once. Messages from one rank to another arrive in order. On the main thread only.
void send_to_rank(RankMessage message);

/// The next message, if one has arrived. On the main thread only, to be called often: it also completes sends.
std::optional<RankMessage> message_from_ranks();

}  // namespace limcycle
