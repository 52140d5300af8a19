#include "limcycle/cli/time_limit.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"

namespace limcycle {
namespace {

using LimitClock = std::chrono::steady_clock;

constexpr double last_share = 1.8;      // multiple of the limit after which a command that did not stop is ended
constexpr double least_patience = 0.5;  // s, to write the results
constexpr double longest_wait = 1e8;    // s; within the range of a clock

std::atomic<double> limit_at{std::numeric_limits<double>::infinity()};  // of the clock, s

double now_in_seconds() { return std::chrono::duration<double>(LimitClock::now().time_since_epoch()).count(); }

}  // namespace

TimeLimit::TimeLimit(double seconds) {
  if (!(seconds > 0.0)) return;
  limit_at = now_in_seconds() + seconds;
  watch_ = std::thread([this, seconds] { watch(std::min(seconds, longest_wait)); });
}

TimeLimit::~TimeLimit() {
  if (!watch_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  ended_.notify_all();
  watch_.join();
}

double TimeLimit::left() { return std::max(0.0, limit_at.load() - now_in_seconds()); }

bool TimeLimit::ended_within(double seconds) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return over_; });
}

void TimeLimit::watch(double seconds) {
  if (ended_within(seconds)) return;
  time_is_over();
  if (ended_within(std::max(least_patience, (last_share - 1.0) * seconds))) return;
  constexpr std::string_view words =
      "limcycle: the time limit was passed, and the computation did not stop: nothing could be kept\n";
  if (write(STDERR_FILENO, words.data(), words.size()) < 0) std::_Exit(exit_no_answer);  // stderr is closed
  std::_Exit(exit_no_answer);  // a launcher ends the other ranks
}

}  // namespace limcycle
