#pragma once
#include "limcycle/cases/loader/text/section.hpp"
#include "limcycle/models/diagram/diagram.hpp"

namespace limcycle::case_file {

/// Reads a sum of signals: "r - axis.y", "2.0*a - 0.5*b". Throws InputError with the place of what is not one.
SignalSum read_signal_sum(const Place& place);

}  // namespace limcycle::case_file
