#include <toml++/toml.h>

#include <algorithm>
#include <stdexcept>

#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle::case_file {
namespace {

/// Converts a TOML tree to our own, so that only this file uses the parser. `override` >= 0: line numbers are ignored.
Value convert(const toml::node& node, int override) {
  Value value;
  value.override = override;
  value.line = override < 0 ? static_cast<int>(node.source().begin.line) : 0;
  node.visit([&](const auto& typed) {
    using T = std::decay_t<decltype(typed)>;
    if constexpr (toml::is_table<T>) {
      Value::Table table;
      for (const auto& [key, child] : typed) table.push_back({std::string(key.str()), convert(child, override)});
      // In the order of the file, not of the alphabet, so that the first mistake is the one reported.
      std::ranges::stable_sort(table, {}, [](const Value::Entry& entry) { return entry.value.line; });
      value.data = std::move(table);
    } else if constexpr (toml::is_array<T>) {
      Value::List list;
      list.reserve(typed.size());
      for (const auto& child : typed) list.push_back(convert(child, override));
      value.data = std::move(list);
    } else if constexpr (toml::is_string<T> || toml::is_integer<T> || toml::is_floating_point<T> ||
                         toml::is_boolean<T>) {
      value.data = typed.get();
    } else {
      value.data = Value::Other{"date or time"};
    }
  });
  return value;
}

std::string description(const toml::parse_error& error) {
  std::string text(error.description());
  // The parser's message begins with its place, which line and column show already.
  constexpr std::string_view opening = "Error while parsing ";
  if (text.starts_with(opening)) text.erase(0, opening.size());
  return text;
}

}  // namespace

Document parse(std::string_view text, const std::string& file) {
  try {
    Document document;
    document.file = file;
    document.root = convert(toml::parse(text), -1);
    document.root.line = 1;
    name_blocks(document);
    return document;
  } catch (const toml::parse_error& error) {
    throw InputError(
        {.file = file,
         .line = static_cast<int>(error.source().begin.line),
         .override = {},
         .key = {},
         .value = {},
         .rule = "not valid TOML at column " + std::to_string(error.source().begin.column) + ": " + description(error),
         .suggestion = {}});
  }
}

Value parse_value(std::string_view text, int override) {
  if (nested_too_deep(text) != std::string_view::npos) throw std::invalid_argument("nested too deeply for a case");
  try {
    const toml::table table = toml::parse("v = " + std::string(text) + "\n");
    const toml::node* node = table.get("v");
    if (node == nullptr || table.size() != 1) throw std::invalid_argument("must be one TOML value");
    return convert(*node, override);
  } catch (const toml::parse_error& error) {
    throw std::invalid_argument("not a TOML value (" + description(error) + ")");
  }
}

}  // namespace limcycle::case_file
