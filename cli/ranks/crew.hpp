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

/// Points of one piece of work, as far as they were computed.
struct FinishedPoints {
  std::vector<std::size_t> points;
  std::vector<double> rows;
  std::vector<std::size_t> rest;  ///< points left when the time was over
  double seconds = 0.0;           ///< computing time
  bool stopped = false;           ///< compute was asked to stop
};

/// Threads that compute the points of a sweep, given to them in pieces by another thread: on each rank of a job, where
/// that thread communicates with the other ranks and must not be blocked.
class Crew {
 public:
  Crew(const SweepTask& task, std::size_t threads);
  ~Crew();  ///< stop()
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// `seconds`: no block is begun after that time, so that a piece with unusually long points does not hold up the
  /// others, and little is lost if the machine stops.
  void give(std::vector<std::size_t> points, double seconds);

  /// Pieces finished since the last call.
  std::vector<FinishedPoints> take();

  /// Waits until there is something to take, at most for this time.
  void wait(std::chrono::microseconds patience);

  /// Drops pieces not begun; returns when all threads have ended, each after its present block.
  void stop();

  /// Rethrows the first exception of compute, if any.
  void check() const;

 private:
  void work();
  struct Piece {
    std::vector<std::size_t> points;
    double seconds = 0.0;
  };
  void compute(const Piece& piece);
  void deliver(FinishedPoints&& finished);
  bool stopped() const;

  const SweepTask& task_;
  mutable std::mutex mutex_;  ///< protects all that follows
  std::condition_variable given_, finished_;
  std::deque<Piece> waiting_;
  std::vector<FinishedPoints> done_;
  std::exception_ptr failure_;
  bool stopped_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace limcycle
