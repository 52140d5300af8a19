/// @file
/// limcycle's table of describing functions, 200 x 200 points of cases/df-lugre.toml, one thread.
///   ours_df REFERENCE CASE
#include <string>

#include "limcycle/analysis/frequency/describing_function.hpp"
#include "limcycle/bench/bristle.hpp"
#include "limcycle/bench/measure.hpp"
#include "limcycle/cases/case.hpp"

namespace {

/// Largest relative error over the points of the reference that lie in the table.
double largest_error(const std::vector<limcycle::DescribingFunction>& table,
                     const std::vector<bench::DfReference>& reference) {
  double worst = 0.0;
  for (const auto& point : reference) {
    if (point.index < 0) continue;
    const double error = std::abs(table[static_cast<std::size_t>(point.index)].gain / point.gain - 1.0);
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

void measure(const limcycle::Case& given, const limcycle::DfOptions& options, const char* contender,
             const std::vector<bench::DfReference>& reference) {
  const auto points = given.df->points();
  std::vector<limcycle::DescribingFunction> table;
  bench::Row row{"df", "200 x 200 table", contender, "accuracy " + bench::short_power(options.accuracy)};
  row.seconds = bench::least_cpu_seconds([&] {
                  table = limcycle::describing_function_table(limcycle::df_element(given), points, options);
                }) /
                static_cast<double>(points.size());
  for (const auto& point : table) row.evaluations += point.evaluations;
  row.error = largest_error(table, reference);
  bench::print(row);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const auto reference = bench::read_df_reference(arguments[1]);
  const auto given =
      limcycle::load_case(arguments[2], {"df.amplitude.points=200", "df.frequency.points=200", "df.harmonics=1"});
  for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    limcycle::DfOptions options = given.df->options;
    options.accuracy = accuracy;
    measure(given, options, "limcycle", reference);
  }
}
