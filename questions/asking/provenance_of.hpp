#pragma once
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Program, settings and input of a result. `threads`: 0: one a core of the machine; `from`: the case, or null if there
/// is none. The instruction set is the portable one: questions whose kernels use another one set it.
Provenance provenance_of(std::uint64_t seed, int threads, const Case* from);

}  // namespace limcycle
