#include "limcycle/reports/case_files/laws.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/output.hpp"

namespace limcycle {
namespace {

int laws(const CommonFlags& flags, const std::string& kind, bool markdown) {
  auto entries = catalogue();
  if (!kind.empty()) {
    std::vector<std::string> kinds;
    for (const auto& entry : entries)
      if (std::ranges::find(kinds, entry.kind) == kinds.end()) kinds.push_back(entry.kind);
    std::erase_if(entries, [&](const auto& entry) { return entry.kind != kind; });
    if (entries.empty())
      throw InputError({.file = {},
                        .line = 0,
                        .override = {},
                        .key = "laws",
                        .value = {},
                        .rule = "unknown kind '" + kind + "'",
                        .suggestion = suggest(kind, kinds)});
  }
  Output output(flags);
  output.text(markdown ? laws_markdown(entries) : kind.empty() ? laws_text(entries) : law_text(entries));
  if (output.wants_json()) output.json(laws_json(provenance(flags), entries));
  if (output.wants_csv()) output.csv(laws_csv(entries));
  output.finish();
  return exit_done;
}

void add_laws(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CommonFlags>();
  flags->has_tables = false;
  const auto kind = std::make_shared<std::string>();
  const auto markdown = std::make_shared<bool>(false);
  auto* command =
      add_command(program, action, "laws", "Laws, elements, plants and controllers: parameters, units, equations",
                  false, flags, [flags, kind, markdown] { return laws(*flags, *kind, *markdown); });
  command->add_option("KIND", *kind, "One of them, in full")->type_name("NAME");
  command->add_flag("--markdown", *markdown, "The friction laws as a page of documentation");
}

}  // namespace

Command laws_command() {
  return {
      {"laws",
       begin_group,
       "Lists the friction laws, elements, plants and controllers that a case may name. With KIND it describes that "
       "one: equation, states, memory, drift, passivity, source, and every parameter with unit, default and valid "
       "range.",
       {{"limcycle laws", "all of them"}, {"limcycle laws lugre", "one in full"}}},
      add_laws};
}

}  // namespace limcycle
