#pragma once
#include "limcycle/models/elements.hpp"

namespace limcycle {

/// Closed interval; the ends may be infinite.
struct Extent {
  double low = 0.0, high = 0.0;
};

/// Forces that a friction law can put up at rest for ever, N: those of break-away for a set-valued law, those reached
/// by the slowest sliding either way for a law of bristles (which holds every force between by a deflection).
Extent holding_forces(const Element<double>& law);

/// Forces with which a law stops a body that slides ever more slowly; for stiction that falls at once to its sliding
/// level less than what it holds.
Extent stopping_forces(const Element<double>& law);

/// Does the law, at rest and not pulled at, hold the velocity by itself (a set-valued law), or by deflected bristles?
bool sticks(const Element<double>& law);

}  // namespace limcycle
