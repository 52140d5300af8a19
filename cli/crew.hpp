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

/// Points that a crew was given at once, as far as it came.
struct FinishedPoints {
  std::vector<std::size_t> points;
  std::vector<double> rows;
  std::vector<std::size_t> rest;  ///< what the time did not suffice for
  double seconds = 0.0;           ///< that it took
  bool stopped = false;           ///< compute was told to stop
};

/// Threads that compute the points of a sweep which one other thread gives them, one after another: on each rank of a
/// job, where that other thread talks to the other ranks and must not be kept waiting.
class Crew {
 public:
  Crew(const SweepTask& task, std::size_t threads);
  ~Crew();  ///< stop()
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// `seconds`: no block is begun after that time, so that nobody waits for a piece with more long points than most,
  /// and little is lost when the machine stops.
  void give(std::vector<std::size_t> points, double seconds);

  /// What was finished since the last call.
  std::vector<FinishedPoints> take();

  /// Waits until there is something to take, no longer than so.
  void wait(std::chrono::microseconds patience);

  /// What was not begun is forgotten; returns when all threads have ended, after the block that each is at.
  void stop();

  /// Throws what compute threw first, if it did.
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
  mutable std::mutex mutex_;  ///< of all that follows
  std::condition_variable given_, finished_;
  std::deque<Piece> waiting_;
  std::vector<FinishedPoints> done_;
  std::exception_ptr failure_;
  bool stopped_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace limcycle
