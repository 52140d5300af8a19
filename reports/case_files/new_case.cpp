#include "limcycle/reports/case_files/new_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limcycle/models/element/with_memory/valve_stiction.hpp"
#include "limcycle/models/linear/plants.hpp"
#include "limcycle/reports/case_files/case_format.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/reports/case_files/laws.hpp"
#include "limcycle/reports/case_files/typical_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

constexpr std::size_t case_width = 80, comment_column = 26;

/// Turns a text into comment lines.
std::string commented(const std::string& text) {
  std::string out;
  std::istringstream lines(wrapped(text, case_width - 2));
  for (std::string line; std::getline(lines, line);) out += "# " + line + '\n';
  return out;
}

/// A comment after a label, indented under itself, so that none of its lines looks like a key.
std::string labelled(const std::string& label, const std::string& text) {
  constexpr std::size_t indent = 10;
  const std::string body = wrapped(text, case_width - 2, indent);
  std::string out;
  std::istringstream lines(label + std::string(indent - label.size(), ' ') + body.substr(indent));
  for (std::string line; std::getline(lines, line);) out += "# " + line + '\n';
  return out;
}

/// "key = value   # meaning", the comment wrapped next to the value, or above a value that is too long.
std::string assignment(const std::string& line, const std::string& comment) {
  const std::size_t own = display_width(line);
  if (own + 2 > comment_column) {
    if (own + 4 + display_width(comment) <= case_width) return line + "  # " + comment + '\n';
    return commented(comment) + line + '\n';
  }
  std::string out;
  std::istringstream lines(wrapped(comment, case_width - comment_column - 4));
  for (std::string part; std::getline(lines, part);)
    out += (out.empty() ? line + std::string(comment_column - own, ' ') + "# "
                        : std::string(comment_column, ' ') + "#   ") +
           part + '\n';
  return out;
}

const CatalogueEntry& entry_of(const std::vector<CatalogueEntry>& all, std::initializer_list<const char*> groups,
                               const std::string& kind) {
  for (const char* group : groups)
    for (const auto& entry : all)
      if (entry.group == group && entry.kind == kind) return entry;
  throw std::invalid_argument("no " + std::string(*groups.begin()) + " '" + kind + "'");
}

/// A value for an optional key, as written in a case: its default or, without one, a value to try.
std::string default_in_toml(const ParameterEntry& parameter, const CatalogueEntry& entry, const std::string& group) {
  if (!parameter.default_name.empty()) return '"' + parameter.default_name + '"';
  if (!parameter.default_from.empty())
    return std::string(typical_value(group, entry.kind, parameter.default_from).value);
  if (parameter.type != "number") return "[]";
  const std::string text = shortest(parameter.default_value.value_or(0.0));
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string comment_of(const ParameterEntry& parameter, const TypicalValue& typical) {
  std::string text = parameter.unit == "1" ? parameter.meaning : parameter.unit + ", " + parameter.meaning;
  if (!parameter.choices.empty()) text += fmt::format(": {}", fmt::join(parameter.choices, ", "));
  const bool told = parameter.meaning.find("default") != std::string::npos;
  if (!parameter.required && !told) text += "; default " + default_text(parameter);
  if (!typical.usual.empty())
    text += (typical.usual.starts_with("here ") ? "; " : "; usual: ") + std::string(typical.usual);
  return text;
}

std::string parameter_line(const ParameterEntry& parameter, const CatalogueEntry& entry, const std::string& group,
                           bool brief) {
  const TypicalValue typical = typical_value(group, entry.kind, parameter.key);
  const bool active = parameter.required || (!typical.value.empty() && !typical.only_to_try);
  if (brief && !active) return "";
  const std::string value =
      typical.value.empty() ? default_in_toml(parameter, entry, group) : std::string(typical.value);
  return assignment(fmt::format("{}{} = {}", active ? "" : "# ", parameter.key, value), comment_of(parameter, typical));
}

/// A section of the loop. `typical_group`: group of its typical values; `others`: comment on the other kinds.
std::string section_of(const std::string& section, const CatalogueEntry& entry, const std::string& typical_group,
                       const std::string& others, bool brief) {
  std::string text = "\n[" + section + "]\n" + labelled("equation", entry.equation);
  if (!entry.source.empty()) text += labelled("source", entry.source);
  text += others + fmt::format("kind = \"{}\"\n", entry.kind);
  for (const auto& parameter : entry.parameters) text += parameter_line(parameter, entry, typical_group, brief);
  return text;
}

/// An optional section, active or as a comment.
std::string optional_section(const CaseSection& section, bool active, const std::string& parameters) {
  const std::string mark = active ? "" : "# ";
  std::string text = "\n" + commented(std::string(section.meaning)) + mark + fmt::format("[{}]\n", section.name);
  for (const auto& key : section.keys) {
    std::string value(key.value), comment(key.meaning);
    if (section.name == "sensitivity" && key.key == "parameters") value = parameters;
    if (!key.default_value.empty()) comment += fmt::format("; default {}", key.default_value);
    text += assignment(fmt::format("{}{} = {}", key.required ? mark : "# ", key.key, value), comment);
  }
  return text;
}

/// The parts of the wanted loop, in their order in a case.
struct NewPart {
  std::string section, typical_group;
  const CatalogueEntry* entry;
};

std::vector<NewPart> parts_of(const NewCase& wanted, const std::vector<CatalogueEntry>& all) {
  // An element before or after a controller may need the rate of its input, which must then exist, as must that of a
  // plant of first order for a derivative.
  const bool guarded = !wanted.element.empty() || !wanted.error.empty() || wanted.plant == FirstOrder::kind;
  const char* of_controller = wanted.sampled ? "sampled controller" : guarded ? "guarded controller" : "controller";
  const bool valve = wanted.element == ValveStiction<double>::kind;  // not with dead time
  const char* of_plant = !wanted.friction.empty() ? "plant" : valve ? "plant behind a valve" : "lone plant";
  std::vector<NewPart> parts{{"loop.plant", of_plant, &entry_of(all, {"plant"}, wanted.plant)},
                             {"loop.controller", of_controller, &entry_of(all, {"controller"}, wanted.controller)}};
  if (!wanted.friction.empty())
    parts.push_back({"loop.friction", "friction", &entry_of(all, {"friction"}, wanted.friction)});
  if (!wanted.element.empty()) {
    const CatalogueEntry& entry = entry_of(all, {"element", "friction"}, wanted.element);
    parts.push_back({"loop.element", entry.group, &entry});
  }
  if (!wanted.error.empty())
    parts.push_back({"loop.error", "error element", &entry_of(all, {"error element", "element"}, wanted.error)});
  return parts;
}

/// The number for a first study of the spread: one of the law or element rather than of the plant.
std::string first_number(const std::vector<NewPart>& parts) {
  std::string last;
  for (const auto& part : parts) {
    const auto& own = part.entry->parameters;
    const auto found = std::ranges::find_if(own, [](const auto& one) { return one.type == "number" && one.required; });
    if (found != own.end()) last = part.section + "." + found->key;
  }
  return last;
}

std::string other_kinds(const NewPart& part) {
  auto kinds = kinds_for(part.section);
  std::erase(kinds, part.entry->kind);
  if (part.section == "loop.element") {  // one line of words instead of twenty laws
    const auto laws = kinds_for("loop.friction");
    std::erase_if(kinds, [&](const auto& kind) { return std::ranges::find(laws, kind) != laws.end(); });
    kinds.emplace_back("or a friction law that does not need the applied force");
  }
  return kinds.empty() ? "" : labelled("others", fmt::format("{}", fmt::join(kinds, ", ")));
}

}  // namespace

std::string new_diagram() {
  return commented(
             "A cascade as machine axes have it: a P position loop around a PI velocity loop, a limited command, a "
             "drive with a lag, friction at the axis. It is valid as it is: replace the numbers by your own, add "
             "blocks, join them by the names of their signals. `limcycle check FILE --svg FILE.svg` draws it, "
             "`limcycle laws` "
             "lists the kinds of blocks, `limcycle predict FILE` shows whether the loop hunts.") +
         R"(title = "Axis with a P position loop around a PI velocity loop"

[diagram]
output = "axis.y"          # y of the loop
reference = 0.0            # the signal r, m

[[diagram.block]]
name = "position"          # commands a velocity
kind = "gain"
gain = 30.0                # 1/s
input = "r - axis.y"

[[diagram.block]]
name = "velocity"          # commands a force
kind = "pid"
kp = 2400.0                # N s/m
ki = 120000.0              # N/m
saturation = 800.0         # N
input = "position - axis.v"

[[diagram.block]]
name = "drive"
kind = "low-pass"
time_constant = 0.0005     # s
input = "velocity"

[[diagram.block]]
name = "axis"
kind = "mass"
mass = 12.0                # kg
damping = 40.0             # N s/m
input = "drive"

[[diagram.block]]
name = "guide"
kind = "stribeck"
on = "axis"                # friction acts on a plant; between = ["axis", "load"] on two
Fs = 60.0                  # N
Fc = 40.0                  # N
vs = 0.002                 # m/s
)";
}

std::string new_case(const NewCase& wanted) {
  const auto all = catalogue();
  const auto parts = parts_of(wanted, all);
  std::string title = "New case: " + wanted.plant + ", " + wanted.controller;
  for (const auto* kind : {&wanted.friction, &wanted.element, &wanted.error})
    title += kind->empty() ? "" : ", " + *kind;

  std::string text = commented(
      "A case of limcycle, made by `limcycle new`. It is valid as it is: replace the numbers by your own. " +
      std::string(wanted.brief ? "`limcycle new` without --brief lists the optional keys too. "
                               : "Keys behind a # are optional; the value shown is the default, or an example. ") +
      "SI units, angles in rad, frequencies in rad/s; a rotary drive is the same file in N m and rad. `limcycle check "
      "FILE` reports errors, `limcycle predict FILE` shows whether the loop hunts, `limcycle laws KIND` describes one "
      "kind.");
  text += fmt::format("title = \"{}\"\n", title);
  for (const CaseSection& section : case_sections())
    if (section.name == "loop" && !wanted.brief) text += optional_section(section, true, {});
  for (const NewPart& part : parts)
    text +=
        section_of(part.section, *part.entry, part.typical_group, wanted.brief ? "" : other_kinds(part), wanted.brief);
  const std::string number = first_number(parts);
  for (const CaseSection& section : case_sections()) {
    if (section.name.empty() || section.name == "loop" || section.name == "diagram" || section.name == "claim")
      continue;
    const bool active = wanted.all && (section.name != "sensitivity" || !number.empty());
    if (wanted.brief && !active) continue;
    text += optional_section(section, active, fmt::format("[{{ path = \"{}\", factor = 1.2 }}]", number));
  }
  return text;
}

}  // namespace limcycle
