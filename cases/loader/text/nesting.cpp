#include <algorithm>

#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle::case_file {
namespace {

/// Walks over TOML text and skips its comments and strings. Invalid TOML leads to an error of the parser in any case,
/// so that misreading it does no harm here.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

  /// Next character outside comments and strings; '"' stands for a whole string, 0 for the end.
  char next() {
    if (at_ >= text_.size()) return 0;
    const char c = text_[at_];
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
      return next_or_end();
    }
    if (c == '"' || c == '\'') {
      skip_string(c);
      return '"';
    }
    return text_[at_++];
  }

  std::size_t position() const { return at_; }

 private:
  char next_or_end() { return at_ < text_.size() ? text_[at_++] : '\0'; }

  void skip_string(char quote) {
    const std::string triple(3, quote);
    const bool lines = text_.substr(at_, 3) == triple;
    at_ += lines ? 3 : 1;
    while (at_ < text_.size()) {
      if (lines ? text_.substr(at_, 3) == triple : text_[at_] == quote || text_[at_] == '\n') {
        at_ += lines ? 3 : 1;
        return;
      }
      at_ += quote == '"' && text_[at_] == '\\' ? 2 : 1;
    }
    at_ = std::min(at_, text_.size());
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::size_t nested_too_deep(std::string_view text) {
  constexpr int most_brackets = 32, most_dots = 16;
  Walk walk(text);
  int brackets = 0, dots = 0;
  while (const char c = walk.next()) {
    if (c == '.') {
      ++dots;
    } else if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{' || c == ']' || c == '}') {
      dots = 0;
      if (c == '[' || c == '{') ++brackets;
      if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
    }
    if (brackets > most_brackets || dots > most_dots) return walk.position();
  }
  return std::string_view::npos;
}

}  // namespace limcycle::case_file
