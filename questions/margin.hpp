#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking.hpp"

namespace limcycle {

/// The numbers at these paths, or without paths all that a factor can change; those left out go into `notes`. Throws
/// InputError (of `argument`, such as "--parameter") if there is no such number, or no factor changes it.
std::vector<MarginParameter> margin_parameters(const Case& from, const std::string& argument,
                                               const std::vector<std::string>& paths, std::vector<std::string>& notes);

/// How far they are, up to `factor` up and down, from where hunting begins or ends. Throws std::invalid_argument if the
/// numbers are valid but too extreme for a method.
MarginReport ask_margin(const Case& from, const std::vector<MarginParameter>& parameters, double factor,
                        const Asking& asking);

}  // namespace limcycle
