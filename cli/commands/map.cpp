#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/map_of.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/ranks/sweep.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/map.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/map/map.hpp"

namespace limcycle {
namespace {

struct MapFlags : SweepFlags {
  std::string x, y;                  ///< --x, --y PATH=FROM:TO:N[:log]
  std::vector<std::string> methods;  ///< --methods
  bool outcomes = false;             ///< --outcomes
  int starts = 0;                    ///< --starts; 0: from the case
  std::string html, picture;         ///< --html, --svg
};

Status compute(const Case& from, HuntingMap& map, const MapFlags& flags, const Methods& methods) {
  Progress silent(true);  // the sweep shows its own
  const int starts = flags.starts > 0 ? flags.starts : from.predict.starts;
  const std::string design = fmt::format("map {}; {}; starts {}", flags_of(map, !flags.methods.empty(), flags.starts),
                                         fmt::join(map.methods, ", "), starts);
  return ask_map(from, map, methods, starts, design, asking_of(flags, silent),
                 [&](const auto& task, const auto& columns, const auto& text) {
                   return run_stored(task, columns, text, flags, from);
                 });
}

int run(MapFlags flags) {
  take_page(flags, flags.html);
  take_picture(flags, flags.picture);
  const Case from = load_case(flags);
  need_loop(from);
  const Methods methods = flags.outcomes ? no_methods : map_methods("--methods", flags.methods);
  MapReport report = map_of(from, flags.x, flags.y, methods);
  need_memory_for(report.map, {!flags.json.empty(), !flags.csv.empty()}, "--");
  Output output(flags, &from);
  output.keep_store(flags.store);
  output.check_page("--html", flags.html);
  output.check_picture("--svg", flags.picture);

  const Status ended = compute(from, report.map, flags, methods);
  auto made = provenance(flags, &from);
  if (flags.outcomes) made.isa = to_string(instruction_set(flags));
  const Units units = units_of(from, largest_swing(report));
  Document text = map_document(from.title, report);
  if (!flags.html.empty()) {
    const std::string again = flags_of(report.map, !flags.methods.empty(), flags.starts);
    output.file(flags.html, map_page(in_units(report, units), made, from.text, units, again));
    text += page_line(flags.html);
  }
  if (!flags.picture.empty()) output.picture(flags.picture, map_picture(in_units(report, units), units));
  output.text(first_line(flags, ended), text);
  if (output.wants_json()) output.json(map_json(made, report, ended));
  if (output.wants_csv()) output.csv(map_csv(report));
  output.finish();
  tell_how_to_resume(flags, ended);
  return report.map.known() == 0 || ended == Status::interrupted ? exit_no_answer : exit_done;
}

void add_map(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<MapFlags>();
  CLI::App* command =
      add_command(program, action, "map", "Outcomes over two parameters, and where each method is wrong", true, flags,
                  [flags] { return run(*flags); });
  for (const auto& [name, into] : {std::pair("--x", &flags->x), std::pair("--y", &flags->y)})
    command->add_option(name, *into, "A parameter and its values, such as loop.controller.kd=1:50:60:log")
        ->type_name("PATH=FROM:TO:N[:log]")
        ->required();
  CLI::Option* methods =
      command->add_option("--methods", flags->methods, "Methods to judge (default: describing-function)")
          ->type_name("NAME,...")
          ->delimiter(',');
  command
      ->add_flag("--outcomes", flags->outcomes,
                 "Outcomes alone, by simulation from the starts: faster, judges no method")
      ->excludes(methods);
  command->add_option("--starts", flags->starts, "Simulations from different initial states at each point")
      ->type_name("N")
      ->check(whole_in(1, 100));
  add_sweep_flags(*command, *flags);
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
  command->add_option("--svg", flags->picture, "Write the picture to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
}

}  // namespace

Command map_command() {
  return {
      {"map",
       change_group,
       "Computes the outcome, and whether each method predicts it, at every point of a grid over two numbers. With "
       "--store every point is saved as soon as it is known: Ctrl-C loses nothing, --resume continues, and under "
       "mpirun many machines share the work. --outcomes simulates from the starts alone and judges no method: it is "
       "faster, but finds no cycle that none of the starts reaches.",
       {{"limcycle map cases/relay-third-order.toml --x loop.element.dead_zone=0.05:0.1:5 "
         "--y loop.element.level=0.5:2:4 --store plane.db",
         "20 points, kept in a store"},
        {"limcycle map cases/relay-third-order.toml --x loop.element.dead_zone=0.05:0.1:5 "
         "--y loop.element.level=0.5:2:4 --store plane.db --resume -o plane.svg",
         "continue it, and draw it"}}},
      add_map};
}

}  // namespace limcycle
