#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// Columns that a terminal needs for a UTF-8 text: one for a code point, none for a combining mark, two for the wide
/// characters of East Asia. A byte that is not UTF-8 counts as one.
std::size_t display_width(std::string_view text);

/// The text broken at spaces into lines of at most `width` columns, each after `indent` spaces, but never between a
/// number and its %. A longer word is on a line of its own.
std::string wrapped(std::string_view text, std::size_t width = 80, std::size_t indent = 0);

/// "LABEL  text", the label padded to `width`, the text wrapped under itself to 80 columns.
std::string item(const std::string& label, std::size_t width, const std::string& text);

/// The section of a report that lists its notes; empty without notes.
std::string notes_text(const std::vector<std::string>& notes);

/// "yes", "no", or "?" if it is not known.
std::string yes_or_no(const std::optional<bool>& value);

enum class Align { left, right };

/// Heading, unit and alignment of a column.
struct Column {
  std::string heading;
  std::string unit;  ///< printed under the heading; empty: none
  Align align = Align::right;
};

/// Text table: headings, units, a rule, rows. Control characters in cells become spaces.
struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  ///< one cell a column; throws std::invalid_argument if not

  /// Aligned text, each line ended by a newline, no trailing spaces. If a row would need more than `width` columns, the
  /// table is transposed: one line a column, as many rows side by side as fit (always at least one).
  std::string text(std::size_t width = 80) const;

  /// The same, but if a row would need more, the last column is wrapped within its place, in at least 20 columns.
  std::string with_last_wrapped(std::size_t width = 80) const;
};

/// Path of a number of the case without "loop.", for narrow places.
std::string short_path(const std::string& path);

}  // namespace limcycle
