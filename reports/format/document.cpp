#include "limcycle/reports/format/document.hpp"

#include <algorithm>
#include <cctype>

namespace limcycle {
namespace {

/// Text with the characters that LaTeX takes for its own.
std::string latex_text(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        out += std::string("\\") + c;
        break;
      case '~':
        out += "\\textasciitilde{}";
        break;
      case '^':
        out += "\\textasciicircum{}";
        break;
      case '\\':
        out += "\\textbackslash{}";
        break;
      case '<':
        out += "\\textless{}";
        break;
      case '>':
        out += "\\textgreater{}";
        break;
      case '|':
        out += "\\textbar{}";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  return out;
}

/// Length of the number at the beginning of a text: 12, -0.5, 1.0e-08; 0 if there is none.
std::size_t number_length(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t from = i;
    while (i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0) ++i;
    return i - from;
  };
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  if (digits() == 0) return 0;
  if (i < text.size() && text[i] == '.') ++i, digits();
  const std::size_t mantissa = i;
  if (i < text.size() && text[i] == 'e') {
    ++i;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    if (digits() == 0) i = mantissa;
  }
  return i;
}

/// 1.0e-08 as 1.0 \cdot 10^{-8}; exponents of a reader's own text may be longer than any number's.
std::string latex_number(std::string_view number) {
  const auto e = number.find('e');
  if (e == std::string_view::npos) return std::string(number);
  std::string_view exponent = number.substr(e + 1);
  const std::string sign = exponent.front() == '-' ? "-" : "";
  exponent.remove_prefix(std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
  return std::string(number.substr(0, e)) + " \\cdot 10^{" + sign + std::string(exponent) + "}";
}

/// A cell: numbers that stand by themselves as mathematics, which gives them their signs and powers.
std::string latex_cell(const std::string& cell) {
  std::string out;
  for (std::size_t i = 0; i < cell.size();) {
    const bool begins = i == 0 || cell[i - 1] == ' ' || cell[i - 1] == '(' || cell[i - 1] == '[';
    const std::size_t length = begins ? number_length(std::string_view(cell).substr(i)) : 0;
    const std::size_t end = i + length;
    const bool ends = end == cell.size() || std::string_view(" %,;:)]").find(cell[end]) != std::string_view::npos;
    const std::string_view number = std::string_view(cell).substr(i, length);
    if (length > 0 && ends && number.find_first_of("-+e") != std::string_view::npos)
      out += "$" + latex_number(number) + "$";
    else
      out += latex_text(std::string_view(cell).substr(i, std::max<std::size_t>(length, 1)));
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string latex_row(const std::vector<std::string>& cells) {
  std::string out;
  for (const auto& cell : cells) out += (out.empty() ? "" : " & ") + (cell.empty() ? std::string("{}") : cell);
  return out + " \\\\\n";
}

/// Unit with powers: m/s^2.
std::string latex_unit(const std::string& unit) {
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '^' && i + 1 < unit.size()) {
      const std::size_t length = number_length(std::string_view(unit).substr(i + 1));
      if (length > 0) {
        out += "$^{" + unit.substr(i + 1, length) + "}$";
        i += length;
        continue;
      }
    }
    out += latex_text(unit.substr(i, 1));
  }
  return out;
}

}  // namespace

Document& Document::operator+=(std::string_view text) {
  text_ += text;
  return *this;
}

Document& Document::operator+=(const Document& other) {
  text_ += other.text_;
  tables_.insert(tables_.end(), other.tables_.begin(), other.tables_.end());
  return *this;
}

void Document::add(const std::string& title, const Table& table, std::size_t width) {
  text_ += "\n" + title + "\n" + table.text(width);
  tables_.push_back({title, table});
}

void Document::add_untitled(const std::string& caption, const Table& table) {
  text_ += table.text();
  tables_.push_back({caption, table});
}

std::string Document::latex(std::string_view origin) const {
  std::string comment(origin);  // of one line: titles and names of files may hold others
  std::ranges::replace_if(
      comment, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  std::string out = "% " + comment + "\n% \\usepackage{booktabs}\n";
  for (const auto& [caption, table] : tables_) {
    std::string places;
    std::vector<std::string> headings, units;
    bool with_units = false;
    for (const Column& column : table.columns) {
      places += column.align == Align::left ? 'l' : 'r';
      headings.push_back(latex_text(column.heading));
      units.push_back(column.unit.empty() ? "" : "(" + latex_unit(column.unit) + ")");
      with_units = with_units || !column.unit.empty();
    }
    out += "\n\\begin{table}\n\\centering\n\\caption{" + latex_text(caption) + "}\n\\begin{tabular}{" + places +
           "}\n\\toprule\n" + latex_row(headings);
    if (with_units) out += latex_row(units);
    out += "\\midrule\n";
    for (const auto& row : table.rows) {
      std::vector<std::string> cells;
      cells.reserve(row.size());
      for (const auto& cell : row) cells.push_back(latex_cell(cell));
      out += latex_row(cells);
    }
    out += "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
  }
  return out;
}

}  // namespace limcycle
