#include "limcycle/reports/case_files/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

std::string heading(const std::string& group) {
  if (group == "friction") return "Friction laws ([loop.friction], or [loop.element])";
  if (group == "element") return "Elements ([loop.element])";
  if (group == "error element") return "Elements on the error ([loop.error]; also dead-zone and saturation)";
  if (group == "plant") return "Plants ([loop.plant])";
  return group == "controller" ? "Controllers ([loop.controller])" : "Linear blocks ([[diagram.block]])";
}

/// Cut at a word, so that a listing has one line a kind.
std::string shortened(const std::string& text, std::size_t width) {
  if (text.size() <= width) return text;
  const auto space = text.rfind(' ', width - 3);
  return text.substr(0, space) + "...";
}

Json parameter_json(const ParameterEntry& parameter) {
  Json value = text_or_null(parameter.default_name);
  if (parameter.default_value) value = number(*parameter.default_value);
  return {{"key", parameter.key},
          {"unit", parameter.unit},
          {"type", parameter.type},
          {"required", parameter.required},
          {"default", value},
          {"default_from", text_or_null(parameter.default_from)},
          {"range",
           {{"low", number(parameter.range.low)},
            {"high", number(parameter.range.high)},
            {"low_open", parameter.range.low_open},
            {"high_open", parameter.range.high_open}}},
          {"choices", parameter.choices},
          {"meaning", parameter.meaning}};
}

/// Number of continuous states in words.
std::string states_sentence(const CatalogueEntry& entry) {
  if (entry.states) return states_text(entry);
  if (!entry.states_per_entry) return "by the lists";
  const std::string each = *entry.states_per_entry == 1 ? "" : fmt::format("{} times ", *entry.states_per_entry);
  return fmt::format("by the lists: {}as many as elements{} ({})", each,
                     entry.states_beside == 0 ? "" : fmt::format(", and {} beside them", entry.states_beside),
                     states_text(entry));
}

/// Properties of a friction law beyond its equation, one item a line.
std::string features_text(const Features& features) {
  std::string text;
  for (const auto& [label, what] : {std::pair{"drift", features.drift},
                                    {"rate", features.rate},
                                    {"passive", features.passivity},
                                    {"confirmed", features.evidence}})
    if (!what.empty()) text += item(label, 9, std::string(what));
  return item("memory", 9, std::string(to_string(features.memory))) + text;
}

Json features_json(const CatalogueEntry& entry) {
  if (!entry.features) return nullptr;
  const Features& features = *entry.features;
  return {{"memory", to_string(features.memory)},
          {"drifts", features.drifts},
          {"drift", text_or_null(std::string(features.drift))},
          {"rate", text_or_null(std::string(features.rate))},
          {"passivity", text_or_null(std::string(features.passivity))},
          {"evidence", text_or_null(std::string(features.evidence))}};
}

}  // namespace

std::string states_text(const CatalogueEntry& entry) {
  if (entry.states)
    return *entry.states == *entry.most_states ? std::to_string(*entry.states)
                                               : fmt::format("{}-{}", *entry.states, *entry.most_states);
  if (!entry.states_per_entry) return "any";
  return (*entry.states_per_entry == 1 ? "N" : fmt::format("{}N", *entry.states_per_entry)) +
         (entry.states_beside == 0 ? "" : fmt::format("+{}", entry.states_beside));
}

std::string default_text(const ParameterEntry& parameter) {
  if (parameter.required) return "required";
  if (!parameter.default_from.empty()) return "as " + parameter.default_from;
  if (parameter.default_value)
    return std::isfinite(*parameter.default_value) ? shortest(*parameter.default_value) : "none";
  return parameter.default_name.empty() ? "none" : parameter.default_name;
}

std::string range_text(const ParameterEntry& parameter) {
  if (parameter.type == "choice") return fmt::format("{}", fmt::join(parameter.choices, " | "));
  const Range& range = parameter.range;
  const std::string low = (range.low_open ? "> " : ">= ") + shortest(range.low);
  const std::string high = (range.high_open ? "< " : "<= ") + shortest(range.high);
  const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
  const std::string of = parameter.type == "number" ? "" : parameter.type == "complex list" ? "list" : parameter.type;
  const std::string limits = below && above ? low + " and " + high : below ? low : above ? high : "";
  if (limits.empty()) return of.empty() ? "any" : of;
  return of.empty() ? limits : of + ", each " + limits;
}

std::string laws_text(const std::vector<CatalogueEntry>& entries) {
  constexpr std::size_t page_width = 80;
  std::string text, group;
  const auto widest = std::ranges::max(entries, {}, [](const auto& entry) { return entry.kind.size(); }).kind.size();
  for (const auto& entry : entries) {
    if (entry.group != group) {
      group = entry.group;
      text +=
          fmt::format("{}{}\n  {:<{}}  states  equation\n", text.empty() ? "" : "\n", heading(group), "kind", widest);
    }
    text += fmt::format("  {:<{}}  {:>6}  {}\n", entry.kind, widest, states_text(entry),
                        shortened(entry.equation, page_width - 12 - widest));
  }
  return text + "\n" +
         wrapped(
             "N: as many states as the lists have entries. 'limcycle laws KIND' prints the parameters, units, defaults "
             "and source of one of them, and the features of a friction law.");
}

std::string law_text(const std::vector<CatalogueEntry>& entries) {
  std::string text;
  for (const auto& entry : entries) {
    if (!text.empty()) text += '\n';
    text += fmt::format("{} ({})\n{}", entry.kind, entry.group == "friction" ? "friction law" : entry.group,
                        wrapped(entry.equation, 80, 2));
    text += item("states", 9, states_sentence(entry));
    if (entry.features) text += features_text(*entry.features);
    if (!entry.source.empty()) text += item("source", 9, entry.source);
    Table table{.columns = {{"key", "", Align::left},
                            {"unit", "", Align::left},
                            {"default", "", Align::left},
                            {"valid", "", Align::left},
                            {"meaning", "", Align::left}},
                .rows = {}};
    for (const auto& parameter : entry.parameters) {
      const bool choice = parameter.type == "choice";  // its names are too long for a column of their own
      table.rows.push_back({parameter.key, parameter.unit == "1" ? "-" : parameter.unit, default_text(parameter),
                            choice ? "a name" : range_text(parameter),
                            parameter.meaning + (choice ? ": " + range_text(parameter) : "")});
    }
    if (!table.rows.empty()) text += '\n' + table.with_last_wrapped();
  }
  return text;
}

std::string laws_json(const Provenance& provenance, const std::vector<CatalogueEntry>& entries) {
  Json laws = Json::array();
  for (const auto& entry : entries) {
    Json parameters = Json::array();
    for (const auto& parameter : entry.parameters) parameters.push_back(parameter_json(parameter));
    laws.push_back({{"group", entry.group},
                    {"kind", entry.kind},
                    {"states", or_null(entry.states)},
                    {"most_states", or_null(entry.most_states)},
                    {"states_per_entry", or_null(entry.states_per_entry)},
                    {"states_beside", entry.states_per_entry ? Json(entry.states_beside) : Json(nullptr)},
                    {"equation", entry.equation},
                    {"source", text_or_null(entry.source)},
                    {"features", features_json(entry)},
                    {"parameters", parameters}});
  }
  return json_document("laws", provenance, json_text({{"laws", laws}}));
}

std::string laws_csv(const std::vector<CatalogueEntry>& entries) {
  std::string text = csv_line({"group", "kind", "key", "unit", "type", "required", "default", "low", "high", "meaning",
                               "states", "memory", "drifts", "drift", "rate", "passivity", "evidence"});
  for (const auto& entry : entries) {
    std::vector<std::string> tail{states_text(entry)};
    if (entry.features) {
      const Features& f = *entry.features;
      tail.emplace_back(to_string(f.memory));
      tail.emplace_back(f.drifts ? "true" : "false");
      for (const std::string_view words : {f.drift, f.rate, f.passivity, f.evidence}) tail.emplace_back(words);
    } else {
      tail.resize(7);
    }
    const auto line = [&](std::vector<std::string> fields) {
      fields.insert(fields.end(), tail.begin(), tail.end());
      text += csv_line(fields);
    };
    if (entry.parameters.empty()) line({entry.group, entry.kind, "", "", "", "", "", "", "", ""});
    for (const auto& p : entry.parameters)
      line({entry.group, entry.kind, p.key, p.unit, p.type, p.required ? "true" : "false",
            p.default_value ? shortest(*p.default_value) : p.default_name + p.default_from, shortest(p.range.low),
            shortest(p.range.high), p.meaning});
  }
  return text;
}

}  // namespace limcycle
