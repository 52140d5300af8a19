#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/analysis/frequency/describing_function/df_table.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/message.hpp"
#include "limcycle/cli/need_memory.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

/// The results from the first point on up to the first gap.
std::vector<DescribingFunction> sweep_table(const Case& from, const std::vector<DfPoint>& points,
                                            const DfOptions& options, const SweepFlags& flags) {
  DfTable table(df_element(from), points, options);
  const auto columns = df_columns(options.harmonics);
  SweepTask task{points.size(), columns.size(), table.block(), {}};
  task.compute = [&](std::span<const std::size_t> which, std::span<double> rows) {
    std::vector<DescribingFunction> results(which.size());
    const std::size_t finished = table.compute(which, results, interrupted);
    for (std::size_t i = 0; i < finished; ++i)
      std::ranges::copy(df_to_row(results[i]), rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    return finished;
  };
  const SweptRows swept = run_stored(task, columns, "df " + std::string(to_string(options.isa)), flags, from);
  std::vector<DescribingFunction> results;
  results.reserve(points.size());
  for (std::size_t k = 0; k < points.size() && swept.known[k]; ++k)
    results.push_back(df_of_row(std::span(swept.rows).subspan(k * columns.size(), columns.size())));
  return results;
}

/// Rows, results and the documents of a table are in memory at the same time.
void need_memory_for(const DfSection& section, const SweepFlags& flags) {
  const double harmonics = section.options.harmonics;
  double bytes = 8.0 * (9.0 + 2.0 * harmonics) + 16.0 * harmonics + sizeof(DescribingFunction) + 2.0 * sizeof(DfPoint);
  if (!flags.json.empty()) bytes += 260.0 + 45.0 * harmonics;
  if (!flags.csv.empty()) bytes += 150.0 + 45.0 * harmonics;
  need_memory("df", static_cast<double>(section.size()), bytes, "fewer points or harmonics");
}

int run(const SweepFlags& flags) {
  const Case from = load_case(flags);
  const DfSection& section = need_df(from);
  need_memory_for(section, flags);
  const auto points = section.points();
  DfOptions options = section.options;
  options.isa = instruction_set(flags);
  options.threads = flags.threads;
  Output output(flags);
  output.keep("the store", flags.store);

  const auto results = sweep_table(from, points, options, flags);
  const Status ended = results.size() < points.size() ? ending_so_far() : Status::converged;
  output.text(first_line(flags, ended) + df_text(from.title, points, results));
  Provenance made = provenance(flags, &from);
  made.isa = to_string(options.isa);
  if (output.wants_json()) output.json(df_json(made, points, results));
  if (output.wants_csv()) output.csv(df_csv(points, results));
  output.finish();
  tell_how_to_resume(flags, ended);
  const bool answered = std::ranges::any_of(results, [](const auto& result) { return result.answered(); });
  return answered && ended != Status::interrupted ? exit_done : exit_no_answer;
}

}  // namespace

void add_df(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SweepFlags>();
  CLI::App* command = add_command(program, action, "df", "Describing functions over amplitude x frequency x bias", true,
                                  flags, [flags] { return run(*flags); });
  add_sweep_flags(*command, *flags);
}

}  // namespace limcycle
