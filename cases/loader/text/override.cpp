#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle::case_file {
namespace {

constexpr std::size_t deepest_path = 16;

bool is_bare(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
}

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> names;
  for (std::size_t begin = 0;;) {
    const std::size_t end = path.find('.', begin);
    names.push_back(trimmed(path.substr(begin, end == std::string_view::npos ? end : end - begin)));
    if (end == std::string_view::npos) return names;
    begin = end + 1;
  }
}

}  // namespace

void apply_override(Document& document, const std::string& override) {
  const auto refuse = [&](const std::string& rule, const std::string& hint = {}) -> InputError {
    // The key of the error is the part before '=', so that the message shows the override once.
    return InputError({.file = document.file,
                       .line = 0,
                       .override = override.empty() ? "''" : override,
                       .key = override.empty() ? "''" : override.substr(0, override.find('=')),
                       .value = {},
                       .rule = rule,
                       .suggestion = hint});
  };
  const auto equals = override.find('=');
  if (equals == std::string::npos) throw refuse("must be PATH=VALUE, such as loop.controller.kd=6.0");
  const auto names = split(std::string_view(override).substr(0, equals));
  if (names.size() > deepest_path) throw refuse("PATH has too many parts");
  if (!std::ranges::all_of(names, is_bare))
    throw refuse("PATH must be names joined by dots, such as loop.controller.kd");

  const int index = static_cast<int>(document.overrides.size());
  const std::string text = trimmed(std::string_view(override).substr(equals + 1));
  Value value;
  try {
    value = parse_value(text, index);
  } catch (const std::invalid_argument& error) {
    const bool word = is_bare(text) && std::isalpha(static_cast<unsigned char>(text.front())) != 0;
    throw refuse(error.what(),
                 word ? "a string needs quotes: '" + override.substr(0, equals) + "=\"" + text + "\"'" : "");
  }
  document.overrides.push_back(override);

  Value* at = &document.root;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto* table = std::get_if<Value::Table>(&at->data);
    if (table == nullptr) throw refuse("'" + names[i - 1] + "' is a " + type_name(*at) + ", not a table");
    auto entry = std::ranges::find(*table, names[i], &Value::Entry::key);
    if (entry == table->end()) {
      Value created;
      created.override = index;
      table->push_back({names[i], std::move(created)});
      entry = std::prev(table->end());
    }
    at = &entry->value;
  }
  *at = std::move(value);
}

}  // namespace limcycle::case_file
