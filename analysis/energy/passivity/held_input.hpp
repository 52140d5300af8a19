#pragma once
#include "limcycle/analysis/energy/passivity/supply_march.hpp"

namespace limcycle {

/// Energy supplied to an element that is not a friction law (signal: its input) during one cycle of a signal from that
/// state, by small equal steps alone: the independent check of SupplyMarch for such elements, whose rates are constant
/// in each mode. Error: a share of about 1e-6 for each jump of the output.
double stepped_supply(const Element& element, const VelocityCycle& input, std::vector<double> z, Mode mode);

}  // namespace limcycle
