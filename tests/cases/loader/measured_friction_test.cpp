#include <catch2/catch.hpp>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using limcycle::test::message;

namespace {

std::string friction(const std::string& kind, const std::string& more) {
  return "[loop.friction]\nkind = \"" + kind + "\"\n" + more + "[df]\namplitude = [1e-3]\nfrequency = [1.0]\n";
}

const std::string points = "velocities = [0.001, 0.01]\nforces = [1.2, 1.0]\nFs = 1.5\n";

}  // namespace

TEST_CASE("measured friction: curve = \"table\" stands for the law over measured points") {
  const Case by_curve = read_case(friction("stribeck", "curve = \"table\"\n" + points), "case.toml", {});
  const Case by_name = read_case(friction("stribeck-table", points), "case.toml", {});
  REQUIRE(by_curve.element);
  CHECK(by_curve.element->kind() == "stribeck-table");
  CHECK(by_curve.element->values() == by_name.element->values());
  CHECK(by_curve.element->number("Fs_minus") == 1.5);
  const std::string bristle = "curve = \"table\"\nsigma0 = 1e5\n" + points;
  CHECK(read_case(friction("lugre", bristle), "case.toml", {}).element->kind() == "lugre-table");
  const std::string blocks = "curve = \"table\"\nk = [1e4]\nalpha = [1.0]\nC = 10.0\n" + points;
  CHECK(read_case(friction("gms", blocks), "case.toml", {}).element->kind() == "gms-table");
}

TEST_CASE("measured friction: points that make no curve are refused with the rule") {
  const auto with = [](const std::string& text) { return message(friction("stribeck", "curve = \"table\"\n" + text)); };
  CHECK(with("velocities = [0.01, 0.001]\nforces = [1.2, 1.0]\nFs = 1.5\n").find("must ascend") != std::string::npos);
  CHECK(with("velocities = [0.001]\nforces = [1.2, 1.0]\nFs = 1.5\n").find("must be as many as the 1") !=
        std::string::npos);
  CHECK(with("velocities = [0.0, 0.1]\nforces = [1.2, 1.0]\nFs = 1.5\n").find("> 0") != std::string::npos);
  CHECK(with("velocities = [0.1]\nforces = [1.0]\n").find("Fs: is required") != std::string::npos);
  CHECK(with(points + "vs = 0.1\n").find("vs: unknown key") != std::string::npos);
  const std::string other = message(friction("karnopp", "curve = \"table\"\n" + points));
  CHECK(other.find("is for the kinds stribeck, lugre, gms") != std::string::npos);
}
