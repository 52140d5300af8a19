#pragma once
#include <string>
#include <vector>

#include "limcycle/cases/loader/text/input_error.hpp"

namespace limcycle {

/// Error in an argument of a question, named as the one who asks names it ("--vary", "vary"), with its value.
InputError argument_error(const std::string& argument, const std::string& value, const std::string& rule,
                          const std::string& suggestion = {});

/// Position of a name among those that are known. Throws the error with this rule and the nearest one.
std::size_t position_named(const std::string& argument, const std::string& name, const std::vector<std::string>& known,
                           const std::string& rule);

}  // namespace limcycle
