#include "limcycle/cli/interrupt.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

TEST_CASE("interrupt: two signals at once are one wish to stop, a later one ends the program") {
  const pid_t child = fork();
  if (child == 0) {
    limcycle::catch_interrupts();
    if (limcycle::interrupted() || limcycle::interrupted_by_signal()) _exit(1);
    raise(SIGINT);
    raise(SIGTERM);
    raise(SIGINT);
    if (!limcycle::interrupted() || !limcycle::interrupted_by_signal()) _exit(2);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    raise(SIGTERM);
    _exit(3);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK((WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status)) == 1000 + SIGTERM);
}
