#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/models/linear/plants.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/reports/case_files/new_case.hpp"

namespace limcycle {
namespace {

struct NewFlags : CommonFlags {
  std::string plant, controller, friction, element, error;  ///< empty: not given; "none": none
  bool all = false, force = false, diagram = false, brief = false, sampled = false;
};

/// The requested case: without friction and element the servo with LuGre friction; an element alone replaces the
/// friction, in front of three equal lags. A process of first order, which takes no friction, has a relay.
NewCase wanted_case(const NewFlags& flags) {
  const auto given = [](const std::string& kind) { return kind == "none" ? std::string() : kind; };
  NewCase wanted;
  wanted.all = flags.all;
  wanted.brief = flags.brief;
  wanted.sampled = flags.sampled;
  wanted.element = given(flags.element);
  wanted.error = given(flags.error);
  if (flags.plant == FirstOrder::kind && flags.element.empty() && flags.friction.empty()) wanted.element = "relay";
  const bool alone = flags.friction.empty() && !wanted.element.empty();
  wanted.friction = alone ? "" : flags.friction.empty() ? wanted.friction : given(flags.friction);
  wanted.plant = !flags.plant.empty() ? flags.plant : alone ? "transfer-function" : wanted.plant;
  wanted.controller = !flags.controller.empty() ? flags.controller : alone ? "none" : wanted.controller;
  return wanted;
}

/// Rejects a kind that is not allowed in the section of the flag's name.
void check_kind(const std::string& flag, const std::string& kind) {
  auto kinds = kinds_for("loop." + flag.substr(2));
  if (flag != "--plant" && flag != "--controller") kinds.emplace_back("none");
  if (kind.empty() || std::ranges::find(kinds, kind) != kinds.end()) return;
  throw refusal(flag, "unknown kind '" + kind + "'", suggest(kind, kinds));
}

int run(NewFlags flags) {
  flags.color = "never";  // the output may be copied into a file
  check_kind("--plant", flags.plant);
  if (flags.plant == MeasuredPlant::kind)
    throw refusal("--plant frf", "needs a file of measured data, which a new case does not have",
                  "cases/measured-axis.toml and its CSV file show one");
  check_kind("--controller", flags.controller);
  check_kind("--friction", flags.friction);
  check_kind("--element", flags.element);
  check_kind("--error", flags.error);
  for (const std::string* kind : {&flags.plant, &flags.controller, &flags.friction, &flags.element, &flags.error})
    if (flags.diagram && !kind->empty())
      throw refusal("--diagram", "writes a cascade of blocks: kinds of slots do not go with it");
  if (flags.diagram && flags.sampled)
    throw refusal("--sampled", "is for a controller of the slots",
                  "in a diagram write sample_time into the blocks of kind pid");
  const std::string text = flags.diagram ? new_diagram() : new_case(wanted_case(flags));
  try {
    read_case(text, "the new case");
  } catch (const InputError& error) {  // each part is valid by itself
    throw refusal("new", "these parts do not fit together: " + error.fault().key + " " + error.fault().rule);
  }
  std::error_code ignored;
  if (!flags.output.empty() && !flags.force && std::filesystem::exists(flags.output, ignored))
    throw refusal("--output " + flags.output, "exists already and is not overwritten", "--force replaces it");
  Output output(flags);
  output.text(text);
  output.finish();
  if (!flags.output.empty())
    tell(flags, flags.output + " is written; replace the numbers by your own, then: limcycle predict " + flags.output);
  return exit_done;
}

void add_new(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<NewFlags>();
  CLI::App* command =
      add_plain_command(program, action, "new", "Write a commented case file, to be filled with your numbers", flags,
                        [flags] { return run(*flags); });
  command->add_option("--plant", flags->plant, "Kind of the plant")->type_name("KIND");
  command->add_option("--controller", flags->controller, "Kind of the controller")->type_name("KIND");
  command->add_option("--friction", flags->friction, "Friction law, or none")->type_name("KIND");
  command->add_option("--element", flags->element, "Element between controller and plant")->type_name("KIND");
  command->add_option("--error", flags->error, "Element on the error")->type_name("KIND");
  command->add_flag("--diagram", flags->diagram, "Write a cascade as a diagram of blocks instead");
  command->add_flag("--sampled", flags->sampled, "Let the controller run on a computer, with its encoder");
  command->add_flag("--brief", flags->brief, "Leave out optional keys and sections");
  command->add_flag("--all", flags->all, "Write the optional sections too, not as comments");
  command->add_flag("--force", flags->force, "Replace a file that exists");
}

}  // namespace

Command new_command() {
  return {{"new",
           begin_group,
           "Writes a complete, valid case file for the plant, the controller and the friction law or element that you "
           "name. It lists every key with its unit, meaning and default; optional keys are commented out. Replace the "
           "numbers by your own.\n"
           "Without options the case is a mass under PID control with LuGre friction. With --element and without "
           "--friction, the loop has that element in place of friction. An existing file is not overwritten without "
           "--force.",
           {{"limcycle new -o servo.toml", "the default: mass, PID, LuGre friction"},
            {"limcycle new --plant two-mass --friction coulomb -o drive.toml", "a drive with an elastic shaft"},
            {"limcycle new --plant zpk --controller none --element relay", "a relay before a plant, printed only"}}},
          add_new};
}

}  // namespace limcycle
