#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <new>
#include <random>
#include <thread>

#include "limcycle/analysis/sweep.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/reports/store/store_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

/// Files after a loss of power: their content when they were last made durable, without later writes; and removed
/// files, unless their folder was made durable afterwards. No file system is worse.
struct PowerLoss {
  std::atomic<bool> watching{false};
  std::string folder;
  std::atomic<int> syncs{0};
};
PowerLoss power_loss;

void keep_as_durable(int descriptor) {
  if (!power_loss.watching) return;
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path file = fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), ignored);
  const fs::path kept = power_loss.folder;
  if (fs::is_regular_file(file, ignored)) {
    fs::copy_file(file, kept / file.filename(), fs::copy_options::overwrite_existing, ignored);
  } else if (fs::is_directory(file, ignored)) {
    for (const auto& entry : std::vector<fs::path>(fs::directory_iterator(kept), fs::directory_iterator()))
      if (!fs::exists(file / entry.filename(), ignored)) fs::remove(entry, ignored);
  }
  ++power_loss.syncs;
}

}  // namespace

// Replace those of the C library, for SQLite too: a program's own definitions come first.
extern "C" int fsync(int descriptor) {
  const auto result = static_cast<int>(syscall(SYS_fsync, descriptor));
  keep_as_durable(descriptor);
  return result;
}
extern "C" int fdatasync(int descriptor) {
  const auto result = static_cast<int>(syscall(SYS_fdatasync, descriptor));
  keep_as_durable(descriptor);
  return result;
}

namespace {

constexpr std::size_t crash_points = 12000, crash_block = 4;
constexpr int crash_threads = 2;
constexpr StoreOptions crash_options{.interval = 0.005, .waiting = 64};

/// Counters that survive a killed process, shared with the one that killed it.
struct Witness {
  std::atomic<int> begun{0};                     ///< computations, of this process
  std::atomic<int> computed[crash_points] = {};  ///< times that a point was begun, of all processes
};

class SharedWitness {
 public:
  SharedWitness() {
    void* memory = mmap(nullptr, sizeof(Witness), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    witness_ = new (memory) Witness;
  }
  ~SharedWitness() { munmap(witness_, sizeof(Witness)); }
  SharedWitness(const SharedWitness&) = delete;
  SharedWitness& operator=(const SharedWitness&) = delete;
  Witness* operator->() const { return witness_; }

 private:
  Witness* witness_;
};

/// A sweep into a store, with --resume, in which each point takes `each`.
int sweep_into(const std::string& path, const SharedWitness& witness, std::chrono::microseconds each) {
  SweepStore store(path, sweep_identity(crash_points), true, crash_options);
  const SweepTask task{crash_points, 3, crash_block, [&](std::span<const std::size_t> points, std::span<double> rows) {
                         witness->begun = 1;
                         for (std::size_t i = 0; i < points.size(); ++i) {
                           ++witness->computed[points[i]];
                           if (each.count() > 0) std::this_thread::sleep_for(each);
                           std::ranges::copy(store_row(points[i]), rows.begin() + static_cast<long>(3 * i));
                         }
                         return points.size();
                       }};
  SweepOptions options;
  options.threads = crash_threads;
  const Status status = run_sweep(
      task, store.known(), [&](auto points, auto rows) { store.write(points, rows); }, options);
  store.flush();
  return status == Status::converged ? 0 : 1;
}

/// Kills the process `life` after its start or after its first computation. False: it ended by itself.
bool kill_after(pid_t pid, std::chrono::microseconds life, bool from_computing, const SharedWitness& witness) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(20);
  while (from_computing && witness->begun == 0 && Clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  std::this_thread::sleep_for(life);
  kill(pid, SIGKILL);
  return end_of(pid) == 1000 + SIGKILL;
}

/// The stored points; empty if the process was killed before there was a store.
std::vector<bool> stored_points(const std::string& path) {
  try {
    return read_store(path).known;
  } catch (const StoreError& error) {
    CHECK(error.kind() == StoreError::Kind::refused);
    CHECK_THAT(error.what(), Contains("does not exist") || Contains("holds no sweep yet"));
    return std::vector<bool>(crash_points);
  }
}

}  // namespace

TEST_CASE("a sweep that is killed at random fifty times computes again only what was not stored, and loses nothing") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  const SharedWitness witness;
  std::mt19937 random(20260117);
  std::vector<bool> stored(crash_points);
  std::vector<int> before(crash_points), lost(crash_points);
  std::size_t most_lost = 0;
  for (int k = 0; k < 50; ++k) {
    CAPTURE(k);
    witness->begun = 0;
    const pid_t pid = in_child([&] { return sweep_into(path, witness, std::chrono::microseconds(500)); });
    REQUIRE(kill_after(pid, std::chrono::microseconds(random() % 60000), k % 2 == 1, witness));
    const auto now = stored_points(path);
    std::size_t again = 0, forgotten = 0, recomputed = 0, twice = 0, from_nowhere = 0;
    for (std::size_t i = 0; i < crash_points; ++i) {
      const int times = witness->computed[i] - before[i];
      before[i] += times;
      twice += times > 1 ? 1U : 0U;
      recomputed += stored[i] && times > 0 ? 1U : 0U;
      forgotten += stored[i] && !now[i] ? 1U : 0U;
      from_nowhere += now[i] && !stored[i] && times == 0 ? 1U : 0U;
      again += times > 0 && !now[i] ? 1U : 0U;
      lost[i] += times > 0 && !now[i] ? 1 : 0;
    }
    REQUIRE(twice == 0);
    REQUIRE(recomputed == 0);
    REQUIRE(forgotten == 0);
    REQUIRE(from_nowhere == 0);
    most_lost = std::max(most_lost, again);
    stored = now;
  }
  // One transaction in progress, one waiting, and a block on each thread.
  CHECK(most_lost <= 2 * (crash_options.waiting + crash_block) + crash_threads * crash_block);
  const auto known = std::count(stored.begin(), stored.end(), true);
  CHECK(known > 0);
  CHECK(known < static_cast<long>(crash_points));  // else the last processes were not killed at work
  REQUIRE(end_of(in_child([&] { return sweep_into(path, witness, std::chrono::microseconds(0)); })) == 0);
  for (std::size_t i = 0; i < crash_points; ++i)
    if (witness->computed[i] != 1 + lost[i])
      FAIL("point " << i << " was computed " << witness->computed[i] << " times");

  const SharedWitness other;
  const std::string straight = scratch.file("b.store");
  REQUIRE(end_of(in_child([&] { return sweep_into(straight, other, std::chrono::microseconds(0)); })) == 0);
  const StoredSweep one = read_store(path), two = read_store(straight);
  CHECK(bits_of(one.rows) == bits_of(two.rows));
  CHECK(one.known == std::vector<bool>(crash_points, true));
  CHECK(one.activity.sessions > 25);
}

TEST_CASE("what flush returned for survives a loss of power") {
  const Scratch scratch;
  const Scratch after;
  constexpr std::size_t points = 2000;
  power_loss.folder = std::filesystem::path(after.file("x")).parent_path();
  power_loss.syncs = 0;
  power_loss.watching = true;
  std::mt19937 random(1);
  {
    SweepStore store(scratch.file("a.store"), sweep_identity(points), false, {.interval = 0.001, .waiting = 1000});
    for (std::size_t done = 0; done < points;) {
      std::vector<std::size_t> some;
      for (const std::size_t end = std::min(points, done + 1 + random() % 150); done < end; ++done)
        some.push_back(done);
      store.write(some, store_rows(some));
      store.flush();
      power_loss.watching = false;
      const StoredSweep left = read_store(after.file("a.store"));
      CHECK(left.activity.known == done);
      CHECK(std::count(left.known.begin(), left.known.begin() + static_cast<long>(done), true) ==
            static_cast<long>(done));
      std::filesystem::remove(after.file("a.store-shm"));
      power_loss.watching = true;
    }
  }
  power_loss.watching = false;
  CHECK(power_loss.syncs > 20);
  CHECK(read_store(after.file("a.store")).activity.known == points);
  CHECK(read_store(scratch.file("a.store")).activity.known == points);
}

TEST_CASE("a full disk ends a sweep with what is stored, which is whole and goes on when there is room") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  const SharedWitness witness;
  for (const rlim_t room : {2000U, 40000U, 150000U, 400000U}) {
    CAPTURE(room);
    const pid_t pid = in_child([&] {
      std::signal(SIGXFSZ, SIG_IGN);  // so that writing fails, as on a full disk
      const rlimit limit{room, room};
      if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 3;
      try {
        sweep_into(path, witness, std::chrono::microseconds(0));
      } catch (const StoreError& error) {
        scratch.put("words",
                    std::string(error.kind() == StoreError::Kind::failed ? "failed " : "refused ") + error.what());
        return 4;
      }
      return 5;
    });
    REQUIRE(end_of(pid) == 4);
    const std::string words = scratch.get("words");
    CHECK_THAT(words, Catch::Matchers::StartsWith("failed " + path));
    if (!std::filesystem::exists(path)) {
      CHECK(room == 2000);  // no room for an empty store: nothing remains
      continue;
    }
    const StoredSweep left = read_store(path);
    CHECK_THAT(words,
               Contains(std::to_string(left.activity.known) + " of 12000 points are stored") && Contains("--resume"));
    CHECK(left.activity.known < crash_points);
    for (std::size_t i = 0; i < crash_points; ++i)
      if (left.known[i] && bits_of(std::span(left.rows).subspan(3 * i, 3)) != bits_of(store_row(i)))
        FAIL("point " << i);
  }
  const std::size_t before = read_store(path).activity.known;
  CHECK(before > 0);
  REQUIRE(end_of(in_child([&] { return sweep_into(path, witness, std::chrono::microseconds(0)); })) == 0);
  CHECK(read_store(path).activity.known == crash_points);
  CHECK(read_store(path).activity.session_rows == crash_points - before);
}
