#include "limcycle/questions/simulate.hpp"

namespace limcycle {

void need_memory_for(const Case& from, const HeldDocuments& held) {
  const SimulateOptions& options = need_simulate(from);
  if (options.sample == 0.0) return;
  const double numbers = 2.0 + static_cast<double>(build_loop(need_loop(from)).states());
  const double bytes_a_number = 8.0 + (held.json ? 150.0 : 0.0) + (held.csv ? 12.0 : 0.0);
  need_memory("simulate.sample", options.duration / options.sample, 40.0 + numbers * bytes_a_number, "fewer samples");
}

SimulateAnswer ask_simulate(const Case& from, bool check, bool audit, const Asking& asking) {
  SimulateOptions options = need_simulate(from);
  const Loop loop = build_loop(need_loop(from));
  const double share = check ? 0.4 : 1.0;
  options.stop = asking.stop;
  options.progress = [&](double fraction) { asking.report(share * fraction, "simulation"); };
  std::optional<EnergyAudit> books;
  if (audit && has_energy(*from.loop) && loop.delay == 0.0) {
    books.emplace(*from.loop, loop, options.rtol);
    options.watch = [&](LoopField& field, March& march, const std::vector<Mode>& modes) {
      books->step(field, march, modes);
    };
  }
  SimulateAnswer result{simulate(loop, options), {}, {}};
  if (books) result.energy = books->balance();
  options.watch = {};
  if (!check || result.run.status != Status::converged) return result;
  options.progress = [&](double fraction) { asking.report(share + (1.0 - share) * fraction, "at other tolerances"); };
  const Agreement second = agreement(loop, options, result.run);
  if (second.status != Status::interrupted) result.second = second;
  return result;
}

}  // namespace limcycle
