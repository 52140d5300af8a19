#include "limcycle/questions/df.hpp"

#include <algorithm>

#include "limcycle/analysis/frequency/describing_function/df_table.hpp"

namespace limcycle {
namespace {

DfOptions options_with(const DfSection& section, const Asking& asking) {
  DfOptions options = section.options;
  options.isa = asking.isa;
  options.threads = asking.threads;
  return options;
}

}  // namespace

void need_memory_for(const DfSection& section, const HeldDocuments& held) {
  const double harmonics = section.options.harmonics;
  // Rows, results and points are in memory at the same time.
  double bytes = 8.0 * (9.0 + 2.0 * harmonics) + 16.0 * harmonics + sizeof(DescribingFunction) + 2.0 * sizeof(DfPoint);
  if (held.json) bytes += 260.0 + 45.0 * harmonics;
  if (held.csv) bytes += 150.0 + 45.0 * harmonics;
  need_memory("df", static_cast<double>(section.size()), bytes, "fewer points or harmonics");
}

std::vector<DescribingFunction> ask_df(const Case& from, const DfSection& section, const Asking& asking,
                                       const SweepRunner& sweep) {
  const auto points = section.points();
  const DfOptions options = options_with(section, asking);
  DfTable table(df_element(from), points, options);
  const auto columns = df_columns(options.harmonics);
  SweepTask task{points.size(), columns.size(), table.block(), {}};
  task.compute = [&](std::span<const std::size_t> which, std::span<double> rows) {
    std::vector<DescribingFunction> results(which.size());
    const std::size_t finished = table.compute(which, results, asking.stop);
    for (std::size_t i = 0; i < finished; ++i)
      std::ranges::copy(df_to_row(results[i]), rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    return finished;
  };
  const SweptRows swept = sweep(task, columns, "df " + std::string(to_string(options.isa)));
  std::vector<DescribingFunction> results;
  results.reserve(points.size());
  for (std::size_t k = 0; k < points.size() && swept.known[k]; ++k)
    results.push_back(df_of_row(std::span(swept.rows).subspan(k * columns.size(), columns.size())));
  return results;
}

std::vector<DescribingFunction> ask_df(const Case& from, const DfSection& section, const Asking& asking) {
  return describing_function_table(
      df_element(from), section.points(), options_with(section, asking), asking.stop, [&](std::size_t done) {
        asking.report(static_cast<double>(done) / static_cast<double>(section.size()), "points");
      });
}

}  // namespace limcycle
