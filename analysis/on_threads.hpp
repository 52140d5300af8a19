#pragma once
#include <cstddef>
#include <functional>

namespace limcycle {

/// Number of threads to use: `wanted`, or if that is 0 one for each core that this process may use.
std::size_t thread_count(int wanted);

/// Calls work() `count` times (at least once), on as many threads at once as are available (oneTBB), the calling thread
/// among them, and returns when all calls have ended: work() takes from the remaining work until none is left. The
/// first exception is then thrown; `failed` is called as soon as it occurs, on the thread that threw it, so that the
/// others can be asked to end.
void on_threads(std::size_t count, const std::function<void()>& work, const std::function<void()>& failed = {});

/// Does the tasks 0 to count - 1 on `threads` threads (see thread_count()), the lowest number first. A task says how
/// much of itself is done; `tell` is called with the share of all that is done and the number of that task, by one
/// thread at a time.
void share_tasks(int threads, std::size_t count,
                 const std::function<void(std::size_t, const std::function<void(double)>&)>& task,
                 const std::function<void(double, std::size_t)>& tell);

}  // namespace limcycle
