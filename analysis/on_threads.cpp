#include "limcycle/analysis/on_threads.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>

namespace limcycle {

std::size_t thread_count(int wanted) {
  return static_cast<std::size_t>(wanted > 0 ? wanted : std::max(1, tbb::info::default_concurrency()));
}

void on_threads(std::size_t count, const std::function<void()>& work, const std::function<void()>& failed) {
  std::mutex guard;
  std::exception_ptr failure;
  const auto share = [&] {
    try {
      work();
    } catch (...) {
      {
        const std::lock_guard lock(guard);
        if (!failure) failure = std::current_exception();
      }
      if (failed) failed();
    }
  };
  if (count <= 1) {
    share();
  } else {
    std::optional<tbb::global_control> more;  // than there are cores
    if (count > thread_count(0)) more.emplace(tbb::global_control::max_allowed_parallelism, count);
    tbb::task_arena arena(static_cast<int>(count));
    arena.execute([&] {
      tbb::parallel_for(
          std::size_t{0}, count, [&](std::size_t) { share(); }, tbb::simple_partitioner{});
    });
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace limcycle
