#pragma once
#include <string>
#include <vector>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Notes that a report adds about derivatives that are not exact: a sentence for every user-defined law in the loop.
inline std::vector<std::string> derivative_notes(const Loop& loop) {
  std::vector<std::string> notes;
  for (const auto& element : loop.elements)
    if (element.facts().by_differences)
      notes.push_back("derivatives of the law '" + std::string(element.kind()) +
                      "' are differences: multipliers and searches rest on them");
  return notes;
}

}  // namespace limcycle
