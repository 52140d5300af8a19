/// @file
/// Winding number of the scaled loop equation about zero along the border of a set of cells. (Internal to the search.)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_lattice.hpp"

namespace limcycle {

/// Cell of the lattice: nodes [i, i + width] x [j, j + height].
struct LatticeCell {
  std::int64_t i, j, width, height;
};

/// Winding number of the function along the border of the union of the cells, counter-clockwise in the plane (p, q):
/// the sum of the indices of the zeros inside. The border is sampled at quarter blocks and bisected until the argument
/// changes by less than pi/3 from one sample to the next. Nothing if a zero lies on the border (closer than 1e-12) or
/// the function is undefined there. Cells must not overlap.
std::optional<int> border_winding(RootLattice& lattice, const std::vector<LatticeCell>& cells);

}  // namespace limcycle
