#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "limcycle/analysis/sweep.hpp"

namespace limcycle {

/// Some of the points that a crew was given, and their rows.
struct FinishedPoints {
  std::vector<std::size_t> points;
  std::vector<double> rows;
  double seconds = 0.0;  ///< that it took
  bool all = false;      ///< those of one call of give() are complete with these
  bool stopped = false;  ///< compute was told to stop: the others of that call do not come
};

/// Threads that compute the points of a sweep which one other thread gives them, one after another: on each rank of a
/// job, where that other thread talks to the other ranks and must not be kept waiting.
class Crew {
 public:
  Crew(const SweepTask& task, std::size_t threads);
  ~Crew();  ///< stop()
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  void give(std::vector<std::size_t> points);

  /// What was finished since the last call. Points of one give() come together, or in parts if they take longer than a
  /// fifth of a second, so that little is lost when the machine stops.
  std::vector<FinishedPoints> take();

  /// Waits until there is something to take, no longer than so.
  void wait(std::chrono::microseconds patience);

  /// What was not begun is forgotten; returns when all threads have ended, after the block that each is at.
  void stop();

  /// Throws what compute threw first, if it did.
  void check() const;

 private:
  void work();
  void compute_all(std::span<const std::size_t> points);
  void deliver(FinishedPoints&& part);
  bool stopped() const;

  const SweepTask& task_;
  mutable std::mutex mutex_;  ///< of all that follows
  std::condition_variable given_, finished_;
  std::deque<std::vector<std::size_t>> waiting_;
  std::vector<FinishedPoints> done_;
  std::exception_ptr failure_;
  bool stopped_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace limcycle
