#pragma once
#include <string>
#include <vector>

#include "limcycle/cli/command.hpp"
#include "limcycle/questions/asking/asking.hpp"
#include "limcycle/reports/store/store.hpp"

namespace limcycle {

/// Flags of every command that computes many points, in addition to the common flags.
struct SweepFlags : CommonFlags {
  std::string store;    ///< --store
  bool resume = false;  ///< --resume
};

void add_sweep_flags(CLI::App& command, SweepFlags& flags);

/// Runs a sweep with a progress bar that shows the rate, into the store if --store names one, and catches Ctrl-C.
/// `design`: all that defines its points and rows, except case, seed and program. With several ranks all compute, and
/// rank 0 continues with the rows; for the others the command ends here (ShareDone). Throws StoreError, RankFailure.
SweptRows run_stored(const SweepTask& task, const std::vector<std::string>& columns, const std::string& design,
                     const SweepFlags& flags, const Case& from);

/// Prints on stderr how to resume a sweep that was interrupted.
void tell_how_to_resume(const SweepFlags& flags, Status status);

}  // namespace limcycle
