#pragma once
#include <cstddef>
#include <functional>

namespace limcycle {

/// Number of threads that is meant: `wanted`, or one a core where that is 0.
std::size_t thread_count(int wanted);

/// Runs work() on so many threads at once (at least one), the calling thread among them, and returns when all have
/// ended. The first exception is thrown then; `failed` is called as soon as there is one, on the thread that threw it,
/// so that the others can be told to end.
void on_threads(std::size_t count, const std::function<void()>& work, const std::function<void()>& failed = {});

}  // namespace limcycle
