#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"

namespace limcycle {

/// Samples of a trace that a picture needs.
struct Decimated {
  std::vector<std::size_t> index;  ///< increasing
  bool whole = true;               ///< false: only the first part, as the rest would be illegible
};

/// At most about `most` samples (and each change of `keep_changes`, if given), evenly spaced along the curve
/// (t, y, rate, output), each scaled to its own range, so that jumps and corners keep their shape while long rests cost
/// little. A trace so long that neighbours would be more than `coarsest` of the picture apart is cut. Cost: O(samples).
Decimated decimate(const Trace& trace, std::size_t most, const std::vector<bool>& keep_changes = {},
                   double coarsest = 0.03);

/// Stuck samples: those with the least |velocity| that together last `fraction` of the time of the trace.
std::vector<bool> stuck_samples(const Trace& trace, double fraction);

/// True if a trace can be drawn: y and its rate over time; and the element too.
bool drawable(const Trace& trace);
bool has_element(const Trace& trace);

/// Name of y of a trace in a picture: "y", or "y - 0.3" if it is measured from there.
std::string name_of_y(const Trace& trace);

}  // namespace limcycle
