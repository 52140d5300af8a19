#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// "one, two and three": names in a sentence.
inline std::string listed_in_words(const std::vector<std::string>& names, std::string_view last = "and") {
  std::string words;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) words += i + 1 < names.size() ? ", " : " " + std::string(last) + " ";
    words += names[i];
  }
  return words;
}

}  // namespace limcycle
