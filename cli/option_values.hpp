#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace limcycle {

/// A finite number in decimal notation, with nothing before or behind it; else nothing ("0x10", "1e400", "nan").
std::optional<double> finite_number(std::string_view text);

/// Checks for every option (not argument) of a command by the kind of value that its help names: a file has a name, a
/// whole number (N) is written in decimal digits and fits 64 bits ("010" is ten), a number (S, V, X) is a finite
/// number. To be called when all options are declared; checks of their ranges come after these.
void check_option_values(CLI::App& command);

/// Ranges of options. The parser's own print limits with all their digits: "2.2e-308 to 1797...".
CLI::Validator whole_in(long long low, long long high);
CLI::Validator number_in(double low, double high);
CLI::Validator more_than_zero();
CLI::Validator zero_or_more();

}  // namespace limcycle
