#include <sys/ioctl.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "limcycle/tests/cli/started.hpp"
#include "limcycle/tests/setting.hpp"

using namespace limcycle::test;

TEST_CASE("interrupt: signals at once are one wish to stop, a later one ends even a program that cannot write") {
  const Scratch scratch;
  const std::string pipe = scratch.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDWR | O_CLOEXEC);
  REQUIRE(reader >= 0);
  // A table that is computed at once and exceeds the capacity of a pipe.
  Started program(scratch, {"sh", "-c", "exec \"$@\" > " + quoted(pipe), "sh", tested_program, "df",
                            shipped("relay-third-order.toml"), "--csv", "-", "--set",
                            "df.amplitude={from=0.1, to=10.0, points=100}", "--set",
                            "df.frequency={from=0.1, to=10.0, points=100}"});
  const auto pause = [](int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
  int waiting = 0;
  for (int tries = 0; tries < 6000 && waiting < 60'000; ++tries) {
    REQUIRE(ioctl(reader, FIONREAD, &waiting) == 0);
    pause(10);
  }
  REQUIRE(waiting >= 60'000);
  for (const int signal : {SIGINT, SIGTERM, SIGINT}) {
    kill(program.pid(), signal);
    pause(5);
  }
  pause(1100);
  CHECK(program.works_and_catches(SIGINT, 0.0));  // it is running
  kill(program.pid(), SIGINT);
  CHECK(program.wait().code == 1000 + SIGINT);
  close(reader);
}
