#include "limcycle/cases/loader/with_overrides.hpp"

#include <algorithm>
#include <cctype>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle {
namespace {

using case_file::Document;
using case_file::Value;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; }

/// Where the value of `key = value` begins in a line; npos if the key is not there.
std::size_t value_in(const std::string& line, const std::string& key) {
  for (std::size_t at = line.find(key); at != std::string::npos; at = line.find(key, at + 1)) {
    if (at > 0 && is_name(line[at - 1])) continue;
    std::size_t after = line.find_first_not_of(" \t", at + key.size());
    if (after == std::string::npos || line[after] != '=') continue;
    after = line.find_first_not_of(" \t", after + 1);
    return after == std::string::npos ? std::string::npos : after;
  }
  return std::string::npos;
}

/// End of a value of one word, a string or a list on the line.
std::size_t value_end(const std::string& line, std::size_t begin) {
  const char first = line[begin];
  if (first == '"' || first == '\'') {
    const std::size_t end = line.find(first, begin + 1);
    return end == std::string::npos ? end : end + 1;
  }
  if (first == '[' || first == '{') {
    const std::size_t end = line.find(first == '[' ? ']' : '}', begin);
    return end == std::string::npos ? end : end + 1;
  }
  const std::size_t end = std::min(line.find_first_of(",}#", begin), line.size());
  return line.find_last_not_of(" \t", end - 1) + 1;
}

/// Writes one override into the lines; false if that cannot be done.
bool write_override(std::vector<std::string>& lines, const std::string& override, const std::string& file,
                    const std::string& remark) {
  const std::size_t equals = override.find('=');
  const std::string path = override.substr(0, equals), value = override.substr(equals + 1);
  const std::size_t dot = path.rfind('.');
  const std::string table = dot == std::string::npos ? "" : path.substr(0, dot), key = path.substr(dot + 1);
  const Document document = case_file::parse(joined_lines(lines), file);
  const std::string comment = remark.empty() ? "" : "  # " + remark;
  if (const Value* old = document.root.at(path); old != nullptr && old->line > 0) {
    std::string& line = lines.at(static_cast<std::size_t>(old->line) - 1);
    const std::size_t begin = value_in(line, key);
    if (begin == std::string::npos) return false;
    const std::size_t end = value_end(line, begin);
    if (end == std::string::npos) return false;
    line.replace(begin, end - begin, value);
    if (line.find(remark) == std::string::npos) line += comment;
    return true;
  }
  const Value* in = table.empty() ? &document.root : document.root.at(table);
  const std::string added = key + " = " + value + comment;
  if (in == nullptr) {
    lines.insert(lines.end(), {"", "[" + table + "]", added});
    return true;
  }
  const auto* entries = in->as<Value::Table>();
  if (entries == nullptr || entries->empty()) return false;
  // Behind the first key of the table that is no table itself: under its heading, and in its block of a diagram.
  for (const auto& entry : *entries) {
    if (entry.value.as<Value::Table>() != nullptr || entry.value.line == 0) continue;
    lines.insert(lines.begin() + entry.value.line, added);
    return true;
  }
  return false;
}

bool same_numbers(const Case& a, const Case& b) {
  const auto of_a = numbers_of(a), of_b = numbers_of(b);
  return std::ranges::equal(
      of_a, of_b, [](const CaseNumber& x, const CaseNumber& y) { return x.path == y.path && x.value == y.value; });
}

}  // namespace

std::optional<std::string> text_with_overrides(const Case& from, const std::vector<std::string>& more,
                                               const std::string& remark) {
  std::vector<std::string> lines = lines_of(from.text);
  std::vector<std::string> all = from.overrides;
  for (const auto& override : from.overrides)
    if (!write_override(lines, override, from.file, "")) return std::nullopt;
  for (const auto& override : more) {
    if (!write_override(lines, override, from.file, remark)) return std::nullopt;
    all.push_back(override);
  }
  const std::string text = joined_lines(lines);
  try {
    if (!same_numbers(read_case(text, from.file, {}, from.own), read_again(from, all))) return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
  return text;
}

}  // namespace limcycle
