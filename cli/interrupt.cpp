#include "limcycle/cli/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <ctime>

namespace limcycle {
namespace {

std::atomic<bool> asked{false};              // by any source
std::atomic<bool> time_over{false};          // before the user asked
std::atomic<long long> signalled{0};         // time of the user's first signal, ns; 0: none yet
constexpr long long second = 1'000'000'000;  // signals within this time after the first count as one
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<long long>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

extern "C" void ask(int signal) {
  asked = true;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // POSIX, safe in a signal handler
  const long long at = second * now.tv_sec + now.tv_nsec;
  long long first = 0;
  if (signalled.compare_exchange_strong(first, at) || at - first < second) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, ask) == SIG_IGN) std::signal(signal, SIG_IGN);  // background: stays ignored
}

void interrupt() { asked.store(true, std::memory_order_relaxed); }

void time_is_over() {
  if (!interrupted()) time_over = true;
  interrupt();
}

bool interrupted_by_signal() { return signalled.load(std::memory_order_relaxed) != 0; }

bool interrupted() { return asked.load(std::memory_order_relaxed); }

bool interrupted_by_time() { return time_over.load(std::memory_order_relaxed); }

Status ending_so_far() { return interrupted() ? Status::interrupted : Status::converged; }

}  // namespace limcycle
