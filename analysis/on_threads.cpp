#include "limcycle/analysis/on_threads.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace limcycle {

std::size_t thread_count(int wanted) {
  return wanted > 0 ? static_cast<std::size_t>(wanted) : std::max(1U, std::thread::hardware_concurrency());
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
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < count; ++i) others.emplace_back(share);
    share();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace limcycle
