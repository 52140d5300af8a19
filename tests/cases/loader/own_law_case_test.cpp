#include <catch2/catch.hpp>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/tests/cases/message.hpp"
#include "limcycle/tests/own_laws.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using limcycle::test::message;
using limcycle::test::RoundStribeck;

namespace {

const std::string lone_own = "[loop.friction]\nkind = \"own\"\n";
const std::string loop_with_own = "[loop.plant]\nkind = \"mass\"\nmass = 1.0\n" + lone_own;

}  // namespace

TEST_CASE("own law: kind = \"own\" stands for the law that is handed over, and none without it") {
  const Element mine = own_law(RoundStribeck{});
  CHECK(read_case(lone_own, "a.toml", {}, mine).element->kind() == "round-stribeck");
  const Case from = read_case(loop_with_own, "a.toml", {}, mine);
  CHECK(from.loop->friction->kind() == "round-stribeck");
  CHECK(from.sha256.empty());  // no file holds this case
  CHECK_THAT(message(loop_with_own), Contains(":5: loop.friction.kind = \"own\": stands for a law of one's own"));
  CHECK_THROWS_WITH(read_case(lone_own + "Fc = 1.0\n", "a.toml", {}, mine), Contains("loop.friction.Fc: unknown key"));
}

TEST_CASE("own law: a case that is read again keeps it") {
  const Case from = read_case(loop_with_own, "a.toml", {}, own_law(RoundStribeck{}));
  const std::pair<std::string, double> heavier{"loop.plant.mass", 3.0};
  const auto changed = case_with(from, std::span(&heavier, 1));
  REQUIRE(changed);
  CHECK(number_at(*changed, "--set", "loop.plant.mass").value == 3.0);
  CHECK(changed->loop->friction->kind() == "round-stribeck");
  const Case other = read_again(from, {"loop.friction={kind = \"coulomb\", Fc = 2.0}"});
  CHECK(other.loop->friction->kind() == "coulomb");
}
