#include "limcycle/cli/help/help.hpp"

#include <algorithm>
#include <sstream>

#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

constexpr std::size_t label_width = 24;

/// "  LABEL    text", the text wrapped next to the label, or under it if the label is too long.
std::string entry(const std::string& label, std::size_t width, const std::string& text) {
  if (display_width(label) <= width) return item("  " + label, width + 2, text);
  return "  " + label + '\n' + wrapped(text, 80, width + 4);
}

std::string paragraphs(std::string_view text) {
  std::string out;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) out += '\n' + wrapped(line);
  return out;
}

std::string options_text(const CommandFacts& command, const std::string& heading, auto&& belongs) {
  std::string text;
  for (const auto& option : command.options) {
    if (!belongs(option)) continue;
    text += entry(spelling(option), label_width, full_meaning(option, 5));
  }
  return text.empty() ? text : "\n" + heading + "\n" + text;
}

/// A command line, continued before an option if it is too long, in shell syntax.
std::string command_line(std::string_view line) {
  std::string out = "  ";
  std::size_t column = 2;
  for (std::size_t from = 0; from < line.size();) {
    const std::size_t end = std::min(line.find(" -", from + 1), line.size());
    const std::string_view part = line.substr(from, end - from);
    if (column + part.size() > 78 && from > 0) {
      out += " \\\n     ";
      column = 5;
    }
    out += part;
    column += part.size();
    from = end;
  }
  return out + '\n';
}

std::string examples_text(const Description& description) {
  std::string text;
  for (const auto& example : description.examples) text += command_line(example.line) + wrapped(example.what, 80, 6);
  return text.empty() ? text : "\nExamples\n" + text;
}

}  // namespace

std::string program_help(const std::vector<CommandFacts>& commands) {
  std::string text =
      "limcycle: will this feedback loop hunt?\n\n"
      "Usage: limcycle COMMAND [ARGUMENTS]\n"
      "       limcycle COMMAND --help     all options of a command, with examples\n"
      "       limcycle --version\n";
  std::string_view group;
  for (const auto& command : commands) {
    if (command.description.group != group) {
      group = command.description.group;
      text += "\n" + std::string(group) + "\n";
    }
    text += entry(command.name, 14, command.summary);
  }
  text += "\nExit codes\n";
  for (std::size_t i = 0; i < exit_codes().size(); ++i) text += entry(std::to_string(i), 2, exit_codes()[i]);
  return text +
         "\nNext steps\n"
         "  limcycle new -o servo.toml      a first case file\n"
         "  limcycle predict servo.toml     the answer\n"
         "  docs/tutorial.md                a step-by-step introduction\n";
}

std::string command_help(const CommandFacts& command) {
  const auto own = [](const OptionFacts& option) { return !option.argument && !option.common; };
  const auto common = [](const OptionFacts& option) { return option.common; };
  const auto argument = [](const OptionFacts& option) { return option.argument; };
  return "Usage: " + wrapped(usage(command), 80, 7).substr(7) + "\n" + wrapped(command.summary + ".") +
         paragraphs(command.description.text) + options_text(command, "Arguments", argument) +
         options_text(command, "Options", own) + options_text(command, "Options of every command", common) +
         examples_text(command.description);
}

}  // namespace limcycle
