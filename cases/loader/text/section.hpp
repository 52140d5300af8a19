#pragma once
#include <complex>
#include <optional>

#include "limcycle/cases/loader/data/csv_reader.hpp"
#include "limcycle/cases/loader/text/value.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle::case_file {

/// A place in a case file: its value, and the errors that refer to it.
struct Place {
  const Document& document;
  const Value& value;
  std::string path;

  [[nodiscard]] InputError error(const std::string& rule, const std::string& suggestion = {}) const {
    return document.error(value, path, rule, suggestion, written(value));
  }
  [[nodiscard]] InputError wrong_type(const std::string& expected) const {
    return error("must be " + expected + ", found a " + type_name(value));
  }
  Place item(std::size_t i) const;  ///< of a list
};

/// "0.5 kg", with the shortest digits that identify the number; no unit if it is "1".
std::string with_unit(double value, std::string_view unit);

/// "a, b, c".
std::string joined(const std::vector<std::string>& names);

/// "must be > 0 kg": the rule of a range in words.
std::string rule_of(const Range& range, std::string_view unit);

// Readers of one value; each throws InputError. Integers count as numbers while a double holds them exactly.
double read_number(const Place& place, const Range& range = any_number, std::string_view unit = "1");
int read_integer(const Place& place, int low, int high);
std::string read_string(const Place& place);
std::vector<double> read_list(const Place& place, std::size_t most, const Range& range = any_number,
                              std::string_view unit = "1");
Eigen::MatrixXd read_matrix(const Place& place, std::size_t most_rows, std::size_t most_columns);
std::vector<std::complex<double>> read_complex_list(const Place& place, std::size_t most);
std::size_t read_choice(const Place& place, std::span<const std::string_view> names);
/// The name of a column of a file, or its number from 1.
CsvColumn read_column(const Place& place);

/// One table of a case file.
class Section {
 public:
  /// Throws InputError if `value` is not a table.
  Section(const Document& document, const Value& value, std::string path);

  /// Throws InputError for the first key that is not in `known`.
  void allow(const std::vector<std::string>& known) const;

  /// Value of a key, or nothing.
  std::optional<Place> find(std::string_view key) const;

  /// Value of a required key; `meaning` completes "is required: ".
  Place at(std::string_view key, std::string_view meaning) const;

  /// A table in this one.
  std::optional<Section> section(std::string_view key) const;

  /// The error that names `key`, whether it is written or not (then with the resulting value).
  [[nodiscard]] InputError error(std::string_view key, const std::string& rule, const std::string& suggestion = {},
                                 const std::string& value_by_default = {}) const;

  std::string path_of(std::string_view key) const;
  /// All keys with their values, in the order of the file.
  const Value::Table& table() const { return *value_.as<Value::Table>(); }
  const std::string& path() const { return path_; }
  const Document& document() const { return document_; }

 private:
  const Document& document_;
  const Value& value_;
  std::string path_;
};

}  // namespace limcycle::case_file
