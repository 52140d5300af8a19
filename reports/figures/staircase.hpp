#pragma once
#include <string>

#include "limcycle/models/loop.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A diagram as a staircase (N2 chart): the blocks stand on the diagonal, in the order of the case; a signal leaves its
/// block sideways and enters the column of its reader from above or, backwards, from below, where the dot carries its
/// sign. No line passes through a block, whatever the diagram. Inline SVG, as block_diagram().
std::string staircase(const LoopParts& parts, const Units& units, const std::string& label);

/// A sum as written in a case: "r - axis.y", "2 a".
std::string sum_in_words(const SignalSum& sum);

}  // namespace limcycle
