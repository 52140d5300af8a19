#include "limcycle/analysis/on_threads.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <vector>

namespace limcycle {
namespace {

/// Arenas that nobody uses now, by their number of threads. An arena that is dropped leaves some of its memory behind,
/// and each makes the next one slower (oneTBB 2021.8), so that they are kept; calls at the same time, and calls within
/// calls, still have one each.
class IdleArenas {
 public:
  std::unique_ptr<tbb::task_arena> take(int threads) {
    const std::lock_guard lock(guard_);
    auto& idle = idle_[threads];
    if (idle.empty()) return std::make_unique<tbb::task_arena>(threads);
    auto arena = std::move(idle.back());
    idle.pop_back();
    return arena;
  }
  void put_back(int threads, std::unique_ptr<tbb::task_arena> arena) {
    const std::lock_guard lock(guard_);
    idle_[threads].push_back(std::move(arena));
  }

 private:
  std::mutex guard_;
  std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>> idle_;
};

IdleArenas& idle_arenas() {
  static auto* const arenas = new IdleArenas;  // oneTBB may end before it
  return *arenas;
}

}  // namespace

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
    const auto threads = static_cast<int>(count);
    auto arena = idle_arenas().take(threads);
    arena->execute([&] {
      tbb::parallel_for(
          std::size_t{0}, count, [&](std::size_t) { share(); }, tbb::simple_partitioner{});
    });
    idle_arenas().put_back(threads, std::move(arena));
  }
  if (failure) std::rethrow_exception(failure);
}

void share_tasks(int threads, std::size_t count,
                 const std::function<void(std::size_t, const std::function<void(double)>&)>& task,
                 const std::function<void(double, std::size_t)>& tell) {
  std::vector<double> done(count, 0.0);
  std::mutex telling;
  const auto progress_of = [&](std::size_t i, double fraction) {
    const std::lock_guard lock(telling);
    done[i] = std::max(done[i], fraction);
    tell(std::accumulate(done.begin(), done.end(), 0.0) / static_cast<double>(count), i);
  };
  std::atomic<std::size_t> next = 0;
  on_threads(thread_count(threads), [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      task(i, [&](double fraction) { progress_of(i, fraction); });
      progress_of(i, 1.0);
    }
  });
}

}  // namespace limcycle
