#include "limcycle/reports/scoped_style.hpp"

#include <string_view>

namespace limcycle {
namespace {

/// "a,b" -> ".scope a,.scope b".
std::string scoped_selectors(std::string_view selectors, const std::string& scope) {
  std::string out;
  while (true) {
    const auto comma = selectors.find(',');
    out += scope + " " + std::string(selectors.substr(0, comma));
    if (comma == std::string_view::npos) return out;
    out += ',';
    selectors.remove_prefix(comma + 1);
  }
}

/// Rules of a style, those inside "@media ...{ }" too.
std::string scoped_rules(std::string_view style, const std::string& scope) {
  std::string out;
  while (!style.empty()) {
    const auto open = style.find('{');
    if (open == std::string_view::npos) return out + std::string(style);
    std::size_t end = open + 1;
    for (int depth = 1; end < style.size() && depth > 0; ++end)
      depth += style[end] == '{' ? 1 : style[end] == '}' ? -1 : 0;
    const std::string_view selectors = style.substr(0, open), inside = style.substr(open + 1, end - open - 2);
    if (selectors.find('@') != std::string_view::npos)
      out += std::string(selectors) + "{" + scoped_rules(inside, scope) + "}";
    else
      out += scoped_selectors(selectors, scope) + "{" + std::string(inside) + "}";
    style.remove_prefix(end);
  }
  return out;
}

}  // namespace

std::string with_scoped_styles(const std::string& markup) {
  constexpr std::string_view picture = "<svg ", begin = "<style>", end = "</style>";
  std::string out;
  std::size_t at = 0;
  for (int k = 0;; ++k) {
    const auto svg = markup.find(picture, at);
    if (svg == std::string::npos) return out + markup.substr(at);
    const auto style = markup.find(begin, svg), last = markup.find("</svg>", svg);
    if (style == std::string::npos || style > last) {
      out += markup.substr(at, last - at);
      if (last == std::string::npos) return out;
      at = last;
      continue;
    }
    const auto close = markup.find(end, style);
    const auto tag = markup.substr(svg, markup.find('>', svg) - svg);
    const std::string name = "picture-" + std::to_string(k);
    const bool own = tag.find(" class=") == std::string::npos;
    const auto from = style + begin.size();
    const std::string rules = markup.substr(from, close - from);
    out += markup.substr(at, svg - at) + std::string(picture) + (own ? "class=\"" + name + "\" " : "");
    out += markup.substr(svg + picture.size(), from - svg - picture.size());
    out += own ? scoped_rules(rules, "." + name) : rules;
    at = close;
  }
}

}  // namespace limcycle
