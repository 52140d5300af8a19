#include "limcycle/cases/loader/case_numbers.hpp"

#include <algorithm>
#include <cstdio>

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

void append(std::vector<CaseNumber>& list, const std::string& section, const Element& element) {
  append(list, section, element.parameters(), element.values());
}

template <class... Kinds>
void append(std::vector<CaseNumber>& list, const std::string& section, const std::variant<Kinds...>& any) {
  std::visit([&]<class Owner>(const Owner& owner) { append(list, section, rows_of<Owner>(), values_of(owner)); }, any);
}

}  // namespace

std::vector<CaseNumber> numbers_of(const Case& from) {
  std::vector<CaseNumber> list;
  if (!from.loop) {
    append(list, from.element_path, *from.element);
    return list;
  }
  const LoopParts& parts = *from.loop;
  append(list, "loop.plant", parts.plant);
  append(list, "loop.controller", parts.controller);
  if (parts.friction) append(list, "loop.friction", *parts.friction);
  if (parts.element) append(list, "loop.element", *parts.element);
  if (parts.error) append(list, "loop.error", *parts.error);
  if (parts.reference_rate != 0.0)
    list.push_back({"loop.reference.rate", "1/s", "slope of the reference", parts.reference_rate, false});
  else
    list.push_back({"loop.reference", "1", "set-point", parts.reference, false});
  list.push_back({"loop.load", "N", "constant force", parts.load, false});
  return list;
}

CaseNumber number_at(const Case& from, const std::string& flag, const std::string& path) {
  const auto list = numbers_of(from);
  const auto found = std::ranges::find(list, path, &CaseNumber::path);
  if (found != list.end()) return *found;
  std::vector<std::string> paths;
  paths.reserve(list.size());
  for (const auto& one : list) paths.push_back(one.path);
  throw InputError({.file = {},
                    .line = 0,
                    .override = {},
                    .key = flag + " " + path,
                    .value = {},
                    .rule = "is not a parameter of this loop that is one number",
                    .suggestion = suggest(path, paths)});
}

std::optional<Case> case_with(const Case& from, std::span<const std::pair<std::string, double>> values) {
  auto overrides = from.overrides;
  for (const auto& [path, value] : values) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    const std::string number = text;
    overrides.push_back(path + "=" + number + (number.find_first_of(".en") == std::string::npos ? ".0" : ""));
  }
  try {
    return read_case(from.text, from.file, overrides);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace limcycle
