#pragma once
#include <fstream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "limcycle/cases/loader/text/input_error.hpp"

namespace limcycle {

/// A column of a CSV file: its number from 1, or its name in the header.
using CsvColumn = std::variant<std::size_t, std::string>;

/// Reads the numbers of a CSV file row by row, so that files of any length take no memory.
///
/// Fields are separated by commas, semicolons, tabs or blanks, whichever the first row shows (a tab before a semicolon
/// before a comma before blanks). Lines that are empty or begin with # or % are comments. The first row is a header if
/// one of its fields is no number; without one, the comment before it is, if it has as many fields. Names may stand in
/// double quotes and have a unit in brackets, "force [N]", which a column's name need not repeat. A byte order mark and
/// line ends of any kind are taken. Every field of a row that is asked for must be a finite number, with a decimal
/// point or, between semicolons or tabs, a decimal comma, and every row must have as many fields as the first.
class CsvReader {
 public:
  /// Opens the file and reads its header. Throws InputError if it is missing, a directory, unreadable, binary, or holds
  /// no row.
  explicit CsvReader(std::string file);
  CsvReader(const CsvReader&) = delete;  // fields refer to the row
  CsvReader& operator=(const CsvReader&) = delete;

  const std::string& file() const { return file_; }
  /// Names in the header; empty if there is none.
  const std::vector<std::string>& header() const { return header_; }
  /// Fields in a row.
  std::size_t width() const { return width_; }

  /// True for a column that the file has.
  bool has(const CsvColumn& column) const;

  /// Chooses what next() returns. Throws InputError for a column that the file does not have, or has twice.
  void choose(const std::vector<CsvColumn>& columns);

  /// Places of those columns, from 0.
  const std::vector<std::size_t>& chosen() const { return columns_; }

  /// The numbers of the next row in the columns chosen, or false at the end. Throws InputError with file, line and
  /// column.
  bool next(std::vector<double>& numbers);

  /// Line of the row that next() read last, from 1.
  int line() const { return line_; }

  /// An error in that line. `value`: as written, or empty.
  [[nodiscard]] InputError error(const std::string& rule, const std::string& value = {}) const;

 private:
  bool next_line();
  bool next_row();
  std::vector<std::string_view> fields_in(std::string_view row) const;
  bool is_number(std::string_view field, double& number) const;
  double number(std::size_t column) const;
  std::vector<std::size_t> places_of(const CsvColumn& column) const;
  std::string name_of(std::size_t column) const;

  std::string file_;
  std::ifstream in_;
  std::string row_, comment_;             ///< the last of each
  std::vector<std::string_view> fields_;  ///< of row_
  std::vector<std::string> header_;
  std::vector<std::size_t> columns_;  ///< from 0
  char separator_ = ',';              ///< ' ': any number of blanks
  std::size_t width_ = 0;
  int line_ = 0;
  bool ahead_ = false;  ///< the first row of numbers is read already
};

}  // namespace limcycle
