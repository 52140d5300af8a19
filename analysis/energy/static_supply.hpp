#pragma once
#include "limcycle/analysis/energy/supply_march.hpp"

namespace limcycle {

/// Passivity of an element without states: the supply, signal times output, is looked at for every signal, in every
/// mode that lasts there, under every applied force if the element asks for one. Nothing is stored, so it is passive if
/// the supply is never negative.
///
/// A friction law that puts out the applied force within a band about v = 0 (Quinn, Awrejcewicz) is no map from v to F.
/// With a body of mass m it is one, F = F(v, applied force m dv/dt + F), and the counter-example is of that: kicked to
/// a speed v1 within the band and then pulled back with the force Fs, the body is held up, pushed on that is, by the
/// friction. The energy is proportional to m, so that no mass is safe; it is given for 1 kg.
Passivity static_passivity(const ErasedElement<double>& element, const PassivityOptions& options);

/// Least supply over its size |signal| scale of the output; the signal, drive and mode where it is.
struct LeastSupply {
  double share = infinite, signal = 0.0, drive = 0.0;
  Mode mode{};
  long points = 0;
};
LeastSupply least_supply(const ErasedElement<double>& element, double top_signal);

}  // namespace limcycle
