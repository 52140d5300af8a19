#include "limcycle/reports/store/store.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <numeric>
#include <thread>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/reports/store/store_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

std::string reading_refusal(const std::string& path) {
  try {
    read_store(path);
  } catch (const StoreError& error) {
    return error.what();
  }
  return {};
}

void sql(const std::string& path, const char* statement) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(path.c_str(), &database) == SQLITE_OK);
  REQUIRE(sqlite3_exec(database, statement, nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(database);
}

std::size_t files_beside(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace

TEST_CASE("a store gives back every bit and its identity, and is one file when it is closed") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  const auto all = points_from(0, 100);
  {
    SweepStore store(path, sweep_identity(), false);
    CHECK(std::ranges::count(store.known(), true) == 0);
    for (const std::size_t first : {60U, 0U, 20U, 80U, 40U}) fill(store, first, first + 20);
    CHECK(bits_of(store.read_all().rows) == bits_of(store_rows(all)));
  }
  CHECK(files_beside(path) == 1);
  const StoredSweep stored = read_store(path);
  CHECK(bits_of(stored.rows) == bits_of(store_rows(all)));
  CHECK(stored.known == std::vector<bool>(100, true));
  const auto wanted = sweep_identity();
  CHECK(stored.identity.title == wanted.title);
  CHECK(stored.identity.overrides == wanted.overrides);
  CHECK(stored.identity.design == wanted.design);
  CHECK(stored.identity.seed == wanted.seed);
  CHECK(stored.identity.columns == wanted.columns);
  CHECK(stored.identity.points == 100);
  CHECK(stored.identity.isa == wanted.isa);
  CHECK(files_beside(path) == 1);  // reading creates no file
}

TEST_CASE("a store goes on where it ended, and counts its sessions") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  { SweepStore(path, sweep_identity(), true).flush(); }  // --resume without a store begins one
  {
    SweepStore store(path, sweep_identity(), true);
    fill(store, 10, 25);
  }  // closing stores waiting rows
  SweepStore store(path, sweep_identity(), true);
  std::vector<bool> expected(100);
  std::fill(expected.begin() + 10, expected.begin() + 25, true);
  CHECK(store.known() == expected);
  fill(store, 0, 5);
  const StoredSweep stored = store.read_all();
  CHECK(stored.activity.known == 20);
  CHECK(stored.activity.sessions == 3);
  CHECK(stored.activity.session_rows == 5);
  CHECK(stored.activity.running);
  CHECK(stored.activity.pid == getpid());
  CHECK(stored.activity.written >= stored.activity.began);
  CHECK(std::ranges::all_of(std::span(stored.rows).subspan(15, 15), [](double value) { return std::isnan(value); }));
}

TEST_CASE("a store refuses another sweep and says what differs") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  {
    SweepStore store(path, sweep_identity(), false);
    fill(store, 0, 10);
  }
  const std::string before = scratch.get("a.store");
  CHECK_THAT(store_refusal(path, sweep_identity(), false),
             Contains(path) && Contains("exists already") && Contains("--resume"));
  const auto changed = [&](auto change) {
    SweepIdentity other = sweep_identity();
    change(other);
    return store_refusal(path, other, true);
  };
  CHECK_THAT(changed([](auto& other) { other.case_sha256 = std::string(64, 'b'); }),
             Contains("holds another sweep") && Contains("the case file") && Contains("aaa") && Contains("bbb"));
  CHECK_THAT(changed([](auto& other) { other.command = "sensitivity"; }),
             Contains("the command is 'map' there and 'sensitivity' now"));
  CHECK_THAT(changed([](auto& other) { other.overrides.pop_back(); }), Contains("--set is"));
  CHECK_THAT(changed([](auto& other) { other.overrides = {"loop.controller.kd=6.5,title=\"two\nlines\""}; }),
             Contains("--set is"));
  CHECK_THAT(changed([](auto& other) { other.design.back() = 'G'; }),
             Contains("the design is '...") && Contains("10, loG' now"));
  CHECK_THAT(changed([](auto& other) { other.seed = 7; }), Contains("the seed is '18446744073709551615' there"));
  CHECK_THAT(changed([](auto& other) { other.columns[1] = "offset"; }), Contains("the columns"));
  CHECK_THAT(changed([](auto& other) { other.points = 101; }), Contains("points is '100' there and '101' now"));
  CHECK_THAT(changed([](auto& other) { other.version = "0.2.0"; }), Contains("the program's version"));
  CHECK_THAT(changed([](auto& other) { other.commit = "0123456789ac"; }), Contains("the program's commit"));
  CHECK_THAT(changed([](auto& other) { other.isa = "avx512"; }), Contains("the instruction set"));
  CHECK_THAT(changed([](auto& other) { other.seed = 7, other.isa = "scalar"; }),
             Contains("the seed") && Contains("the instruction set"));
  CHECK(scratch.get("a.store") == before);
  CHECK(changed([](auto& other) { other.title = other.case_file = "moved"; }).empty());
}

TEST_CASE("what is not a store is refused and left alone") {
  const Scratch scratch;
  const std::string text = scratch.put("notes.txt", std::string(5000, 'n'));
  CHECK_THAT(store_refusal(text, sweep_identity(), true), Contains(text) && Contains("is not a store"));
  CHECK_THAT(reading_refusal(text), Contains("is not a store"));
  CHECK(scratch.get("notes.txt") == std::string(5000, 'n'));
  const std::string other = scratch.file("other.db");
  sql(other, "CREATE TABLE rows(point INTEGER PRIMARY KEY)");
  const std::string before = scratch.get("other.db");
  CHECK_THAT(store_refusal(other, sweep_identity(), true), Contains("is not a store"));
  CHECK_THAT(reading_refusal(other), Contains("is not a store"));
  CHECK(scratch.get("other.db") == before);
  CHECK(files_beside(text) == 2);
  CHECK_THAT(store_refusal(scratch.file("no/folder.store"), sweep_identity(), false),
             Contains("cannot be written: No such file or directory"));
  CHECK_THAT(store_refusal(std::filesystem::path(text).parent_path(), sweep_identity(), true),
             Contains("is not a file"));
  CHECK_THAT(reading_refusal(scratch.file("none.store")), Contains("does not exist"));
  CHECK(files_beside(text) == 2);
  // An empty file holds no data to lose.
  CHECK(store_refusal(scratch.put("empty", ""), sweep_identity(), false).empty());
}

TEST_CASE("a store of a newer program is refused") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  { SweepStore(path, sweep_identity(), false).flush(); }
  sql(path, "PRAGMA user_version = 2");
  CHECK_THAT(store_refusal(path, sweep_identity(), true), Contains("newer limcycle"));
  CHECK_THAT(reading_refusal(path), Contains("newer limcycle"));
}

TEST_CASE("a damaged store is refused, and nothing of it is taken for a result") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  {
    SweepStore store(path, sweep_identity(3000), false);
    fill(store, 0, 3000);
  }
  const std::string whole = scratch.get("a.store");
  const auto refused = [&](const std::string& bytes) {
    scratch.put("a.store", bytes);
    CHECK_THAT(reading_refusal(path), Contains("is damaged"));
    CHECK_THAT(store_refusal(path, sweep_identity(3000), true, StoreError::Kind::failed), Contains("is damaged"));
  };
  refused(whole.substr(0, whole.size() / 2));
  refused(whole.substr(0, whole.size() - 4096));
  // The database does not detect a changed bit of a number.
  const std::string third("\x55\x55\x55\x55\x55\x55\xd5\x3f", 8);
  const auto at = whole.find(third);
  REQUIRE(at != std::string::npos);
  std::string one_bit = whole;
  one_bit[at] ^= 1;
  refused(one_bit);
  scratch.put("a.store", whole);
  CHECK(reading_refusal(path).empty());
}

TEST_CASE("what a process had begun to change in a store at rest when it was killed is undone by the next reader") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  constexpr std::size_t points = 3000;
  {
    SweepStore store(path, sweep_identity(points), false);
    fill(store, 0, points);
  }
  const std::string whole = scratch.get("a.store");
  const pid_t other = in_child([&] {
    sqlite3* database = nullptr;
    return sqlite3_open(path.c_str(), &database) == SQLITE_OK &&
                   sqlite3_exec(database, "PRAGMA cache_size = 5; BEGIN; UPDATE rows SET checksum = 0", nullptr,
                                nullptr, nullptr) == SQLITE_OK
               ? 5
               : 6;
  });
  REQUIRE(end_of(other) == 5);
  REQUIRE(std::filesystem::exists(path + "-journal"));
  REQUIRE(scratch.get("a.store") != whole);
  CHECK(bits_of(read_store(path).rows) == bits_of(store_rows(points_from(0, points))));
}

TEST_CASE("a store takes no point twice, none that does not exist, and no half row") {
  const Scratch scratch;
  SweepStore store(scratch.file("a.store"), sweep_identity(), false);
  fill(store, 0, 10);
  const auto before = store.known();
  for (const auto& points : {std::vector<std::size_t>{20, 5}, {30, 100}, {40, 40}}) {
    CHECK_THROWS_AS(store.write(points, store_rows(points)), std::invalid_argument);
    CHECK(store.known() == before);
  }
  const std::vector<std::size_t> points{50, 51};
  CHECK_THROWS_AS(store.write(points, std::vector<double>(5)), std::invalid_argument);
  CHECK(store.read_all().activity.known == 10);
  SweepIdentity empty = sweep_identity();
  empty.columns.clear();
  CHECK_THROWS_AS(SweepStore(scratch.file("b.store"), empty, false), std::invalid_argument);
  CHECK_THROWS_AS(SweepStore(scratch.file("b.store"), sweep_identity(), false, {.interval = NAN, .waiting = 1}),
                  std::invalid_argument);
  CHECK_FALSE(std::filesystem::exists(scratch.file("b.store")));
}
