#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// Columns that a terminal needs for a UTF-8 text: one for a code point, none for a combining mark, two for the wide
/// characters of East Asia. A byte that is not UTF-8 counts as one.
std::size_t display_width(std::string_view text);

/// The text broken at spaces into lines of at most `width` columns, each after `indent` spaces. A longer word stands
/// alone.
std::string wrapped(std::string_view text, std::size_t width = 80, std::size_t indent = 0);

enum class Align { left, right };

struct Column {
  std::string heading;
  std::string unit;  ///< printed under the heading; empty: none
  Align align = Align::right;
};

/// Text table: headings, units, a rule, rows. Control characters in cells become spaces.
struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  ///< one cell a column; throws std::invalid_argument if not

  /// Aligned text, each line ended by a newline, no trailing spaces. Where a row would need more than `width` columns,
  /// the table is turned: one line a column, as many rows side by side as fit (always at least one).
  std::string text(std::size_t width = 80) const;
};

}  // namespace limcycle
