#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <thread>

#include "limcycle/reports/store/store.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/reports/store/store_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

/// Number of stored points, as soon as it reaches `wanted`; else that after 20 s.
std::size_t stored_soon(const std::string& path, std::size_t wanted) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  for (;;) {
    const std::size_t known = read_store(path).activity.known;
    if (known >= wanted || std::chrono::steady_clock::now() > deadline) return known;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace

TEST_CASE("one writer at a time: in this process, in another one, under another name") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  {
    SweepStore store(path, sweep_identity(), false);
    CHECK_THAT(store_refusal(path, sweep_identity(), true),
               Contains("is being written by process " + std::to_string(getpid())));
    std::filesystem::create_symlink(path, scratch.file("link.store"));
    CHECK_THAT(store_refusal(scratch.file("link.store"), sweep_identity(), true), Contains("is being written"));
    fill(store, 0, 50);
    store.flush();  // the refusals did not affect it
    const pid_t other = in_child([&] {
      try {
        const SweepStore second(path, sweep_identity(), true);
      } catch (const StoreError& error) {
        return error.kind() == StoreError::Kind::refused ? 7 : 8;
      }
      return 0;
    });
    CHECK(end_of(other) == 7);
    fill(store, 50, 60);
  }
  CHECK(store_refusal(path, sweep_identity(), true).empty());
  CHECK(read_store(path).activity.known == 60);
  CHECK_FALSE(read_store(path).activity.running);
}

TEST_CASE("a store is read while it is written, always a whole moment of it") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  constexpr std::size_t points = 20000, block = 10;
  SweepStore store(path, sweep_identity(points), false, {.interval = 0.001, .waiting = 1000});
  std::atomic<std::size_t> between{0};  // number of reads that saw a part
  std::jthread writer([&] {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (std::size_t first = 0; first < points; first += block) {
      fill(store, first, first + block);
      while (first == points / 2 && between == 0 && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    store.flush();
  });
  std::size_t last = 0;
  while (last < points) {
    const StoredSweep now = read_store(path);
    REQUIRE(now.activity.known >= last);
    REQUIRE(std::ranges::count(now.known, true) == static_cast<long>(now.activity.known));
    REQUIRE(now.activity.known == now.activity.session_rows);
    REQUIRE(now.activity.known % block == 0);
    // They are written in order: the stored ones are the beginning.
    const auto some = points_from(0, now.activity.known);
    REQUIRE(bits_of(std::span(now.rows).first(3 * some.size())) == bits_of(store_rows(some)));
    between += now.activity.known > 0 && now.activity.known < points ? 1U : 0U;
    last = now.activity.known;
  }
  CHECK(between > 0);
}

TEST_CASE("rows reach the disk one interval after they were handed over, without another call") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  SweepStore store(path, sweep_identity(), false, {.interval = 0.05, .waiting = 1000});
  for (const std::size_t first : {0U, 10U}) {
    fill(store, first, first + 10);
    CHECK(stored_soon(path, first + 10) == first + 10);
  }
}

TEST_CASE("no more rows wait than may, however long the interval") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  SweepStore store(path, sweep_identity(), false, {.interval = 3600.0, .waiting = 10});
  for (std::size_t first = 0; first < 95; first += 5) {
    fill(store, first, first + 5);
    // Those waiting, and those of the transaction in progress.
    CHECK(stored_soon(path, first < 20 ? 0 : first - 20) + 20 >= first);
  }
  store.flush();
  CHECK(read_store(path).activity.known == 95);
}
