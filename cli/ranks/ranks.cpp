#include "limcycle/cli/ranks/ranks.hpp"

#include <chrono>
#include <cstdlib>
#include <initializer_list>
#include <list>
#include <thread>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#ifdef LIMCYCLE_MPI
#define OMPI_SKIP_MPICXX 1  // the C++ interface, removed in MPI 3
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace limcycle {
namespace {

struct RankState {
  bool joined = false;  // MPI is running
  int rank = 0, count = 1;
  Isa isa = best_isa();
};

RankState& rank_state() {
  static RankState state;
  return state;
}

/// Value of the first of these variables that holds a number. Launchers use them to pass a process its rank.
int launcher_number(std::initializer_list<const char*> names, int otherwise) {
  for (const char* name : names)
    if (const char* text = std::getenv(name); text != nullptr && *text >= '0' && *text <= '9') return std::atoi(text);
  return otherwise;
}

/// Number of processes that the launcher started (0 if unknown), and the rank of this one. 1 without a launcher.
struct Launched {
  int count = launcher_number({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"},
                              std::getenv("PMIX_RANK") != nullptr ? 0 : 1);
  int rank = launcher_number({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"}, 0);
};

[[noreturn]] void refuse_launcher(const Launched& launched, const std::string& why, const std::string& suggestion) {
  rank_state().rank = launched.rank;  // all are rejected, rank 0 reports it
  throw refusal({}, "started as " + std::to_string(launched.count) + " processes, but " + why, suggestion);
}

#ifdef LIMCYCLE_MPI

/// A message being sent: its bytes must stay until MPI has taken them.
struct Sending {
  RankMessage message;
  MPI_Request request = MPI_REQUEST_NULL;
};

std::list<Sending>& sendings() {
  static std::list<Sending> all;
  return all;
}

void forget_sent() {
  auto& all = sendings();
  for (auto one = all.begin(); one != all.end();) {
    int sent = 0;
    MPI_Test(&one->request, &sent, MPI_STATUS_IGNORE);
    one = sent != 0 ? all.erase(one) : std::next(one);
  }
}

#endif

}  // namespace

int rank() { return rank_state().rank; }
int rank_count() { return rank_state().count; }
Isa isa_of_ranks() { return rank_state().isa; }
bool was_launched() { return launcher_number({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}, -1) >= 0; }

#ifdef LIMCYCLE_MPI

bool built_for_ranks() { return true; }

void join_ranks() {
  const Launched launched;  // read first: MPI sets such variables too
  if (launched.count == 1) return;
  RankState& state = rank_state();
  int level = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
  state.joined = true;
  MPI_Comm_rank(MPI_COMM_WORLD, &state.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &state.count);
  if (state.count == 1 && launched.count > 1)
    refuse_launcher(
        launched, "they cannot find each other",
        "start them with the mpirun of the MPI that this program was built with, or with 'srun --mpi=pmix'");
  int widest = static_cast<int>(state.isa), common = widest;
  MPI_Allreduce(&widest, &common, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  state.isa = static_cast<Isa>(common);
}

void leave_ranks(int code) {
  if (!rank_state().joined) return;
  if (interrupted_by_signal())
    std::thread([code] {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      std::_Exit(code);
    }).detach();
  for (auto& one : sendings()) MPI_Wait(&one.request, MPI_STATUS_IGNORE);
  sendings().clear();
  MPI_Finalize();
  rank_state().joined = false;
}

void abort_ranks(int code) {
  if (rank_state().joined) MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

std::string rank_name() {
  char machine[MPI_MAX_PROCESSOR_NAME] = {};
  int length = 0;
  if (rank_state().joined) MPI_Get_processor_name(machine, &length);
  return "rank " + std::to_string(rank()) + " on " + std::string(machine, static_cast<std::size_t>(length));
}

void send_to_rank(RankMessage message) {
  Sending& one = sendings().emplace_back(Sending{std::move(message), MPI_REQUEST_NULL});
  const std::string& content = one.message.content;
  MPI_Isend(content.data(), static_cast<int>(content.size()), MPI_BYTE, one.message.other, one.message.kind,
            MPI_COMM_WORLD, &one.request);
}  // NOLINT(clang-analyzer-optin.mpi.MPI-Checker): forget_sent() and leave_ranks() wait for it

std::optional<RankMessage> message_from_ranks() {
  if (!rank_state().joined) return std::nullopt;
  forget_sent();
  int arrived = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, &status);
  if (arrived == 0) return std::nullopt;
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  RankMessage message{status.MPI_SOURCE, status.MPI_TAG, std::string(static_cast<std::size_t>(size), '\0')};
  MPI_Recv(message.content.data(), size, MPI_BYTE, message.other, message.kind, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return message;
}

#else

bool built_for_ranks() { return false; }

void join_ranks() {
  if (const Launched launched; launched.count > 1)
    refuse_launcher(launched, "this program was built without MPI",
                    "start one, or build it where Open MPI is installed (tools/install build)");
}

void leave_ranks(int) {}
void abort_ranks(int code) { std::_Exit(code); }
std::string rank_name() { return "rank " + std::to_string(rank()); }
void send_to_rank(RankMessage) {}
std::optional<RankMessage> message_from_ranks() { return std::nullopt; }

#endif

}  // namespace limcycle
