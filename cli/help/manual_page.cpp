#include "limcycle/cli/help/manual_page.hpp"

#include <fmt/format.h>

#include "limcycle/cli/help/roff.hpp"
#include "limcycle/reports/case_files/case_format.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/reports/case_files/laws.hpp"
#include "limcycle/reports/case_files/new_case.hpp"

namespace limcycle {
namespace {

/// "limcycle-predict \- every limit cycle ...": the line that `man -k` and `whatis` read.
std::string name_section(const std::string& name, std::string summary) {
  if (summary.size() > 1 && summary[1] >= 'a' && summary[1] <= 'z')
    summary[0] = static_cast<char>(summary[0] >= 'A' && summary[0] <= 'Z' ? summary[0] - 'A' + 'a' : summary[0]);
  return roff::section("name") + roff::escaped(name) + " \\- " + roff::escaped(summary) + "\n";
}

std::string exit_section() {
  std::string text = roff::section("exit status");
  for (std::size_t i = 0; i < exit_codes().size(); ++i)
    text += roff::tagged(roff::bold(std::to_string(i)), exit_codes()[i] + ".");
  return text;
}

std::string environment_section() {
  return roff::section("environment") +
         roff::tagged(roff::bold("NO_COLOR"),
                      "If it is set and not empty there are no colours without --color always.") +
         roff::tagged(roff::bold("TERM"), "With the value dumb, or not set, there are none either.");
}

/// The section "see also".
std::string see_also(const std::vector<std::string>& pages) {
  std::string text = roff::section("see also");
  for (const auto& page : pages)
    text += "\\%" + roff::bold(page.substr(0, page.find('('))) + page.substr(page.find('(')) +
            (&page == &pages.back() ? "\n" : ",\n");
  return text;
}

std::string option_item(const OptionFacts& option) {
  std::string label = option.argument ? roff::italic(option.name) : roff::bold(option.name);
  if (!option.letter.empty()) label = roff::bold(option.letter) + ", " + label;
  if (!option.argument && !option.value.empty()) label += " " + roff::italic(option.value);
  return roff::tagged(label, full_meaning(option, 30) + ".");
}

std::string options_section(const CommandFacts& command, const std::string& title, auto&& belongs) {
  std::string text;
  for (const auto& option : command.options)
    if (belongs(option)) text += option_item(option);
  return text.empty() ? text : roff::section(title) + text;
}

std::string examples_section(const Description& description) {
  std::string text = roff::section("examples");
  for (const auto& example : description.examples)
    text += ".PP\n" + roff::escaped(example.what) + ":\n" + roff::verbatim(example.line);
  return text;
}

std::string parameter_text(const ParameterEntry& parameter) {
  std::string text = parameter.meaning;
  if (parameter.unit != "1") text += ", " + parameter.unit;
  text += "; " + range_text(parameter);
  return text + (parameter.required ? "; required." : "; default " + default_text(parameter) + ".");
}

/// The kinds of one group of the catalogue, with the keys of each.
std::string kinds_text(const std::string& group, const std::string& section, const std::string& what) {
  std::string text = roff::subsection(section) + roff::paragraphs(what);
  for (const auto& entry : catalogue()) {
    if (entry.group != group) continue;
    text += roff::tagged(roff::bold("kind = \"" + entry.kind + "\""), entry.equation);
    for (const auto& parameter : entry.parameters)
      text += ".RS\n" + roff::tagged(roff::bold(parameter.key), parameter_text(parameter)) + ".RE\n";
  }
  return text;
}

std::string keys_text(const CaseSection& section) {
  std::string text = roff::subsection(section.name.empty()      ? "Before any section"
                                      : section.name == "claim" ? "[[claim]]"
                                                                : "[" + std::string(section.name) + "]");
  if (!section.name.empty()) text += roff::paragraphs(section.meaning);
  for (const CaseKey& key : section.keys)
    text += roff::tagged(roff::bold(fmt::format("{} = {}", key.key, key.value)),
                         fmt::format("{}{}.", key.meaning,
                                     key.required ? "; required" : fmt::format("; default {}", key.default_value)));
  return text;
}

}  // namespace

std::string program_page(const std::vector<CommandFacts>& commands, const std::string& version) {
  std::string text = roff::header("limcycle", 1, version) +
                     name_section("limcycle", "limit cycles of feedback loops with friction") +
                     roff::section("synopsis") + roff::bold("limcycle") + " " + roff::italic("COMMAND") +
                     " [ARGUMENTS] [OPTIONS]\n" + roff::section("description");
  text += roff::paragraphs(
      "Determines from one small text file, the case, whether a feedback loop with friction (or a relay, a dead zone, "
      "backlash, a saturation, a dead time) oscillates: which limit cycles describing functions and harmonic balance "
      "predict, which ones the loop really has, and how accurate each prediction is.\n"
      "`limcycle new` writes a first case, `limcycle predict` gives the answer, `limcycle COMMAND --help` lists the "
      "options of a command with examples.");
  text += roff::section("commands");
  std::string_view group;
  std::vector<std::string> pages;
  for (const auto& command : commands) {
    if (command.description.group != group) text += roff::subsection(group = command.description.group);
    text += roff::tagged(roff::bold(command.name), command.summary + ".");
    pages.push_back("limcycle-" + command.name + "(1)");
  }
  pages.emplace_back("limcycle-case(5)");
  return text + exit_section() + environment_section() + see_also(pages);
}

std::string command_page(const CommandFacts& command, const std::string& version) {
  const std::string name = "limcycle-" + command.name;
  return roff::header(name, 1, version) + name_section(name, command.summary) + roff::section("synopsis") +
         roff::escaped(usage(command)) + "\n" + roff::section("description") +
         roff::paragraphs(command.description.text) +
         options_section(command, "arguments", [](const OptionFacts& one) { return one.argument; }) +
         options_section(command, "options", [](const OptionFacts& one) { return !one.argument && !one.common; }) +
         options_section(command, "options of every command", [](const OptionFacts& one) { return one.common; }) +
         examples_section(command.description) + exit_section() + environment_section() +
         see_also({"limcycle(1)", "limcycle-case(5)"});
}

std::string case_page(const std::string& version) {
  std::string text =
      roff::header("limcycle-case", 5, version) + name_section("limcycle-case", "case files of limcycle(1)") +
      roff::section("description") +
      roff::paragraphs(
          "A case is a text file in TOML and UTF-8. Units are SI, angles in rad, frequencies in rad/s; a "
          "rotary drive is the same file in N m and rad. Keys that are not known are refused. A case "
          "with [loop.friction] or [loop.element] alone serves `limcycle df` and `limcycle "
          "dissipativity`; every other command needs [loop.plant] too.\n"
          "On the command line --set PATH=VALUE replaces a value: --set loop.friction.Fs=2.0.") +
      roff::section("sections");
  for (const CaseSection& section : case_sections()) {
    text += keys_text(section);
    if (section.name == "diagram")
      text += kinds_text("block", "[[diagram.block]]",
                         "Besides plants, pid, elements and friction laws. u is the sum written as input.");
    if (section.name != "loop") continue;
    text += kinds_text("plant", "[loop.plant]", "From the command u and the friction force F to the position y.");
    text += kinds_text("controller", "[loop.controller]",
                       "From the error e = r - y to u. Without it u = 0, or u = e "
                       "before an element.");
    text += kinds_text("friction", "[loop.friction]", "Opposes the velocity of the plant.");
    text += kinds_text("element", "[loop.element]",
                       "In series behind the controller. A friction law may stand here too, but for those that need "
                       "the applied force.");
    text += kinds_text("error element", "[loop.error]",
                       "Acts on the error before the controller. dead-zone and saturation may stand here too.");
  }
  return text + roff::section("examples") + ".PP\nA mass under PID control with LuGre friction:\n" +
         roff::verbatim(new_case({})) + see_also({"limcycle(1)", "limcycle-new(1)", "limcycle-check(1)"});
}

}  // namespace limcycle
