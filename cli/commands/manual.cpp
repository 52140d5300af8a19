#include <CLI/CLI.hpp>
#include <algorithm>

#include "build_info.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/help/manual_page.hpp"
#include "limcycle/cli/output/output.hpp"

namespace limcycle {
namespace {

std::string page(const CLI::App& program, const std::string& name) {
  const auto all = facts_of(program);
  if (name.empty()) return program_page(all, build_info::version);
  if (name == "case") return case_page(build_info::version);
  std::vector<std::string> names{"case"};
  for (const auto& command : all) {
    if (command.name == name) return command_page(command, build_info::version);
    names.push_back(command.name);
  }
  throw refusal("manual", "no page '" + name + "'", suggest(name, names));
}

void add_manual(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CommonFlags>();
  const auto name = std::make_shared<std::string>();
  CLI::App* command =
      add_plain_command(program, action, "manual", "Print a manual page in roff", flags, [&program, flags, name] {
        Output output(*flags);
        output.text(page(program, *name));
        output.finish();
        return static_cast<int>(exit_done);
      });
  command->add_option("PAGE", *name, "A command, or case: the format of case files")->type_name("PAGE");
}

}  // namespace

Command manual_command() {
  return {
      {"manual",
       install_group,
       "Prints a manual page in roff: of limcycle, of one of its commands, or, with `case`, of the case-file format.",
       {{"limcycle manual > limcycle.1", "of the program"},
        {"limcycle manual predict > limcycle-predict.1", "of a command"},
        {"limcycle manual case > limcycle-case.5", "of case files"}}},
      add_manual};
}

}  // namespace limcycle
