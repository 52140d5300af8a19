#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/reports/store/sqlite.hpp"
#include "limcycle/reports/store/store.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/reports/store/store_samples.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

TEST_CASE("status: a store while it is written and afterwards") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  const std::vector<std::size_t> points{3, 7, 11};
  {
    limcycle::SweepStore store(path, sweep_identity(), false);
    store.write(points, store_rows(points));
    store.flush();
    const auto ran = run({"status", path});
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    CHECK_THAT(ran.out, Contains("map: 3 of 100") && Contains("(3 %)") && Contains("Provisional results") &&
                            Contains("Process " + std::to_string(getpid()) + " is"));
  }
  CHECK_THAT(run({"status", path}).out, Contains("No process is running"));
  const auto document = nlohmann::json::parse(run({"status", path, "--json", "-"}).out);
  CHECK(document["points"] == 100);
  CHECK(document["known"] == 3);
  CHECK(document["running"] == false);
  CHECK(document["case"]["file"] == "cases/servo.toml");
  CHECK(run({"status", path, "--csv", "-"}).out == "point,verdict,amplitude,period\n3,3,-4,0\n7,7,-8,0\n11,11,-12,0\n");
}

TEST_CASE("status: what is no store ends with exit code 2, a damaged one with 3") {
  const Scratch scratch;
  const auto missing = run({"status", scratch.file("none.store")});
  CHECK(missing.code == 2);
  CHECK_THAT(missing.err, StartsWith("limcycle: ") && Contains("none.store does not exist"));
  const auto text = run({"status", scratch.put("notes.txt", std::string(1000, 'n'))});
  CHECK(text.code == 2);
  CHECK_THAT(text.err, Contains("is not a store"));
  CHECK(run({"status", text.out, "--set", "loop.reference=1"}).code == 2);
  CHECK(run({"status"}).code == 2);
  const std::vector<std::size_t> points{0, 1, 2};
  {
    limcycle::SweepStore store(scratch.file("a.store"), sweep_identity(), false);
    store.write(points, store_rows(points));
  }
  const std::string whole = scratch.get("a.store");
  const auto damaged = run({"status", scratch.put("a.store", whole.substr(0, whole.size() / 2))});
  CHECK(damaged.code == 3);
  CHECK_THAT(damaged.err, Contains("is damaged") && Contains("compute it again"));
}

TEST_CASE("status: a store that names more points than fit into memory is told with its numbers") {
  const Scratch scratch;
  const std::string path = scratch.file("a.store");
  { limcycle::SweepStore store(path, sweep_identity(), false); }
  limcycle::Database(path, limcycle::Database::Access::write)
      .run("UPDATE identity SET value = '900000000000000000' WHERE key = 'points'");
  const auto ran = run({"status", path});
  CHECK(ran.code == 3);
  CHECK_THAT(ran.err, Contains("a.store is of 900000000000000000 points, each with 3 numbers, and needs 2.17e+10 GB of "
                               "memory; "));
}
