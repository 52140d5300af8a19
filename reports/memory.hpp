#pragma once
#include <string>

namespace limcycle {

/// Bytes that this process may use: the memory of the machine, or less if a control group or `ulimit -v` limits it.
double memory_there_is();

/// "needs 12 GB of memory; 8 GB are there" if `bytes` exceed the available memory; else empty.
std::string lack_of_memory(double bytes);

}  // namespace limcycle
