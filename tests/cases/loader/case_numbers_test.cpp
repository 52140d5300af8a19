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

TEST_CASE("numbers of a case: a name that one path alone ends with stands for it, others are refused") {
  const Case servo = load_case(LIMCYCLE_SOURCE_DIR "/cases/pid-lugre.toml");
  for (const auto* name : {"kp", "controller.kp", "loop.controller.kp"})
    CHECK(number_named(servo, "--vary", name).path == "loop.controller.kp");
  CHECK_THROWS_WITH(number_named(servo, "--vary", "kq"),
                    Contains("--vary kq: is not a parameter") && Contains("did you mean"));
  CHECK_THROWS_WITH(number_named(servo, "--vary", "p"), Contains("is not a parameter"));
  CHECK_THROWS_WITH(number_named(servo, "--vary", "loop.controller.kq"), Contains("did you mean loop.controller.kp?"));
  const Case two = load_case(
      LIMCYCLE_SOURCE_DIR "/cases/pid-lugre.toml",
      {"loop.error={kind=\"dead-zone\", half_width=0.1}", "loop.element={kind=\"dead-zone\", half_width=0.1}"});
  CHECK_THROWS_WITH(number_named(two, "--vary", "half_width"), Contains("is the name of several numbers; write loop."));
}

TEST_CASE("numbers of a case: a value is written in the fewest digits that read back as the same") {
  CHECK(override_of("a.b", 0.1) == "a.b=0.1");
  CHECK(override_of("a.b", 8.0) == "a.b=8.0");
  CHECK(override_of("a.b", -1.0 / 3.0) == "a.b=-0.3333333333333333");
  CHECK(override_of("a.b", 1e-7) == "a.b=1e-07");
}
