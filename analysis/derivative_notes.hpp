#pragma once
#include <string>
#include <vector>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// What a report must say of derivatives that are not exact: a sentence for every law of the user's own in the loop.
inline std::vector<std::string> derivative_notes(const Loop& loop) {
  std::vector<std::string> notes;
  for (const auto& element : loop.elements)
    if (const auto* law = std::get_if<OwnLaw<double>>(&element))
      notes.push_back("derivatives of the law '" + std::string(law->name()) +
                      "' are differences: multipliers and searches rest on them");
  return notes;
}

}  // namespace limcycle
