#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/models/loop.hpp"

namespace limcycle::case_file {

/// A part of a loop that has a table of parameters: a slot, a block of a diagram.
struct OwnedPart {
  std::string section;  ///< "loop.plant", "diagram.axis"
  std::function<const std::vector<ParameterRow>&(const LoopParts&)> rows;
  std::function<std::vector<ParameterValue>(const LoopParts&)> values;
  std::function<void(LoopParts&, const std::vector<ParameterValue>&)> set;
  std::function<bool(const LoopParts&)> valid;  ///< the part obeys its own rules
};

/// True for a number that a part has in its table, but that is none of the loop: the compensation of a controller in a
/// diagram is a block of its own; how measured data are read and fitted is no quantity of the plant.
bool is_elsewhere(const OwnedPart& part, std::string_view key);

/// All parts of a loop, in the order of numbers_of(). They serve any loop of the same kinds.
std::vector<OwnedPart> owned_parts(const LoopParts& parts);

}  // namespace limcycle::case_file
