#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

int run(const CommonFlags& flags) {
  const Case from = load_case(flags);
  const DfSection& section = need_df(from);
  const auto points = section.points();
  DfOptions options = section.options;
  options.isa = instruction_set(flags);
  options.threads = flags.threads;
  Output output(flags);

  std::vector<DescribingFunction> results;
  {
    Progress progress(flags.quiet);
    const auto total = static_cast<double>(points.size());
    catch_interrupts();
    results = describing_function_table(df_element(from), points, options, interrupted, [&](std::size_t done) {
      progress.show(static_cast<double>(done) / total, "describing functions");
    });
  }
  output.text(df_text(from.title, points, results));
  Provenance made = provenance(flags, &from);
  made.isa = to_string(options.isa);
  if (output.wants_json()) output.json(df_json(made, points, results));
  if (output.wants_csv()) output.csv(df_csv(points, results));
  output.finish();
  if (results.size() < points.size() && !flags.quiet)
    std::cerr << "limcycle: interrupted; the points computed until then are written\n";
  const bool answered = std::ranges::any_of(results, [](const auto& result) { return result.answered(); });
  return answered ? exit_done : exit_no_answer;
}

}  // namespace

void add_df(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CommonFlags>();
  add_command(program, action, "df", "Describing functions over amplitude x frequency x bias", true, flags,
              [flags] { return run(*flags); });
}

}  // namespace limcycle
