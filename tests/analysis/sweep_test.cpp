#include "limcycle/analysis/sweep.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

using namespace limcycle;

namespace {

/// A row that depends on its index alone, with every kind of number among its values.
void sweep_row(std::size_t point, std::span<double> row) {
  row[0] = std::sin(static_cast<double>(point)) * std::exp(0.01 * static_cast<double>(point));
  row[1] = point % 7 == 0 ? -std::numeric_limits<double>::infinity() : -0.0;
  row[2] = std::bit_cast<double>(std::uint64_t{0x7ff8000000000000U} + point);  // a NaN that carries its point
}

constexpr std::size_t three = 3;

SweepTask sweep_of(std::size_t points, std::size_t block) {
  return {points, three, block, [](std::span<const std::size_t> some, std::span<double> rows) {
            for (std::size_t i = 0; i < some.size(); ++i) sweep_row(some[i], rows.subspan(i * three, three));
            return some.size();
          }};
}

/// Bits of all rows, and the number of times each point came.
struct Kept {
  explicit Kept(std::size_t points) : bits(points * three), times(points) {}
  void take(std::span<const std::size_t> points, std::span<const double> rows) {
    REQUIRE(rows.size() == points.size() * three);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ++times[points[i]];
      for (std::size_t k = 0; k < three; ++k)
        bits[points[i] * three + k] = std::bit_cast<std::uint64_t>(rows[i * three + k]);
    }
  }
  SweepSink sink() {
    return [this](std::span<const std::size_t> points, std::span<const double> rows) { take(points, rows); };
  }
  std::size_t known() const { return times.size() - static_cast<std::size_t>(std::ranges::count(times, 0)); }
  std::vector<bool> flags() const {
    std::vector<bool> out;
    for (const int count : times) out.push_back(count > 0);
    return out;
  }
  std::vector<std::uint64_t> bits;
  std::vector<int> times;
};

Kept expected_rows(std::size_t points) {
  Kept kept(points);
  std::vector<double> row(three);
  for (std::size_t i = 0; i < points; ++i) {
    sweep_row(i, row);
    kept.take(std::vector{i}, row);
  }
  return kept;
}

SweepOptions with_threads(int threads) {
  SweepOptions options;
  options.threads = threads;
  return options;
}

}  // namespace

TEST_CASE("a sweep gives the same bits for any number of threads and any block, each point once") {
  const Kept expected = expected_rows(101);
  for (const int threads : {1, 2, 3, 8})
    for (const std::size_t block : {1U, 4U, 100U, 101U, 1000U}) {
      CAPTURE(threads, block);
      Kept kept(101);
      CHECK(run_sweep(sweep_of(101, block), {}, kept.sink(), with_threads(threads)) == Status::converged);
      CHECK(kept.bits == expected.bits);
      CHECK(kept.times == expected.times);
    }
}

TEST_CASE("a sweep does not ask again for points that are known, and hands out the rest in order") {
  std::vector<bool> known(50);
  for (std::size_t i = 0; i < 50; ++i) known[i] = i % 3 == 0 || i > 40;
  Kept kept(50);
  std::vector<std::size_t> asked;
  SweepTask task = sweep_of(50, 4);
  task.compute = [&, inner = task.compute](std::span<const std::size_t> points, std::span<double> rows) {
    asked.insert(asked.end(), points.begin(), points.end());
    return inner(points, rows);
  };
  CHECK(run_sweep(task, known, kept.sink(), with_threads(1)) == Status::converged);
  CHECK(std::ranges::is_sorted(asked));
  const Kept expected = expected_rows(50);
  for (std::size_t i = 0; i < 50; ++i) {
    CAPTURE(i);
    CHECK(kept.times[i] == (known[i] ? 0 : 1));
    CHECK((known[i] || kept.bits[3 * i + 2] == expected.bits[3 * i + 2]));
  }
  // An empty task is done without a call.
  SweepTask never = sweep_of(50, 4);
  never.compute = [](auto, auto) -> std::size_t { throw std::runtime_error("asked"); };
  CHECK(run_sweep(never, std::vector<bool>(50, true), kept.sink()) == Status::converged);
  CHECK(run_sweep(sweep_of(0, 4), {}, kept.sink()) == Status::converged);
}

TEST_CASE("blocks are handed out once each, to whoever asks") {
  SweepBlocks blocks(1000, 7, {});
  CHECK(blocks.missing() == 1000);
  CHECK(blocks.blocks() == 143);
  std::mutex guard;
  std::multiset<std::size_t> seen;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (auto some = blocks.next(); !some.empty(); some = blocks.next()) {
          const std::lock_guard lock(guard);
          seen.insert(some.begin(), some.end());
        }
      });
  }
  CHECK(seen.size() == 1000);
  CHECK(std::set(seen.begin(), seen.end()).size() == 1000);
  CHECK(blocks.next().empty());
}

TEST_CASE("several blocks come in one span, up to the end") {
  std::vector<bool> known(20, false);
  known[3] = known[19] = true;
  SweepBlocks blocks(20, 4, known);
  const auto values = [](std::span<const std::size_t> points) { return std::vector(points.begin(), points.end()); };
  CHECK(values(blocks.next(2)) == std::vector<std::size_t>{0, 1, 2, 4, 5, 6, 7, 8});
  CHECK(values(blocks.next()) == std::vector<std::size_t>{9, 10, 11, 12});
  CHECK(values(blocks.next(7)) == std::vector<std::size_t>{13, 14, 15, 16, 17, 18});
  CHECK(blocks.next(2).empty());
}

TEST_CASE("a sweep that is told to stop keeps what is finished, and goes on from there to the same bits") {
  const Kept expected = expected_rows(60);
  for (const int threads : {1, 3}) {
    CAPTURE(threads);
    Kept kept(60);
    int runs = 0;
    Status status = Status::interrupted;
    while (status == Status::interrupted && runs < 100) {
      ++runs;
      SweepOptions options = with_threads(threads);
      options.stop = [calls = 0]() mutable { return ++calls > 3; };
      const std::size_t before = kept.known();
      status = run_sweep(sweep_of(60, 5), kept.flags(), kept.sink(), options);
      CHECK(kept.known() == std::min<std::size_t>(60, before + 15));
    }
    CHECK(runs == 4);  // 15 points a run
    CHECK(kept.bits == expected.bits);
    CHECK(kept.times == expected.times);
  }
}

TEST_CASE("a computation that is stopped inside a block gives the rows that it finished") {
  Kept kept(40);
  SweepTask task = sweep_of(40, 10);
  task.compute = [inner = task.compute](std::span<const std::size_t> points, std::span<double> rows) {
    return points.front() == 20 ? inner(points.first(3), rows) : inner(points, rows);
  };
  CHECK(run_sweep(task, {}, kept.sink(), with_threads(1)) == Status::interrupted);
  CHECK(kept.known() == 23);
  CHECK(kept.times[22] == 1);
  CHECK(kept.times[23] == 0);
}

TEST_CASE("numbers that a computation forgets are missing, not those of another point") {
  std::vector<double> got(8, 0.0);
  const SweepTask task{8, 1, 2, [](std::span<const std::size_t> points, std::span<double> rows) {
                         if (points.front() < 4) std::ranges::fill(rows, 1.0);
                         return points.size();
                       }};
  run_sweep(
      task, {}, [&](auto points, auto rows) { std::ranges::copy(rows, got.begin() + static_cast<long>(points[0])); },
      with_threads(1));
  CHECK(std::ranges::count(got, 1.0) == 4);
  CHECK(std::ranges::count_if(got, [](double value) { return std::isnan(value); }) == 4);
}

TEST_CASE("an exception of a computation ends the sweep after all threads, and what went to the sink stays") {
  for (const int threads : {1, 2, 3}) {
    CAPTURE(threads);
    Kept kept(300);
    std::atomic<int> inside{0};
    SweepTask task = sweep_of(300, 2);
    task.compute = [&, inner = task.compute](std::span<const std::size_t> points, std::span<double> rows) {
      ++inside;
      if (points.front() == 100) {
        --inside;
        throw std::runtime_error("point 100");
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      const auto done = inner(points, rows);
      --inside;
      return done;
    };
    CHECK_THROWS_WITH(run_sweep(task, {}, kept.sink(), with_threads(threads)), "point 100");
    CHECK(inside == 0);
    CHECK(kept.times[100] == 0);
    // Blocks are begun in order, and those already begun on other threads are finished.
    CHECK(std::all_of(kept.times.begin(), kept.times.begin() + 100, [](int count) { return count == 1; }));
    if (threads == 1) CHECK(kept.known() == 100);
  }
}

TEST_CASE("a sink that fails ends the sweep and is not called again") {
  for (const int threads : {1, 3}) {
    CAPTURE(threads);
    // All threads have finished a block when the sink fails for the first of them.
    std::atomic<int> begun{0}, calls{0};
    SweepTask task = sweep_of(400, 2);
    task.compute = [&, inner = task.compute](std::span<const std::size_t> points, std::span<double> rows) {
      ++begun;
      while (begun < threads) std::this_thread::yield();
      return inner(points, rows);
    };
    const SweepSink sink = [&](auto, auto) {
      ++calls;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      throw std::runtime_error("full");
    };
    CHECK_THROWS_WITH(run_sweep(task, {}, sink, with_threads(threads)), "full");
    CHECK(calls == 1);
  }
}

TEST_CASE("sink and progress are called by one thread at a time, and progress counts what was known") {
  std::atomic<int> inside{0};
  std::size_t most = 0, calls = 0, last = 0;
  bool rising = true;
  const auto alone = [&] { most = std::max<std::size_t>(most, static_cast<std::size_t>(++inside)); };
  SweepOptions options = with_threads(4);
  options.progress = [&](std::size_t done, std::size_t total) {
    alone();
    CHECK(total == 200);
    if (calls++ == 0) CHECK(done == 40);
    rising = rising && (calls == 1 || done > last);
    last = done;
    --inside;
  };
  std::vector<bool> known(200);
  std::fill_n(known.begin(), 40, true);
  const SweepSink sink = [&](auto, auto) {
    alone();
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    --inside;
  };
  CHECK(run_sweep(sweep_of(200, 3), known, sink, options) == Status::converged);
  CHECK(most == 1);
  CHECK(rising);
  CHECK(last == 200);
  CHECK(calls == 1 + 54);
}

TEST_CASE("a task that makes no sense is refused") {
  const SweepSink sink = [](auto, auto) {};
  SweepTask task = sweep_of(10, 0);
  CHECK_THROWS_AS(run_sweep(task, {}, sink), std::invalid_argument);
  task = sweep_of(10, 1);
  CHECK_THROWS_AS(run_sweep(task, std::vector<bool>(9), sink), std::invalid_argument);
  CHECK_THROWS_AS(run_sweep(task, {}, {}), std::invalid_argument);
  CHECK_THROWS_AS(run_sweep(task, {}, sink, with_threads(-1)), std::invalid_argument);
  task.columns = 0;
  CHECK_THROWS_AS(run_sweep(task, {}, sink), std::invalid_argument);
  task = sweep_of(10, 1);
  task.compute = {};
  CHECK_THROWS_AS(run_sweep(task, {}, sink), std::invalid_argument);
  task.compute = [](auto points, auto) { return points.size() + 1; };
  CHECK_THROWS_AS(run_sweep(task, {}, sink), std::logic_error);
}
