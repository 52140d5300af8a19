#pragma once
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// What the flags say of a question, stopped by interrupts, which are caught from now on, and shown by `bar`, which
/// must outlive it. Throws std::invalid_argument if this machine lacks the instruction set.
Asking asking_of(const CommonFlags& flags, Progress& bar);

}  // namespace limcycle
