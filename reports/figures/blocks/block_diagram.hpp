#pragma once
#include <string>

#include "limcycle/models/loop.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// The loop as a block diagram with its numbers, inline SVG. Its colours follow the text around it (currentColor), its
/// classes begin with "diagram-", its label is loop_in_words(). Numbers are shown to six digits, with long polynomials
/// and lists shortened; each block has a title element with all of its numbers.
std::string block_diagram(const LoopParts& parts, const Units& units);

/// The same in sentences: connections of the blocks, with the numbers of every block in full.
std::string loop_in_words(const LoopParts& parts, const Units& units);

}  // namespace limcycle
