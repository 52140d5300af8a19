#pragma once
#include <string>
#include <string_view>

#include "limcycle/models/loop.hpp"

namespace limcycle {

enum class StepperKind { automatic, exact, rodas5p, dopri5, fehlberg78, cash_karp54 };

/// Name as in a case file; throws std::invalid_argument for an unknown one.
StepperKind stepper_kind(const std::string& name);
std::string_view to_string(StepperKind kind);

/// Matrix exponentials for loops of piecewise affine elements, the stiff stepper for loops with bristle laws or a stiff
/// linear part (if a body can stick and wait, a much less stiff part suffices), otherwise an explicit one of Odeint: of
/// order 8 for tight tolerances, of order 5 for loose ones.
/// `driven`: external signals vary in time, so that matrix exponentials do not apply.
StepperKind choose_stepper(const Loop& loop, double rtol, bool driven = false);
/// The stepper of Odeint for a tolerance.
StepperKind explicit_stepper(double rtol);

}  // namespace limcycle
