#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/analysis/study/map/hunting_map.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/map_of.hpp"
#include "limcycle/cli/message.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output.hpp"
#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/cli/units_of.hpp"
#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/map/map.hpp"
#include "limcycle/reports/number.hpp"

namespace limcycle {
namespace {

struct MapFlags : SweepFlags {
  std::string x, y;                  ///< --x, --y PATH=FROM:TO:N[:log]
  std::vector<std::string> methods;  ///< --methods
  int starts = 0;                    ///< --starts; 0: from the case
  std::string html, picture;         ///< --html, --svg
};

/// The describing function alone unless more methods are requested: with mass and friction as one element a point takes
/// ten times as long.
Methods chosen_methods(const std::vector<std::string>& names) {
  const auto known = names_of({true, true, true});
  Methods chosen{names.empty(), false, false};
  bool* const switches[] = {&chosen.describing_function, &chosen.composite, &chosen.harmonic_balance};
  for (const auto& name : names) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end()) throw refusal("--methods " + name, "unknown method", suggest(name, known));
    *switches[found - known.begin()] = true;
  }
  return chosen;
}

std::string side_text(const MapAxis& axis) {
  return fmt::format("{}={}:{}:{}{}", axis.path, shortest(axis.from), shortest(axis.to), axis.points,
                     axis.logarithmic ? ":log" : "");
}

/// Flags that reproduce the map.
std::string flags_text(const HuntingMap& map, const MapFlags& flags) {
  std::string text = "--x " + side_text(map.x) + " --y " + side_text(map.y);
  if (!flags.methods.empty()) text += " --methods " + fmt::format("{}", fmt::join(map.methods, ","));
  if (flags.starts > 0) text += fmt::format(" --starts {}", flags.starts);
  return text;
}

SweptRows sweep_map(const Case& from, const HuntingMap& map, const MapFlags& flags, const Methods& methods) {
  PredictOptions options = map_options(from, methods);
  if (flags.starts > 0) options.starts = flags.starts;
  const auto columns = map_columns(map.methods);
  const std::string paths[] = {map.x.path, map.y.path};
  const LoopVariation variation(from, "--x, --y", paths);
  SweepTask task{map.size(), columns.size(), 1, {}};
  task.compute = [&](std::span<const std::size_t> points, std::span<double> rows) -> std::size_t {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const MapPoint point = point_of(map, points[i], variation, options);
      if (interrupted()) return i;
      std::ranges::copy(to_row(point), rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    }
    return points.size();
  };
  const std::string design =
      fmt::format("map {}; {}; starts {}", flags_text(map, flags), fmt::join(map.methods, ", "), options.starts);
  return run_stored(task, columns, design, flags, from);
}

int run(MapFlags flags) {
  if (flags.html.empty() && flags.output.ends_with(".html")) flags.html = std::exchange(flags.output, {});
  if (flags.picture.empty() && flags.output.ends_with(".svg")) flags.picture = std::exchange(flags.output, {});
  const Case from = load_case(flags);
  need_loop(from);
  const Units units = units_of(from);
  const Methods methods = chosen_methods(flags.methods);
  MapReport report = map_of(from, flags.x, flags.y, methods);
  Output output(flags, &from);
  output.keep("the store", flags.store);
  output.check_file("--html", flags.html);
  output.check_file("--svg", flags.picture);

  const SweptRows swept = sweep_map(from, report.map, flags, methods);
  const std::size_t columns = swept.rows.size() / report.map.size();
  for (std::size_t k = 0; k < report.map.size(); ++k)
    if (swept.known[k])
      report.map.points[k] =
          point_of_row(std::span(swept.rows).subspan(k * columns, columns), report.map.methods.size());

  const auto made = provenance(flags, &from);
  std::string text = map_text(from.title, report);
  if (!flags.html.empty()) {
    output.file(flags.html, map_page(in_units(report, units), made, from.text, units, flags_text(report.map, flags)));
    text += page_line(flags.html);
  }
  if (!flags.picture.empty()) output.file(flags.picture, map_picture(in_units(report, units), units));
  output.text(first_line(flags, swept.status) + text);
  if (output.wants_json()) output.json(map_json(made, report, swept.status));
  if (output.wants_csv()) output.csv(map_csv(report));
  output.finish();
  tell_how_to_resume(flags, swept.status);
  return report.map.known() == 0 || swept.status == Status::interrupted ? exit_no_answer : exit_done;
}

}  // namespace

void add_map(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<MapFlags>();
  CLI::App* command =
      add_command(program, action, "map", "Outcomes over two parameters, and where each method is wrong", true, flags,
                  [flags] { return run(*flags); });
  for (const auto& [name, into] : {std::pair("--x", &flags->x), std::pair("--y", &flags->y)})
    command->add_option(name, *into, "A parameter and its values, such as loop.controller.kd=1:50:60:log")
        ->type_name("PATH=FROM:TO:N[:log]")
        ->required();
  command->add_option("--methods", flags->methods, "Methods to judge (default: describing-function)")
      ->type_name("NAME,...")
      ->delimiter(',');
  command->add_option("--starts", flags->starts, "Simulations from different initial states at each point")
      ->type_name("N")
      ->check(whole_in(1, 100));
  add_sweep_flags(*command, *flags);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
  command->add_option("--svg", flags->picture, "Write the picture to FILE (so does -o FILE.svg)")->type_name("FILE");
}

}  // namespace limcycle
