#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace limcycle::test {

/// First error in the tags of a page, or of a part of one: a tag that is not closed, or closes another one, a duplicate
/// id, a bare '<' or '&' in text. Empty: none. The content of scripts and styles is not checked.
class MarkupCheck {
 public:
  explicit MarkupCheck(std::string_view text) : text_(text) {}

  std::string fault() {
    while (fault_.empty() && at_ < text_.size()) text_[at_] == '<' ? tag() : words();
    if (fault_.empty() && !open_.empty()) fault_ = "<" + open_.back() + "> is not closed";
    return fault_;
  }

 private:
  void words() {
    if (text_[at_] == '&') {
      const auto end = text_.find(';', at_);
      if (end == std::string_view::npos || end - at_ > 8) fault_ = "bare & at " + std::string(text_.substr(at_, 40));
    }
    ++at_;
  }

  void tag() {
    if (text_.substr(at_, 2) == "<!") return leave_tag(text_.find('>', at_));
    const bool closes = text_.substr(at_, 2) == "</";
    std::size_t end = at_ + (closes ? 2 : 1);
    const std::size_t begin = end;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) != 0)) ++end;
    const std::string name(text_.substr(begin, end - begin));
    if (name.empty()) {
      fault_ = "bare < at " + std::string(text_.substr(at_, 40));
      return;
    }
    const auto last = end_of_tag(end);
    if (last == std::string_view::npos) {
      fault_ = "<" + name + " has no >";
      return;
    }
    const std::string_view inside = text_.substr(end, last - end);
    leave_tag(last);
    if (closes)
      close(name);
    else
      open(name, inside);
  }

  /// The > that ends a tag: not one in a quoted value.
  std::size_t end_of_tag(std::size_t from) const {
    for (char quote = 0; from < text_.size(); ++from) {
      const char c = text_[from];
      if (quote != 0)
        quote = c == quote ? '\0' : quote;
      else if (c == '"' || c == '\'')
        quote = c;
      else if (c == '>')
        return from;
    }
    return std::string_view::npos;
  }

  void leave_tag(std::size_t last) { at_ = last == std::string_view::npos ? text_.size() : last + 1; }

  void open(const std::string& name, std::string_view inside) {
    note_id(inside);
    static const std::vector<std::string> alone{"meta", "link", "br", "img", "input", "hr"};
    if (std::ranges::find(alone, name) != alone.end() || inside.ends_with('/')) return;
    if (name != "script" && name != "style") return open_.push_back(name);
    const auto end = text_.find("</" + name + ">", at_);
    if (end == std::string_view::npos) fault_ = "<" + name + "> is not closed";
    leave_tag(end == std::string_view::npos ? end : end + name.size() + 2);
  }

  void close(const std::string& name) {
    if (open_.empty() || open_.back() != name)
      fault_ = "</" + name + "> closes <" + (open_.empty() ? "nothing" : open_.back()) + ">";
    else
      open_.pop_back();
  }

  void note_id(std::string_view inside) {
    const auto at = inside.find(" id=\"");
    if (at == std::string_view::npos) return;
    const std::string id(inside.substr(at + 5, inside.find('"', at + 5) - at - 5));
    if (std::ranges::find(ids_, id) != ids_.end()) fault_ = "id " + id + " stands twice";
    ids_.push_back(id);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_, ids_;
  std::string fault_;
};

inline std::string markup_fault(std::string_view text) { return MarkupCheck(text).fault(); }

/// Levels of the headings in order, "122333".
inline std::string heading_levels(std::string_view text) {
  std::string out;
  for (auto at = text.find("<h"); at != std::string_view::npos; at = text.find("<h", at + 1))
    if (at + 3 < text.size() && text[at + 2] >= '1' && text[at + 2] <= '6' &&
        (text[at + 3] == '>' || text[at + 3] == ' '))
      out += text[at + 2];
  return out;
}

}  // namespace limcycle::test
