#include "limcycle/reports/format/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace limcycle {
namespace {

constexpr std::string_view column_gap = "  ";

/// Next code point of a UTF-8 text; an invalid byte counts as its own.
char32_t next_code_point(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const std::size_t length = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
  char32_t code = length == 1 ? lead : lead & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if (i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) {
      text.remove_prefix(1);
      return lead;
    }
    code = (code << 6) | (static_cast<unsigned char>(text[i]) & 0x3F);
  }
  text.remove_prefix(length);
  return code;
}

bool combining(char32_t c) {
  return (c >= 0x0300 && c <= 0x036F) || (c >= 0x200B && c <= 0x200F) || (c >= 0x20D0 && c <= 0x20FF) || c == 0xFEFF;
}

/// East Asian wide and fullwidth blocks and emoji (Unicode Annex 11, by block).
bool wide(char32_t c) {
  return (c >= 0x1100 && c <= 0x115F) || (c >= 0x2E80 && c <= 0xA4CF) || (c >= 0xAC00 && c <= 0xD7A3) ||
         (c >= 0xF900 && c <= 0xFAFF) || (c >= 0xFE30 && c <= 0xFE6F) || (c >= 0xFF00 && c <= 0xFF60) ||
         (c >= 0xFFE0 && c <= 0xFFE6) || (c >= 0x1F300 && c <= 0x1FAFF) || (c >= 0x20000 && c <= 0x3FFFD);
}

std::string cleaned(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  return text;
}

std::string padded(const std::string& text, std::size_t width, Align align) {
  const std::size_t own = display_width(text);
  const std::string space(width > own ? width - own : 0, ' ');
  return align == Align::left ? text + space : space + text;
}

void end_line(std::string& out) {
  while (!out.empty() && out.back() == ' ') out.pop_back();
  out += '\n';
}

using Cells = std::vector<std::vector<std::string>>;

std::vector<std::size_t> widths_of(const Cells& cells) {
  std::vector<std::size_t> widths(cells.empty() ? 0 : cells.front().size(), 0);
  for (const auto& row : cells)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_width(row[i]));
  return widths;
}

std::size_t total(const std::vector<std::size_t>& widths) {
  std::size_t sum = widths.empty() ? 0 : column_gap.size() * (widths.size() - 1);
  for (const std::size_t width : widths) sum += width;
  return sum;
}

/// Heading and unit in one cell, for a turned table.
std::string label(const Column& column) {
  return cleaned(column.unit.empty() ? column.heading : column.heading + " [" + column.unit + "]");
}

std::string straight(const std::vector<Column>& columns, const Cells& cells, std::size_t header_lines,
                     const std::vector<std::size_t>& widths) {
  std::string out;
  for (std::size_t r = 0; r < cells.size(); ++r) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) out += column_gap;
      out += padded(cells[r][i], widths[i], columns[i].align);
    }
    end_line(out);
    if (r + 1 == header_lines) out += std::string(total(widths), '-') + '\n';
  }
  return out;
}

std::string turned(const Table& table, std::size_t width) {
  std::size_t first = 0;
  for (const auto& column : table.columns) first = std::max(first, display_width(label(column)));
  std::string out;
  for (std::size_t from = 0; from < table.rows.size();) {
    std::vector<std::size_t> widths;
    std::size_t sum = first;
    for (std::size_t r = from; r < table.rows.size(); ++r) {
      std::size_t own = 0;
      for (const auto& cell : table.rows[r]) own = std::max(own, display_width(cell));
      if (r > from && sum + column_gap.size() + own > width) break;
      sum += column_gap.size() + own;
      widths.push_back(own);
    }
    if (from > 0) out += '\n';
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      out += padded(label(table.columns[i]), first, Align::left);
      for (std::size_t k = 0; k < widths.size(); ++k)
        out += std::string(column_gap) + padded(cleaned(table.rows[from + k][i]), widths[k], table.columns[i].align);
      end_line(out);
    }
    from += widths.size();
  }
  return out;
}

}  // namespace

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  while (!text.empty()) {
    const char32_t c = next_code_point(text);
    width += combining(c) ? 0 : wide(c) ? 2 : 1;
  }
  return width;
}

namespace {

/// End of the word that begins at `from`; a per cent sign stays with its number.
std::size_t end_of_word(std::string_view text, std::size_t from) {
  std::size_t end = std::min(text.find_first_of(" \n", from), text.size());
  if (end > from && text.substr(end).starts_with(" %")) end = std::min(text.find_first_of(" \n", end + 2), text.size());
  return end;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string out;
  std::size_t column = 0;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = end_of_word(text, i);
    const std::string word = cleaned(std::string(text.substr(i, end - i)));
    i = end + 1;
    if (word.empty()) continue;
    const std::size_t own = display_width(word);
    if (column > 0 && column + 1 + own > width) {
      out += '\n';
      column = 0;
    }
    out += column == 0 ? std::string(indent, ' ') : " ";
    column += (column == 0 ? indent : 1) + own;
    out += word;
  }
  return out + '\n';
}

std::string item(const std::string& label, std::size_t width, const std::string& text) {
  const std::string body = wrapped(text, 80, width + 2);
  const std::size_t own = std::min(display_width(label), width);
  return label + std::string(width + 2 - own, ' ') + (body.size() > width + 2 ? body.substr(width + 2) : "\n");
}

std::string notes_text(const std::vector<std::string>& notes) {
  std::string out;
  for (const auto& note : notes) out += item("-", 1, note);
  return out.empty() ? "" : "\nNotes\n" + out;
}

std::string yes_or_no(const std::optional<bool>& value) { return value ? (*value ? "yes" : "no") : "?"; }

std::string Table::text(std::size_t width) const {
  Cells cells;
  std::vector<std::string> headings, units;
  for (const auto& column : columns) {
    headings.push_back(cleaned(column.heading));
    units.push_back(cleaned(column.unit.empty() ? "" : "[" + column.unit + "]"));
  }
  cells.push_back(headings);
  if (std::any_of(units.begin(), units.end(), [](const auto& unit) { return !unit.empty(); })) cells.push_back(units);
  const std::size_t header_lines = cells.size();
  for (const auto& row : rows) {
    if (row.size() != columns.size())
      throw std::invalid_argument(fmt::format("table row of {} cells in {} columns", row.size(), columns.size()));
    cells.emplace_back();
    for (const auto& cell : row) cells.back().push_back(cleaned(cell));
  }
  const auto widths = widths_of(cells);
  return total(widths) <= width ? straight(columns, cells, header_lines, widths) : turned(*this, width);
}

std::string Table::with_last_wrapped(std::size_t width) const {
  Table narrow{columns, {}};
  std::size_t before = 0;
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
    std::size_t widest = std::max(display_width(columns[i].heading), display_width(columns[i].unit) + 2);
    for (const auto& row : rows) widest = std::max(widest, display_width(row.at(i)));
    before += widest + column_gap.size();
  }
  const std::size_t left = std::max<std::size_t>(20, width - std::min(width, before));
  for (const auto& row : rows) {
    std::vector<std::string> first = row;
    const std::string lines = wrapped(row.at(columns.size() - 1), left);
    for (std::size_t from = 0; from < lines.size();) {
      const std::size_t end = lines.find('\n', from);
      first.back() = lines.substr(from, end - from);
      narrow.rows.push_back(first);
      first.assign(columns.size(), "");
      from = end + 1;
    }
  }
  return narrow.text(before + left);
}

std::string short_path(const std::string& path) { return path.starts_with("loop.") ? path.substr(5) : path; }

}  // namespace limcycle
