#include "limcycle/cli/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace limcycle {
namespace {

std::atomic<bool> asked{false};      // by anyone
std::atomic<bool> signalled{false};  // by the user
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void ask(int signal) {
  asked = true;
  if (!signalled.exchange(true)) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, ask) == SIG_IGN) std::signal(signal, SIG_IGN);  // started in the background: stays deaf
}

void interrupt() { asked.store(true, std::memory_order_relaxed); }

bool interrupted_by_signal() { return signalled.load(std::memory_order_relaxed); }

bool interrupted() { return asked.load(std::memory_order_relaxed); }

}  // namespace limcycle
