#pragma once
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking.hpp"

namespace limcycle {

/// The numbers at these paths, or without paths all that a factor can change; those left out go into `notes`. Throws
/// InputError (of `argument`, such as "--parameter") if there is no such number, or no factor changes it.
std::vector<MarginParameter> margin_parameters(const Case& from, const std::string& argument,
                                               const std::vector<std::string>& paths, std::vector<std::string>& notes);

/// Numbers that are changed together, in proportion: names, or paths, and the values that they would have.
using Toward = std::vector<std::pair<std::string, double>>;

/// The change of all these numbers as one parameter: 1 for the own numbers, 2 for those of `toward`, beyond and before
/// that on the same straight line. Throws InputError (of `argument`) for a name that is unknown, absent or there twice,
/// and for values that change nothing or are not valid together.
MarginParameter toward_parameter(const Case& from, const std::string& argument, const Toward& toward);
/// Where the numbers of such a parameter stand at the change nearest to 1, for a reader; empty if none was found.
std::string numbers_toward(const Case& from, const std::string& argument, const Toward& toward,
                           const MarginReport& report);

/// How far they are, up to `factor` up and down, from where hunting begins or ends. Throws std::invalid_argument if the
/// numbers are valid but too extreme for a method.
MarginReport ask_margin(const Case& from, const std::vector<MarginParameter>& parameters, double factor,
                        const Asking& asking);

}  // namespace limcycle
