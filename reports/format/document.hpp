#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/reports/format/table.hpp"

namespace limcycle {

/// A report in words and tables: one order for the terminal, and the tables alone for a paper.
class Document {
 public:
  explicit Document(std::string text = {}) : text_(std::move(text)) {}

  Document& operator+=(std::string_view text);
  Document& operator+=(const Document& other);

  /// A section: its title on a line after an empty one, and the table, of at most `width` columns where it can be.
  void add(const std::string& title, const Table& table, std::size_t width = 80);
  /// A table without a title in the text, because one stands before it already.
  void add_untitled(const std::string& caption, const Table& table);

  /// Everything in its order, as terminals show it.
  const std::string& text() const { return text_; }

  /// The tables as LaTeX: each a `table` with caption and rules of the package booktabs, numbers as the text shows them
  /// with powers of ten and signs of mathematics. `origin` becomes a comment at the beginning.
  std::string latex(std::string_view origin) const;

 private:
  struct Captioned {
    std::string caption;
    Table table;
  };
  std::string text_;
  std::vector<Captioned> tables_;
};

}  // namespace limcycle
