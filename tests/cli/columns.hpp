#pragma once
#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "limcycle/reports/format/table.hpp"

namespace limcycle::test {

/// Checks every line of a text: at most 80 columns, no space at its end, no tab.
inline void check_columns(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    CHECK(display_width(line) <= 80);
    CHECK_FALSE(line.ends_with(' '));
    CHECK(line.find('\t') == std::string::npos);
  }
}

}  // namespace limcycle::test
