#pragma once
#include "limcycle/analysis/frequency/harmonic_balance/balance_equations.hpp"
#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"

namespace limcycle {

/// The guess as a point of the equations: its phase turned so that the first harmonic of the main element's input is a
/// sine, inputs that were not given filled in, mean outputs taken from the elements' answers. Status as of the first
/// element that has no periodic answer.
Status balance_start(const Loop& loop, BalanceEquations& equations, const HarmonicGuess& guess, bool half_wave,
                     BalancePoint& point);

}  // namespace limcycle
