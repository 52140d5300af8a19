#include "limcycle/cases/loader/case_numbers.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using test::coulomb_servo;

TEST_CASE("numbers of a case: written, by default, absent, and those that follow another") {
  const Case from = read_case(coulomb_servo, "servo.toml");
  const auto list = numbers_of(from);
  const auto named = [&](const std::string& path) {
    const auto found = std::ranges::find(list, path, &CaseNumber::path);
    REQUIRE(found != list.end());
    return *found;
  };
  CHECK(named("loop.plant.mass").value == 2.0);
  CHECK(named("loop.plant.mass").unit == "kg");
  CHECK(named("loop.plant.damping").value == 0.0);
  CHECK(std::isinf(named("loop.controller.saturation").value));
  CHECK(named("loop.friction.Fs").value == 1.5);
  CHECK_FALSE(named("loop.friction.Fs").follows);
  CHECK(named("loop.friction.Fs_minus").follows);
  CHECK(named("loop.load").value == 0.0);
  CHECK(std::ranges::none_of(list, [](const auto& one) { return one.path.ends_with(".kind"); }));
}

TEST_CASE("numbers of a case: an unknown path is refused with the nearest one") {
  const Case from = read_case(coulomb_servo, "servo.toml");
  CHECK(number_at(from, "--parameter", "loop.controller.kd").value == 6.0);
  CHECK_THROWS_WITH(number_at(from, "--parameter", "loop.controller.kdd"),
                    Contains("--parameter loop.controller.kdd") && Contains("did you mean loop.controller.kd?"));
  CHECK_THROWS_AS(number_at(from, "--parameter", "loop.plant.kind"), InputError);
}
