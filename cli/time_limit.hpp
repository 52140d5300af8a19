#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>

namespace limcycle {

/// Limits a command to its --time-limit. After `seconds` it asks the command to stop, as Ctrl-C does (time_is_over()).
/// A command still running after 1.8 times as long is ended with exit code 3 and one line on stderr, so that none takes
/// twice its limit. Zero: no limit.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds);
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

  /// Seconds until the limit of this process is reached, at least 0; infinite without one.
  static double left();

 private:
  void watch(double seconds);
  bool ended_within(double seconds);

  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::thread watch_;
};

}  // namespace limcycle
