#pragma once
#include "limcycle/analysis/energy/passivity/supply_march.hpp"

namespace limcycle {

/// Passivity of an element without states: the supply, signal times output, is evaluated for every signal, in every
/// mode that lasts there, and under every applied force if the element needs one. Nothing is stored, so it is passive
/// if the supply is never negative.
///
/// A friction law that outputs the applied force within a band about v = 0 (Quinn, Awrejcewicz) is no map from v to F.
/// With a body of mass m it is one, F = F(v, applied force m dv/dt + F), and the counter-example refers to that: the
/// body is kicked to a speed v1 within the band and then pulled back with the force Fs, while the friction holds it up,
/// that is, pushes it on. The energy is proportional to m, so that no mass is safe; it is given for 1 kg.
Passivity static_passivity(const Element& element, const PassivityOptions& options);

/// Least supply over its size |signal| scale of the output, with the signal, drive and mode there.
struct LeastSupply {
  double share = infinite, signal = 0.0, drive = 0.0;
  Mode mode{};
  long points = 0;
};
LeastSupply least_supply(const Element& element, double top_signal);

}  // namespace limcycle
