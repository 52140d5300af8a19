#pragma once
#include <optional>

#include "limcycle/analysis/energy/loop/audit.hpp"
#include "limcycle/analysis/orbit/cycle/agreement.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"
#include "limcycle/questions/asking/need_memory.hpp"

namespace limcycle {

/// The run of [simulate], its energy balance, and its comparison with a second run at other tolerances, if they were
/// wanted and time allowed.
struct SimulateAnswer {
  Simulation run;
  std::optional<Agreement> second;
  std::optional<EnergyBalance> energy;
};

/// Throws InputError if the samples of the run, with these documents, would not fit into memory.
void need_memory_for(const Case& from, const HeldDocuments& held);

/// `check`: run it twice; `audit`: compute the energy balance of a loop that has energies and no dead time. Throws
/// InputError if the case has no [simulate].
SimulateAnswer ask_simulate(const Case& from, bool check, bool audit, const Asking& asking);

}  // namespace limcycle
