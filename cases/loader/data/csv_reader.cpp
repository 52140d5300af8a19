#include "limcycle/cases/loader/data/csv_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

namespace limcycle {
namespace {

constexpr std::size_t longest_row = 1 << 16;  ///< bytes: a longer one is no row of numbers

std::string_view trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

std::string_view unquoted(std::string_view field) {
  return field.size() >= 2 && field.front() == '"' && field.back() == '"' ? field.substr(1, field.size() - 2) : field;
}

/// "force [N]" is "force".
std::string_view without_unit(std::string_view name) {
  const auto unit = name.find_first_of("[(");
  return unit == std::string_view::npos || unit == 0 ? name : trimmed(name.substr(0, unit));
}

char separator_in(std::string_view row) {
  for (const char separator : {'\t', ';', ','})
    if (row.find(separator) != std::string_view::npos) return separator;
  return ' ';
}

}  // namespace

CsvReader::CsvReader(std::string file) : file_(std::move(file)) {
  std::error_code failed;
  const auto status = std::filesystem::status(file_, failed);
  if (!std::filesystem::exists(status)) throw error("no such file");
  if (std::filesystem::is_directory(status)) throw error("is a directory, not a file of data");
  errno = 0;
  in_.open(file_, std::ios::binary);
  if (!in_) throw error(std::string("cannot be read: ") + std::strerror(errno));
  if (!next_row()) throw error("holds no row of data");
  separator_ = separator_in(trimmed(row_));
  fields_ = fields_in(row_);
  width_ = fields_.size();
  double number = 0.0;
  ahead_ = std::ranges::all_of(fields_, [&](std::string_view field) { return is_number(field, number); });
  std::vector<std::string_view> names = fields_;
  if (ahead_) names = fields_in(comment_);
  if (names.size() != width_ || (ahead_ && comment_.empty())) return;
  for (const std::string_view name : names) header_.emplace_back(unquoted(name));
}

InputError CsvReader::error(const std::string& rule, const std::string& value) const {
  return InputError({.file = file_,
                     .line = line_,
                     .override = {},
                     .key = {},
                     .value = {},
                     .rule = value.empty() ? rule : '"' + value + "\" " + rule,
                     .suggestion = {}});
}

/// As std::getline, but of a file without line ends, such as a device, no more than a row is read.
bool CsvReader::next_line() {
  constexpr int end = std::char_traits<char>::eof();
  row_.clear();
  int c = in_.get();
  const bool any = c != end;
  for (; c != end && c != '\n'; c = in_.get()) {
    if (row_.size() == longest_row) {
      ++line_;
      throw error("is too long for a row of data: is this a CSV file?");
    }
    row_ += static_cast<char>(c);
  }
  return any;
}

bool CsvReader::next_row() {
  while (next_line()) {
    if (++line_ == 1 && row_.starts_with("\xEF\xBB\xBF")) row_.erase(0, 3);
    if (row_.find('\0') != std::string::npos) throw error("holds a zero byte: is this a CSV file?");
    const std::string_view text = trimmed(row_);
    if (text.empty()) continue;
    if (text.front() != '#' && text.front() != '%') return true;
    comment_ = text.substr(1);
  }
  if (in_.bad()) throw error("cannot be read further");
  return false;
}

std::vector<std::string_view> CsvReader::fields_in(std::string_view row) const {
  std::vector<std::string_view> fields;
  std::string_view rest = trimmed(row);
  while (true) {
    const auto end = rest.starts_with('"') && rest.find('"', 1) != std::string_view::npos
                         ? rest.find(separator_, rest.find('"', 1))
                     : separator_ == ' ' ? rest.find_first_of(" \t")
                                         : rest.find(separator_);
    fields.push_back(trimmed(rest.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    rest = rest.substr(end + 1);
    if (separator_ == ' ') rest = trimmed(rest);
  }
}

/// The number that the whole of a field is, infinite and NaN included.
bool CsvReader::is_number(std::string_view field, double& number) const {
  std::string point;
  if ((separator_ == ';' || separator_ == '\t') && field.find(',') != std::string_view::npos) {
    point = field;
    std::ranges::replace(point, ',', '.');
    field = point;
  }
  if (field.starts_with('+')) field.remove_prefix(1);
  const char* end = field.data() + field.size();
  const auto [rest, fault] = std::from_chars(field.data(), end, number);
  if (rest == end && fault == std::errc::result_out_of_range) number = std::numeric_limits<double>::infinity();
  return !field.empty() && rest == end && fault != std::errc::invalid_argument;
}

std::string CsvReader::name_of(std::size_t column) const {
  const std::string number = fmt::format("column {}", column + 1);
  return column < header_.size() && !header_[column].empty() ? fmt::format("{} ({})", number, header_[column]) : number;
}

std::vector<std::size_t> CsvReader::places_of(const CsvColumn& column) const {
  std::vector<std::size_t> places;
  const auto* position = std::get_if<std::size_t>(&column);
  for (std::size_t i = 0; i < width_; ++i) {
    if (position != nullptr
            ? *position == i + 1
            : i < header_.size() && without_unit(header_[i]) == without_unit(std::get<std::string>(column)))
      places.push_back(i);
  }
  return places;
}

bool CsvReader::has(const CsvColumn& column) const { return !places_of(column).empty(); }

void CsvReader::choose(const std::vector<CsvColumn>& columns) {
  columns_.clear();
  for (const CsvColumn& column : columns) {
    if (const auto* position = std::get_if<std::size_t>(&column)) {
      if (*position < 1 || *position > width_) {
        const char* separated = separator_ == ' '    ? "blanks"
                                : separator_ == '\t' ? "tabs"
                                : separator_ == ';'  ? "semicolons"
                                                     : "commas";
        throw error(fmt::format("has {} column{} separated by {}; column {} is asked for", width_,
                                width_ == 1 ? "" : "s", separated, *position));
      }
      columns_.push_back(*position - 1);
      continue;
    }
    const auto& name = std::get<std::string>(column);
    if (header_.empty()) throw error("has no header: name the column \"" + name + "\" by its number");
    const auto places = places_of(column);
    if (places.empty()) throw error("has no column \"" + name + "\"; " + suggest(name, header_));
    if (places.size() > 1) throw error("has two columns \"" + name + "\": give the number of one");
    columns_.push_back(places.front());
  }
}

double CsvReader::number(std::size_t column) const {
  const std::string_view field = fields_[column];
  double value = 0.0;
  if (is_number(field, value)) {
    if (std::isfinite(value)) return value;
    throw error("in " + name_of(column) + " is not a finite number", std::string(field));
  }
  if (field.empty()) throw error(name_of(column) + " is empty");
  throw error("in " + name_of(column) + " is no number", std::string(field));
}

bool CsvReader::next(std::vector<double>& numbers) {
  if (!std::exchange(ahead_, false)) {
    if (!next_row()) return false;
    fields_ = fields_in(row_);
  }
  if (fields_.size() != width_)
    throw error(
        fmt::format("has {} field{}, the first row has {}", fields_.size(), fields_.size() == 1 ? "" : "s", width_));
  numbers.clear();
  for (const std::size_t column : columns_) numbers.push_back(number(column));
  return true;
}

}  // namespace limcycle
