/// @file
/// limcycle's table of describing functions, 200 x 200 points of cases/df-lugre.toml: one thread with every instruction
/// set of this machine, and two threads.
///   ours_df REFERENCE CASE
#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/analysis/study/experiments/runs/laws.hpp"
#include "limcycle/bench/bristle.hpp"
#include "limcycle/bench/measure.hpp"
#include "limcycle/cases/loader/case.hpp"

namespace {

using Table = std::vector<limcycle::DescribingFunction>;

/// Largest relative error over the points of the reference that lie in the table.
double largest_error(const Table& table, const std::vector<bench::DfReference>& reference) {
  double worst = 0.0;
  for (const auto& point : reference) {
    if (point.index < 0) continue;
    const double error = std::abs(table[static_cast<std::size_t>(point.index)].gain / point.gain - 1.0);
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

/// The element, and the points of its table.
struct Question {
  const limcycle::Element& element;
  std::vector<limcycle::DfPoint> points;

  Table answer(const limcycle::DfOptions& options) const {
    return limcycle::describing_function_table(element, points, options);
  }
};

void measure(const Question& question, const limcycle::DfOptions& options, const std::string& contender,
             const std::vector<bench::DfReference>& reference) {
  Table table;
  bench::Row row{"df", "200 x 200 table", contender, "accuracy " + bench::short_power(options.accuracy)};
  row.seconds = bench::least_cpu_seconds([&] { table = question.answer(options); });
  row.seconds /= static_cast<double>(table.size());
  for (const auto& point : table) row.evaluations += point.evaluations;
  row.error = largest_error(table, reference);
  bench::print(row);
}

/// Wall time, which threads are to reduce: the least of five rounds in which one and two threads alternate.
void measure_threads(const Question& question, limcycle::DfOptions options) {
  double least[2] = {INFINITY, INFINITY};
  for (int turn = 0; turn < 5; ++turn)
    for (int threads = 1; threads <= 2; ++threads) {
      options.threads = threads;
      const auto begin = std::chrono::steady_clock::now();
      question.answer(options);
      const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
      least[threads - 1] = std::min(least[threads - 1], wall.count());
    }
  for (int threads = 1; threads <= 2; ++threads)
    bench::print({"df", "threads", "limcycle", std::to_string(threads) + (threads == 1 ? " thread" : " threads"), -1.0,
                  least[threads - 1]});
}

/// Other laws with their presets' values on 40 x 40 points of the same range. Error: the largest stated one;
/// evaluations: the points computed by a kernel.
void measure_laws(const std::vector<limcycle::DfPoint>& points, limcycle::DfOptions options) {
  constexpr std::string_view labels[] = {"lugre", "dahl", "bouc-wen", "elasto-plastic", "xiong", "gms"};
  options.accuracy = 1e-6;
  for (const auto& setting : limcycle::law_settings()) {
    if (std::ranges::find(labels, setting.label) == std::end(labels)) continue;
    const auto law = limcycle::make_law(setting);
    Table table;
    bench::Row row{"df", "laws to 1.0e-06", "limcycle", setting.label};
    row.seconds = bench::least_cpu_seconds([&] { table = limcycle::describing_function_table(law, points, options); });
    row.seconds /= static_cast<double>(table.size());
    row.evaluations = std::ranges::count(table, "kernel", &limcycle::DescribingFunction::method);
    row.error = std::ranges::max(table, {}, &limcycle::DescribingFunction::error).error;
    bench::print(row);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const auto reference = bench::read_df_reference(arguments[1]);
  const auto given =
      limcycle::load_case(arguments[2], {"df.amplitude.points=200", "df.frequency.points=200", "df.harmonics=1"});
  const Question question{limcycle::df_element(given), given.df->points()};
  limcycle::DfOptions options = given.df->options;
  for (const limcycle::Isa isa : limcycle::all_isas()) {
    if (!limcycle::is_available(isa)) continue;
    options.isa = isa;
    std::string contender = "limcycle";
    if (isa != limcycle::best_isa()) contender += " " + std::string(limcycle::to_string(isa));
    for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
      options.accuracy = accuracy;
      measure(question, options, contender, reference);
    }
  }
  options.accuracy = 1e-9;
  options.isa = limcycle::best_isa();
  measure_threads(question, options);
  const auto fewer = limcycle::load_case(arguments[2], {"df.harmonics=1"});
  measure_laws(fewer.df->points(), options);
}
