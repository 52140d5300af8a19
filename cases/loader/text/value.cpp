#include "limcycle/cases/loader/text/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace limcycle::case_file {
namespace {

constexpr std::size_t longest_shown = 60;

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;  // clang 14 does not deduce aggregates

void append(std::string& text, const Value& value) {
  if (text.size() > longest_shown) return;
  std::visit(
      Overload{[&](bool b) { text += b ? "true" : "false"; }, [&](std::int64_t i) { text += fmt::format("{}", i); },
               [&](double d) { text += fmt::format("{}", d); }, [&](const std::string& s) { text += '"' + s + '"'; },
               [&](const Value::Other& other) { text += other.type; },
               [&](const Value::List& list) {
                 text += '[';
                 for (std::size_t i = 0; i < list.size() && text.size() <= longest_shown; ++i) {
                   if (i > 0) text += ", ";
                   append(text, list[i]);
                 }
                 text += ']';
               },
               [&](const Value::Table&) { text += "{...}"; }},
      value.data);
}

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto* table = as<Table>();
  if (table == nullptr) return nullptr;
  const auto found = std::ranges::find(*table, key, &Entry::key);
  return found == table->end() ? nullptr : &found->value;
}

const std::string* Value::text(std::string_view key) const {
  const Value* value = find(key);
  return value != nullptr ? value->as<std::string>() : nullptr;
}

const Value* Value::at(std::string_view path) const {
  const Value* value = this;
  while (value != nullptr && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    value = value->find(path.substr(0, dot));
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return value;
}

std::string type_name(const Value& value) {
  return std::visit(
      Overload{[](bool) -> std::string { return "boolean"; }, [](std::int64_t) -> std::string { return "number"; },
               [](double) -> std::string { return "number"; },
               [](const std::string&) -> std::string { return "string"; },
               [](const Value::Other& other) { return other.type; },
               [](const Value::List&) -> std::string { return "list"; },
               [](const Value::Table&) -> std::string { return "table"; }},
      value.data);
}

std::string written(const Value& value) {
  std::string text;
  append(text, value);
  return one_line(text, longest_shown);
}

InputError Document::error(const Value& where, const std::string& key, const std::string& rule,
                           const std::string& suggestion, const std::string& value) const {
  InputFault fault{.file = file,
                   .line = where.line,
                   .override = {},
                   .key = key,
                   .value = value,
                   .rule = rule,
                   .suggestion = suggestion};
  if (where.override >= 0) fault.override = overrides[static_cast<std::size_t>(where.override)];
  return InputError(std::move(fault));
}

std::string Document::beside(const std::string& named) const {
  return (std::filesystem::path(file).parent_path() / named).string();
}

InputError Document::error_at(const std::string& path, const std::string& rule) const {
  const Value* at = &root;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const Value* next = at->find(std::string_view(path).substr(begin, end - begin));
    if (next == nullptr) return error(*at, path, rule);
    at = next;
    begin = end + 1;
  }
  return error(*at, path, rule, {}, at->as<Value::Table>() != nullptr ? std::string() : written(*at));
}

}  // namespace limcycle::case_file
