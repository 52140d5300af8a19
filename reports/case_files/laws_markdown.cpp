#include <fmt/format.h>

#include "limcycle/reports/case_files/laws.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

/// Text for a cell of a table, which a bar would end.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out.empty() ? "-" : out;
}

/// Text outside code, with the marks of Markdown escaped.
std::string prose(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '*' || c == '_' || c == '`' || c == '<' || c == '[' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

/// First clause of a sentence, for the table; the section of the law has the whole text.
std::string clause(std::string_view text) { return cell(prose(text.substr(0, text.find_first_of(":;")))); }

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const auto& text : cells) line += ' ' + text + " |";
  return line + '\n';
}

std::string table(const std::vector<std::string>& heading, const std::vector<std::vector<std::string>>& rows) {
  std::string text = row(heading) + row(std::vector<std::string>(heading.size(), "---"));
  for (const auto& cells : rows) text += row(cells);
  return text;
}

/// Section of one law; `marks`: those of its heading.
std::string section(const CatalogueEntry& entry, const char* marks) {
  std::string text = fmt::format("\n{} {}\n\n```\n{}```\n", marks, entry.kind, wrapped(entry.equation, 100));
  if (entry.features || !entry.source.empty()) text += '\n';
  const Features features = entry.features.value_or(Features{});
  const auto item = [&](const char* label, std::string_view words) {
    if (!words.empty()) text += fmt::format("- {}: {}\n", label, prose(words));
  };
  item("source", entry.source);
  item("confirmed", features.evidence);
  if (entry.features) item("memory", to_string(features.memory));
  item("drift", features.drift);
  item("rate of motion", features.rate);
  item("passive from v to F", features.passivity);
  std::vector<std::vector<std::string>> rows;
  for (const auto& parameter : entry.parameters)
    rows.push_back({"`" + parameter.key + "`", parameter.unit == "1" ? "-" : cell(parameter.unit),
                    cell(prose(default_text(parameter))), cell(prose(range_text(parameter))),
                    cell(prose(parameter.meaning))});
  return rows.empty() ? text : text + '\n' + table({"key", "unit", "default", "valid", "meaning"}, rows);
}

/// Elements other than friction that are allowed in a loop, group by group.
std::string other_groups(const std::vector<CatalogueEntry>& entries) {
  struct Group {
    const char *name, *heading, *words;
  };
  constexpr Group groups[] = {
      {"element", "Elements",
       "In `[loop.element]`, in series after the controller. A friction law may stand there too."},
      {"error element", "Elements on the error",
       "In `[loop.error]`, between the error e = r - y and the controller: this one, `dead-zone` and `saturation`."},
      {"plant", "Plants", "In `[loop.plant]`. F is the friction, u the command."},
      {"controller", "Controllers",
       "In `[loop.controller]`. Any of them may have a friction compensation, a saturation and a lag behind it, in "
       "this order."},
      {"block", "Linear blocks",
       "In `[[diagram.block]]`, besides all friction laws, elements and plants and the controller `pid`. u is the sum "
       "written as `input`."}};
  std::string text;
  for (const auto& group : groups) {
    text += fmt::format("\n## {}\n\n{}\n", group.heading, group.words);
    for (const auto& entry : entries)
      if (entry.group == group.name) text += section(entry, "###");
  }
  return text;
}

}  // namespace

std::string laws_markdown(const std::vector<CatalogueEntry>& entries) {
  std::vector<std::vector<std::string>> rows;
  std::string sections;
  for (const auto& entry : entries) {
    if (entry.group != "friction") continue;
    const Features features = entry.features.value_or(Features{});
    rows.push_back({fmt::format("[{0}](#{0})", entry.kind), states_text(entry), std::string(to_string(features.memory)),
                    clause(features.drift), cell(prose(features.rate)), clause(features.passivity),
                    cell(prose(features.evidence))});
    sections += section(entry, "##");
  }
  return "# Friction laws, elements, plants and controllers\n\n<!-- Made by tools/laws --fix from what the program "
         "knows; a test compares the two. "
         "-->\n\n"
         "What a case file may name as a `kind`, with its equation, keys and sources: the friction laws, then "
         "[elements](#elements),\n[plants](#plants), [controllers](#controllers) and the [linear "
         "blocks](#linear-blocks) of "
         "diagrams.\n\n"
         "F opposes the velocity v; z is a deflection, g(v) the Stribeck level, sgn the sign. *States* counts the "
         "continuous\nones (N: as many as the lists have entries). *Memory*: local is the present state alone, "
         "non-local the return points,\nso that closed minor loops close. *Drift*: does a bounded periodic force "
         "below Fc move the body on, cycle by cycle.\n*Passive*: no more work can be taken out than was stored. The "
         "conformance tests hold every law against its row.\n\n" +
         table({"law", "states", "memory", "drift", "rate of motion", "passive", "confirmed"}, rows) + sections +
         other_groups(entries);
}

}  // namespace limcycle
