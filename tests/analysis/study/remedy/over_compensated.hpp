#pragma once
#include "limcycle/tests/loops.hpp"

namespace limcycle::test {

/// A PD servo that hunts since it compensates more friction than there is.
inline LoopParts over_compensated() {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  Pid pd = pid(100.0, 0.0, 10.0);
  pd.friction_compensation = 1.3;
  pd.lag = 0.05;
  parts.controller = pd;
  parts.friction = coulomb(1.0, 1.0);
  return parts;
}

}  // namespace limcycle::test
