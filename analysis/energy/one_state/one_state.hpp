#pragma once
#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Passivity of a law with one state whose mode is a function of state and velocity (OneStateLaw::fits), decided
/// exactly: a storage S(z) exists if and only if at every state that can be reached
///   sup over f < 0 of F v/f  <=  inf over f > 0 of F v/f,   and F v >= 0 where f = 0.
/// Only the two optimisations over v at each z, and the grid of z, are numerical (see storage_slopes.hpp).
///
/// yes: the two agree or leave room at every state, to 64 roundings of their terms. undecided: they cross by less than
/// 1e-9 of the terms, or by more without a cycle that the independent simulation confirms. no: with such a cycle.
/// `storage` holds both slopes and the available storage over z. Throws std::invalid_argument for another law.
Passivity one_state_passivity(const Element& law, const PassivityOptions& options = {});

}  // namespace limcycle
