#include "limcycle/cli/help/command_facts.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "limcycle/analysis/study/claims/run_claims.hpp"
#include "limcycle/analysis/study/experiments/experiment.hpp"
#include "limcycle/analysis/study/map/hunting_map.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"

namespace limcycle {
namespace {

std::vector<std::string> all_kinds() {
  std::vector<std::string> kinds;
  for (const auto& entry : catalogue())
    if (std::ranges::find(kinds, entry.kind) == kinds.end()) kinds.push_back(entry.kind);
  return kinds;
}

/// Words to offer for an option that the parser takes as a free word, which the command itself validates.
std::vector<std::string> words_for(const std::string& command, const OptionFacts& option) {
  const std::string key = command + " " + option.name;
  if (key == "laws KIND") return all_kinds();
  if (command == "new" && option.value == "KIND") return kinds_for("loop." + option.name.substr(2));
  if (key == "experiment --law") return kinds_for("loop.friction");
  if (key == "map --methods") return names_of({true, true, true});
  if (key == "completion SHELL") return {"bash", "zsh", "fish"};
  std::vector<std::string> names;
  if (key == "experiment NAME")
    for (const auto& entry : experiments()) names.emplace_back(entry.name);
  if (key == "claims ID")
    for (const auto& claim : claims()) names.push_back(claim.id);
  if (key == "manual PAGE")
    for (const auto& one : commands()) names.emplace_back(one.description.name);
  if (key == "experiment NAME") names.emplace_back("all");
  if (key == "manual PAGE") names.emplace_back("case");
  return names;
}

/// The parser appends the rule of a value to its type: "NAME:{auto,x86-64}", and those of option_values.hpp
/// "N:in [0 to 1024]" and "V:in (> 0)".
void split_type(const std::string& written, OptionFacts& into) {
  const auto begin = std::min({written.find(":{"), written.find(":in ["), written.find(":in (")});
  into.value = written.substr(0, begin);
  if (begin == std::string::npos) return;
  const std::string rule = written.substr(begin + 1);
  if (rule.starts_with('{')) {
    for (std::size_t from = 1; from < rule.size();) {
      const std::size_t end = rule.find_first_of(",}", from);
      into.choices.push_back(rule.substr(from, end - from));
      from = end + 1;
    }
  } else {
    into.rule = rule.substr(4, rule.find_first_of(")]") - 4);
  }
}

OptionFacts option_facts(const CLI::Option& option, const std::string& command) {
  OptionFacts facts;
  facts.argument = option.get_positional();
  facts.name = facts.argument ? option.get_name(true) : "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) facts.letter = "-" + option.get_snames().front();
  if (facts.argument || option.get_items_expected_max() > 0) split_type(option.get_type_name(), facts);
  facts.meaning = option.get_description();
  facts.default_value = option.get_default_str();
  if (facts.default_value.starts_with('[') && facts.default_value.ends_with(']'))
    facts.default_value = facts.default_value.substr(1, facts.default_value.size() - 2);
  facts.required = option.get_required();
  facts.common =
      option.get_group() == "Options of every command" || facts.name == "--help" || facts.name == "--version";
  if (facts.choices.empty()) facts.choices = words_for(command, facts);
  return facts;
}

}  // namespace

std::vector<CommandFacts> facts_of(const CLI::App& program) {
  std::vector<CommandFacts> all;
  for (const auto& [description, add] : commands()) {
    const auto* command = program.get_subcommand(std::string(description.name));
    CommandFacts facts{command->get_name(), command->get_description(), description, {}};
    for (const auto* option : command->get_options()) facts.options.push_back(option_facts(*option, facts.name));
    std::ranges::stable_sort(facts.options, {}, [](const OptionFacts& one) {
      return one.argument ? 0 : one.common ? 2 : 1;
    });
    all.push_back(std::move(facts));
  }
  return all;
}

std::string usage(const CommandFacts& command) {
  std::string text = "limcycle " + command.name;
  for (const auto& option : command.options) {
    if (option.argument) text += option.required ? " " + option.name : " [" + option.name + "]";
    if (!option.argument && option.required) text += " " + option.name + " " + option.value;
  }
  return text + " [OPTIONS]";
}

std::string spelling(const OptionFacts& option) {
  if (option.argument) return option.name;
  return (option.letter.empty() ? "" : option.letter + ", ") + option.name +
         (option.value.empty() ? "" : " " + option.value);
}

std::string full_meaning(const OptionFacts& option, std::size_t most) {
  std::string text = option.meaning;
  if (!option.choices.empty() && option.choices.size() <= most)
    text += fmt::format(": {}", fmt::join(option.choices, ", "));
  std::vector<std::string> more;
  if (option.required && !option.argument) more.emplace_back("required");
  if (!option.rule.empty()) more.push_back(option.rule);
  if (!option.default_value.empty()) more.push_back("default " + option.default_value);
  return text + (more.empty() ? "" : fmt::format(" ({})", fmt::join(more, "; ")));
}

const std::vector<std::string>& exit_codes() {
  static const std::vector<std::string> codes{
      "done, whether or not a limit cycle exists", "a claim or a required agreement failed",
      "wrong usage or input; one line on stderr names the key, its place and what is allowed",
      "no answer: undecided, interrupted, or a result could not be written"};
  return codes;
}

}  // namespace limcycle
