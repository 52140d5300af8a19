#include "limcycle/cases/loader/text/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limcycle::case_file {
namespace {

/// Largest integer up to which every integer is a double.
constexpr std::int64_t exact_integers = std::int64_t{1} << 53;

const Value::List& list_of(const Place& place, std::string_view expected, std::size_t most) {
  const auto* list = place.value.as<Value::List>();
  if (list == nullptr) throw place.wrong_type(std::string(expected));
  if (list->size() > most)
    throw place.document.error(place.value, place.path,
                               fmt::format("must have at most {} entries, found {}", most, list->size()));
  return *list;
}

}  // namespace

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() || unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

Place Place::item(std::size_t i) const {
  return {document, (*value.as<Value::List>())[i], fmt::format("{}[{}]", path, i)};
}

std::string rule_of(const Range& range, std::string_view unit) {
  const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
  const std::string low = (range.low_open ? "> " : ">= ") + with_unit(range.low, unit);
  const std::string high = (range.high_open ? "< " : "<= ") + with_unit(range.high, unit);
  if (below && above) return "must be " + low + " and " + high;
  return "must be " + (below ? low : above ? high : std::string("a finite number"));
}

double read_number(const Place& place, const Range& range, std::string_view unit) {
  double number = 0.0;
  if (const auto* d = place.value.as<double>()) {
    number = *d;
  } else if (const auto* i = place.value.as<std::int64_t>()) {
    if (*i > exact_integers || *i < -exact_integers)
      throw place.error("is too large for an exact integer; write it with a decimal point or an exponent");
    number = static_cast<double>(*i);
  } else {
    throw place.wrong_type("a number");
  }
  if (!std::isfinite(number)) throw place.error("must be a finite number");
  if (!range.contains(number)) throw place.error(rule_of(range, unit));
  return number;
}

int read_integer(const Place& place, int low, int high) {
  const auto* i = place.value.as<std::int64_t>();
  if (i == nullptr) throw place.wrong_type("an integer");
  if (*i < low || *i > high) throw place.error(fmt::format("must be in {} .. {}", low, high));
  return static_cast<int>(*i);
}

std::string read_string(const Place& place) {
  const auto* text = place.value.as<std::string>();
  if (text == nullptr) throw place.wrong_type("a string");
  return *text;
}

std::vector<double> read_list(const Place& place, std::size_t most, const Range& range, std::string_view unit) {
  const auto& list = list_of(place, "a list of numbers", most);
  std::vector<double> numbers;
  numbers.reserve(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) numbers.push_back(read_number(place.item(i), range, unit));
  return numbers;
}

Eigen::MatrixXd read_matrix(const Place& place, std::size_t most_rows, std::size_t most_columns) {
  const auto& rows = list_of(place, "a list of rows [[a, b], [c, d]]", most_rows);
  Eigen::MatrixXd matrix;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = read_list(place.item(i), most_columns);
    if (i == 0) matrix.resize(std::ssize(rows), std::ssize(row));
    if (std::ssize(row) != matrix.cols())
      throw place.item(i).error(
          fmt::format("must have {} entries like the first row, found {}", matrix.cols(), row.size()));
    matrix.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), std::ssize(row));
  }
  return matrix;
}

std::vector<std::complex<double>> read_complex_list(const Place& place, std::size_t most) {
  const auto& list = list_of(place, "a list of numbers or [re, im] pairs", most);
  std::vector<std::complex<double>> numbers;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Place item = place.item(i);
    const auto* pair = list[i].as<Value::List>();
    if (pair == nullptr) {
      numbers.emplace_back(read_number(item));
    } else {
      if (pair->size() != 2) throw item.error("must be a number or a pair [re, im]");
      const double re = read_number(item.item(0)), im = read_number(item.item(1));
      numbers.emplace_back(re, im);
    }
  }
  return numbers;
}

CsvColumn read_column(const Place& place) {
  if (place.value.as<std::string>() != nullptr) return read_string(place);
  if (place.value.as<std::int64_t>() == nullptr) throw place.wrong_type("the name of a column, or its number from 1");
  return static_cast<std::size_t>(read_integer(place, 1, 10000));
}

std::size_t read_choice(const Place& place, std::span<const std::string_view> names) {
  const std::string name = read_string(place);
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::vector<std::string> candidates(names.begin(), names.end());
  std::string rule = "must be one of ";
  for (std::size_t i = 0; i < names.size(); ++i) rule += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", names[i]);
  const auto near = nearest_name(name, candidates);
  throw place.error(rule, near.empty() ? "" : "did you mean \"" + near + "\"?");
}

Section::Section(const Document& document, const Value& value, std::string path)
    : document_(document), value_(value), path_(std::move(path)) {
  if (value.as<Value::Table>() == nullptr) throw Place{document, value, path_}.wrong_type("a table");
}

void Section::allow(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : *value_.as<Value::Table>()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    throw document_.error(value, path_of(key), "unknown key", suggest(key, known));
  }
}

std::optional<Place> Section::find(std::string_view key) const {
  const Value* value = value_.find(key);
  if (value == nullptr) return std::nullopt;
  return Place{document_, *value, path_of(key)};
}

Place Section::at(std::string_view key, std::string_view meaning) const {
  const Value* value = value_.find(key);
  if (value == nullptr) throw error(key, "is required: " + std::string(meaning));
  return {document_, *value, path_of(key)};
}

std::optional<Section> Section::section(std::string_view key) const {
  const Value* value = value_.find(key);
  if (value == nullptr) return std::nullopt;
  return Section(document_, *value, path_of(key));
}

InputError Section::error(std::string_view key, const std::string& rule, const std::string& suggestion,
                          const std::string& value_by_default) const {
  if (const Value* value = value_.find(key))
    return document_.error(*value, path_of(key), rule, suggestion, written(*value));
  return document_.error(value_, path_of(key), rule, suggestion, value_by_default);
}

std::string Section::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

}  // namespace limcycle::case_file
