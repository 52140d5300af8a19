#include <algorithm>
#include <array>

#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle::case_file {
namespace {

constexpr std::array<std::string_view, 4> reserved{"output", "reference", "block", "r"};

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && letter(text.front()) &&
         std::ranges::all_of(text, [&](char c) { return letter(c) || digit(c); });
}

}  // namespace

void name_blocks(Document& document) {
  auto* top = std::get_if<Value::Table>(&document.root.data);
  const auto diagram = std::ranges::find(*top, "diagram", &Value::Entry::key);
  if (diagram == top->end()) return;
  auto* table = std::get_if<Value::Table>(&diagram->value.data);
  if (table == nullptr) return;
  const auto found = std::ranges::find(*table, "block", &Value::Entry::key);
  if (found == table->end()) return;
  if (found->value.as<Value::List>() == nullptr)
    throw document.error(found->value, "diagram.block", "must be a list of tables: write [[diagram.block]]");
  const Value::List blocks = std::move(std::get<Value::List>(found->value.data));
  table->erase(found);
  for (const Value& block : blocks) {
    const Value* name = block.find("name");
    const auto* text = name != nullptr ? name->as<std::string>() : nullptr;
    if (text == nullptr) throw document.error(name ? *name : block, "diagram.block.name", "is required: a word");
    const auto refuse = [&](const std::string& rule) {
      return document.error(*name, "diagram.block.name", rule, {}, written(*name));
    };
    if (!is_name(*text)) throw refuse("must be a letter, then letters, digits and _");
    if (std::ranges::find(reserved, *text) != reserved.end())
      throw refuse("is a word of the case format: choose another");
    if (const auto other = std::ranges::find(*table, *text, &Value::Entry::key); other != table->end())
      throw refuse("is taken by the block of line " + std::to_string(other->value.line));
    table->push_back({*text, block});
  }
}

void for_each_part(Document& document, const std::function<void(Value& part, const std::string& path)>& use) {
  const auto tables = [](Value& within) { return std::get_if<Value::Table>(&within.data); };
  auto* top = tables(document.root);
  if (top == nullptr) return;
  for (auto& [section, value] : *top) {
    if (section != "loop" && section != "diagram") continue;
    auto* parts = tables(value);
    if (parts == nullptr) continue;
    for (auto& [name, part] : *parts) use(part, section + "." + name);
  }
}

}  // namespace limcycle::case_file
