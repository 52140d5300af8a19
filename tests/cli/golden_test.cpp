#include "limcycle/tests/cli/golden.hpp"

#include <catch2/catch.hpp>

using limcycle::test::difference;
using Json = nlohmann::ordered_json;

TEST_CASE("golden: the comparer lets pass only what may differ") {
  const Json golden = {{"command", "predict"},
                       {"provenance", {{"version", "1"}, {"seed", 0}}},
                       {"cycles", {{{"period", 24.4367}, {"stable", true}, {"error", 1e-10}, {"offset", 0.0}}}},
                       {"cycle", nullptr}};
  CHECK(difference(golden, golden).empty());
  auto other = golden;
  other["provenance"]["version"] = "2";
  other["cycles"][0]["error"] = 3e-10;
  other["cycles"][0]["period"] = 24.4367 * (1.0 + 1e-8);
  CHECK(difference(golden, other).empty());
  const auto with = [&](auto&& change) {
    auto changed = golden;
    change(changed);
    return difference(golden, changed);
  };
  CHECK(with([](Json& j) { j["command"] = "df"; }) == "/command: text; expected \"predict\", got \"df\"");
  CHECK_FALSE(with([](Json& j) { j["provenance"]["seed"] = 1; }).empty());
  CHECK_FALSE(with([](Json& j) { j["cycles"][0]["period"] = 24.4368; }).empty());
  CHECK_FALSE(with([](Json& j) { j["cycles"][0]["stable"] = false; }).empty());
  CHECK_FALSE(with([](Json& j) { j["cycles"][0]["error"] = 1e-3; }).empty());
  CHECK_FALSE(with([](Json& j) { j["cycles"][0]["error"] = nullptr; }).empty());
  CHECK_FALSE(with([](Json& j) { j["cycles"].push_back(j["cycles"][0]); }).empty());
  CHECK_FALSE(with([](Json& j) { j["more"] = 1; }).empty());
  CHECK_FALSE(with([](Json& j) { j.erase("cycle"); }).empty());
  CHECK_FALSE(with([](Json& j) { j["cycle"] = 0; }).empty());
  CHECK_FALSE(with([](Json& j) {
                j.erase("command");
                j["command"] = "predict";  // the same keys in another order
              }).empty());
}
