#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/cli/output/message.hpp"

#include <CLI/CLI.hpp>
#include <limits>
#include <optional>

#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/ranks/rank_sweep.hpp"
#include "limcycle/cli/ranks/ranks.hpp"

namespace limcycle {
namespace {

SweepIdentity identity_of(const SweepTask& task, const std::vector<std::string>& columns, const std::string& design,
                          const SweepFlags& flags, const Case& from, const std::string& command) {
  const Provenance made = provenance(flags, &from);
  SweepIdentity identity;
  identity.command = command;
  identity.title = from.title;
  identity.case_file = from.file;
  identity.case_sha256 = from.sha256;
  std::string data;  // on which the results depend as they do on the case
  for (const CaseData& one : data_of(from)) data += one.sha256;
  if (!data.empty()) identity.case_sha256 = sha256(from.sha256 + data);
  identity.overrides = from.overrides;
  identity.design = design;
  identity.seed = flags.seed;
  identity.columns = columns;
  identity.points = task.points;
  identity.version = made.version;
  identity.commit = made.commit;
  identity.isa = made.isa;
  return identity;
}

/// Text that must be the same on all ranks of a job.
std::string as_text(const SweepIdentity& identity) {
  std::string text = identity.command + '\n' + identity.case_sha256 + '\n' + identity.design + '\n' +
                     std::to_string(identity.seed) + '\n' + std::to_string(identity.points) + '\n' + identity.version +
                     '\n' + identity.commit + '\n' + identity.isa;
  for (const auto* names : {&identity.overrides, &identity.columns})
    for (const auto& name : *names) text += '\n' + name;
  return text;
}

}  // namespace

void add_sweep_flags(CLI::App& command, SweepFlags& flags) {
  flags.threads = 0;  // results do not depend on it
  command.get_option("--threads")->capture_default_str();
  command.add_option("--store", flags.store, "Keep every point in this file as soon as it is computed")
      ->type_name("FILE");
  command.add_flag("--resume", flags.resume, "Continue that file: compute only the missing points")->needs("--store");
}

SweptRows run_stored(const SweepTask& task, const std::vector<std::string>& columns, const std::string& design,
                     const SweepFlags& flags, const Case& from) {
  const std::string command = design.substr(0, design.find(' '));
  const SweepIdentity identity = identity_of(task, columns, design, flags, from, command);
  if (rank() > 0) serve_ranks(task, flags.threads, as_text(identity));
  SweptRows swept;
  swept.known.assign(task.points, false);
  swept.rows.assign(task.points * task.columns, std::numeric_limits<double>::quiet_NaN());
  std::optional<SweepStore> store;
  if (!flags.store.empty()) {
    store.emplace(flags.store, identity, flags.resume);
    StoredSweep before = store->read_all();
    swept.known = std::move(before.known);
    swept.rows = std::move(before.rows);
  }
  const auto known_before = swept.known;
  const auto sink = [&](std::span<const std::size_t> points, std::span<const double> rows) {
    if (store) store->write(points, rows);
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::ranges::copy(rows.subspan(i * task.columns, task.columns),
                        swept.rows.begin() + static_cast<std::ptrdiff_t>(points[i] * task.columns));
      swept.known[points[i]] = true;
    }
  };
  catch_interrupts();
  {
    Progress bar(flags.quiet, flags.verbose);
    SweepOptions options;
    options.threads = flags.threads;
    options.stop = interrupted;
    options.progress = [&](std::size_t done, std::size_t total) { bar.count(done, total); };
    swept.status = rank_count() > 1 ? run_on_ranks(task, known_before, sink, options, as_text(identity))
                                    : run_sweep(task, known_before, sink, options);
  }
  if (store) store->flush();
  return swept;
}

void tell_how_to_resume(const SweepFlags& flags, Status status) {
  tell_cut_short(flags, status,
                 flags.store.empty() ? "the results computed so far are written (--store FILE would keep them)"
                                     : "the results computed so far are in " + flags.store +
                                           ": continue by the same command with --resume");
}

}  // namespace limcycle
