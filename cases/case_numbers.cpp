#include "limcycle/cases/case_numbers.hpp"

#include <algorithm>
#include <cstdio>

namespace limcycle {
namespace {

template <class Owner>
void append(std::vector<CaseNumber>& list, const std::string& section, const Owner& owner) {
  const auto table = Owner::parameters();
  const auto value_of = [&](std::string_view key) -> std::optional<double> {
    for (const auto& parameter : table)
      if (const auto* number = std::get_if<double Owner::*>(&parameter.member); number && parameter.key == key)
        return owner.*(*number);
    return std::nullopt;
  };
  for (const auto& parameter : table) {
    const auto value = value_of(parameter.key);
    if (!value) continue;
    CaseNumber one{section + "." + std::string(parameter.key), std::string(parameter.unit),
                   std::string(parameter.meaning), *value, false};
    one.follows = !parameter.default_from.empty() && value_of(parameter.default_from) == value;
    list.push_back(std::move(one));
  }
}

template <class... Kinds>
void append(std::vector<CaseNumber>& list, const std::string& section, const std::variant<Kinds...>& any) {
  std::visit([&](const auto& owner) { append(list, section, owner); }, any);
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
