#pragma once
#include <cstddef>
#include <functional>

namespace limcycle {

/// Number of threads that is meant: `wanted`, or where that is 0 one for each core that this process may use.
std::size_t thread_count(int wanted);

/// Calls work() so many times (at least once), on as many threads at once as there are to be had (oneTBB), the calling
/// thread among them, and returns when all calls have ended: work() takes from what is left to do until nothing is. The
/// first exception is thrown then; `failed` is called as soon as there is one, on the thread that threw it, so that the
/// others can be told to end.
void on_threads(std::size_t count, const std::function<void()>& work, const std::function<void()>& failed = {});

}  // namespace limcycle
