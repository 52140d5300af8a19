#include "limcycle/cases/loader/case_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <variant>

#include "limcycle/cases/loader/owned_parts.hpp"
#include "limcycle/models/linear/plant_signals.hpp"

namespace limcycle {
namespace {

void append(std::vector<CaseNumber>& list, const std::string& section, const std::vector<ParameterRow>& rows,
            const std::vector<ParameterValue>& values) {
  for (const auto& row : rows) {
    const auto value = number_of(rows, values, row.key);
    if (!value) continue;
    CaseNumber one{section + "." + std::string(row.key), std::string(row.unit), std::string(row.meaning), *value,
                   false};
    one.follows = !row.default_from.empty() && number_of(rows, values, row.default_from) == value;
    list.push_back(std::move(one));
  }
}

/// That of y; "1" where it is not known.
std::string unit_of_reference(const LoopParts& parts) {
  if (parts.diagram) return "1";
  switch (std::visit([]<class Kind>(const Kind&) { return Kind::signals; }, parts.plant)) {
    case PlantSignals::lengths_and_forces:
      return "m";
    case PlantSignals::angles_and_torques:
      return "rad";
    case PlantSignals::unknown:
      break;
  }
  return "1";
}

}  // namespace

std::vector<CaseNumber> numbers_of(const Case& from) {
  std::vector<CaseNumber> list;
  if (!from.loop) {
    if (from.element) append(list, from.element_path, from.element->parameters(), from.element->values());
    return list;
  }
  const LoopParts& parts = *from.loop;
  for (const auto& part : case_file::owned_parts(parts)) {
    append(list, part.section, part.rows(parts), part.values(parts));
    std::erase_if(list, [&](const CaseNumber& one) {
      return one.path.starts_with(part.section + ".") && is_elsewhere(part, one.path.substr(part.section.size() + 1));
    });
  }
  const std::string reference = parts.diagram ? "diagram.reference" : "loop.reference", unit = unit_of_reference(parts);
  if (parts.reference_rate != 0.0)
    list.push_back({reference + ".rate", unit + "/s", "slope of the reference", parts.reference_rate, false});
  else
    list.push_back({reference, unit, "set-point", parts.reference, false});
  if (!parts.diagram) list.push_back({"loop.load", "N", "constant force", parts.load, false});
  return list;
}

CaseNumber number_at(const Case& from, const std::string& argument, const std::string& path) {
  const auto list = numbers_of(from);
  const auto found = std::ranges::find(list, path, &CaseNumber::path);
  if (found != list.end()) return *found;
  std::vector<std::string> paths;
  paths.reserve(list.size());
  for (const auto& one : list) paths.push_back(one.path);
  throw InputError({.file = {},
                    .line = 0,
                    .override = {},
                    .key = argument,
                    .value = path,
                    .rule = "is not a parameter of this loop that is one number",
                    .suggestion = suggest(path, paths)});
}

CaseNumber number_named(const Case& from, const std::string& argument, const std::string& name) {
  std::vector<CaseNumber> found;
  std::vector<std::string> names;
  for (const auto& one : numbers_of(from)) {
    if (one.path == name) return one;
    if (one.path.ends_with("." + name)) found.push_back(one);
    names.push_back(name.find('.') == std::string::npos ? one.path.substr(one.path.rfind('.') + 1) : one.path);
  }
  if (found.size() == 1) return found.front();
  const auto refused = [&](std::string rule, std::string suggestion) {
    return InputError({.file = {},
                       .line = 0,
                       .override = {},
                       .key = argument,
                       .value = name,
                       .rule = std::move(rule),
                       .suggestion = std::move(suggestion)});
  };
  if (!found.empty())
    throw refused("is the name of several numbers", "write " + found[0].path + " or " + found[1].path);
  throw refused("is not a parameter of this loop that is one number", suggest(name, names));
}

std::string override_of(const std::string& path, double value) {
  char text[40];
  const std::string number(text, std::to_chars(text, text + sizeof text, value).ptr);
  return path + "=" + number + (number.find_first_of(".en") == std::string::npos ? ".0" : "");
}

std::optional<Case> case_with(const Case& from, std::span<const std::pair<std::string, double>> values) {
  auto overrides = from.overrides;
  for (const auto& [path, value] : values) overrides.push_back(override_of(path, value));
  try {
    return read_again(from, overrides);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace limcycle
