#pragma once
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// Progress bar with the time left on stderr: only on a terminal, only if the work takes more than a second, never with
/// --quiet; erased at the end. With --verbose it reports at the end, on a terminal or not, the duration of each stage.
/// Calls from several threads are safe.
class Progress {
 public:
  explicit Progress(bool quiet, bool verbose = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` done in 0..1; `what`: the present stage. Draws at most ten times a second.
  void show(double fraction, std::string_view what = {});

  /// Number of known points of a sweep. Points known at the first call (from a store) count neither for the rate nor
  /// for the time left.
  void count(std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;
  double passed() const;  // s
  // With the mutex held:
  void draw(double done, const std::string& more);
  void begin_stage(std::string_view what);

  struct Stage {
    std::string what;
    Clock::duration time{};
  };

  std::mutex mutex_;
  const bool wanted_, verbose_;
  std::vector<Stage> stages_;  // in the order in which they first began
  std::size_t stage_ = 0;      // the present one
  Clock::time_point stage_begin_ = Clock::now();
  bool drawn_ = false;
  std::optional<std::size_t> first_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point next_ = begin_ + std::chrono::seconds(1);
};

}  // namespace limcycle
