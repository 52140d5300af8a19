#pragma once
#include <chrono>
#include <mutex>
#include <string_view>

namespace limcycle {

/// Progress bar with the time left on stderr: only on a terminal, only when the work takes more than a second, never
/// with --quiet; erased at the end. Calls from several threads are fine.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` done in 0..1; `what` is being done. Draws at most ten times a second.
  void show(double fraction, std::string_view what = {});

 private:
  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  const bool wanted_;
  bool drawn_ = false;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point next_ = begin_ + std::chrono::seconds(1);
};

}  // namespace limcycle
