#pragma once

namespace CLI {
class App;
}

namespace limcycle {

/// Checks that hold for every option (not argument) of a command by the kind of value that its help names: a file has a
/// name, a whole number (N) is written in decimal digits and fits 64 bits ("010" is ten), a number (S, V, X) is one and
/// finite. To be called when all options are declared; checks of their ranges come after these.
void check_option_values(CLI::App& command);

}  // namespace limcycle
