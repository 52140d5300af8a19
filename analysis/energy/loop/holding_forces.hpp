#pragma once
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Closed interval; the ends may be infinite.
struct Extent {
  double low = 0.0, high = 0.0;
};

/// Forces that a friction law can exert at rest for ever, N: those of break-away for a set-valued law, those reached by
/// the slowest sliding either way for a law of bristles (which holds every force between by a deflection).
Extent holding_forces(const Element& law);

/// Forces with which a law stops a body that slides ever more slowly; less than the holding forces for stiction that
/// falls at once to its sliding level.
Extent stopping_forces(const Element& law);

/// True if the law, at rest without a force, holds the velocity itself (a set-valued law); false for deflected
/// bristles.
bool sticks(const Element& law);

}  // namespace limcycle
