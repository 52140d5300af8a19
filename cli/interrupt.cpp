#include "limcycle/cli/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace limcycle {
namespace {

std::atomic<bool> asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void ask(int signal) {
  if (!asked.exchange(true)) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, ask) == SIG_IGN) std::signal(signal, SIG_IGN);  // started in the background: stays deaf
}

void interrupt() { asked.store(true, std::memory_order_relaxed); }

bool interrupted() { return asked.load(std::memory_order_relaxed); }

}  // namespace limcycle
