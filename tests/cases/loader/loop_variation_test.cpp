#include "limcycle/cases/loader/loop_variation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/cases/message.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using test::coulomb_servo;

namespace {

/// Result of `--set` with these values: the loop; an empty inner value if the loop is not valid, an empty outer one if
/// another section is not.
std::optional<std::optional<LoopParts>> as_set(const Case& from, std::vector<std::string> paths,
                                               const std::vector<double>& values) {
  auto overrides = from.overrides;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    char text[40];
    std::snprintf(text, sizeof text, "=%.17g", values[i]);
    const std::string number = text;
    overrides.push_back(paths[i] + number + (number.find_first_of(".en") == std::string::npos ? ".0" : ""));
  }
  try {
    return read_case(from.text, from.file, overrides).loop;
  } catch (const InputError& error) {
    if (!error.fault().key.starts_with("loop")) return std::nullopt;
    return std::optional<LoopParts>();
  }
}

std::vector<double> numbers_in(Case from, const LoopParts& parts) {
  from.loop = parts;
  std::vector<double> numbers;
  for (const auto& one : numbers_of(from)) numbers.push_back(one.value);
  return numbers;
}

/// Returns the number of comparisons.
int compare(const Case& from, const std::vector<std::string>& paths, const std::vector<double>& values) {
  const auto expected = as_set(from, paths, values);
  if (!expected) return 0;
  const LoopVariation variation(from, "--x", paths);
  const auto parts = variation.parts(values);
  INFO(from.file << " " << paths.front() << " " << values.front() << " " << paths.back() << " " << values.back());
  CHECK(parts.has_value() == expected->has_value());
  const auto loop = variation.loop(values);
  CHECK(loop.has_value() == expected->has_value());
  if (!parts || !*expected || !loop) return 1;
  CHECK(numbers_in(from, *parts) == numbers_in(from, **expected));
  CHECK(loop->A == build_loop(**expected).A);
  return 1;
}

}  // namespace

TEST_CASE("a loop with other numbers is the one that --set would make", "[variation]") {
  const Case from = read_case(coulomb_servo, "servo.toml", {"loop.controller.ki=4.0"});
  const LoopVariation mass(from, "--x", "loop.plant.mass");
  const auto changed = mass(4.0);
  REQUIRE(changed);
  const Case same = read_case(coulomb_servo, "servo.toml", {"loop.controller.ki=4.0", "loop.plant.mass=4.0"});
  CHECK(changed->A == build_loop(*same.loop).A);
  CHECK_FALSE(mass(-1.0));
  CHECK_FALSE(mass(NAN));
  CHECK_FALSE(mass(1e-320));  // no finite inverse

  // A value that is not written follows: a higher Fs is the Fs of both directions, unless the other is given too.
  const LoopVariation stiction(from, "--x", "loop.friction.Fs");
  CHECK(law_of<Coulomb<double>>(stiction(2.0)->elements.back()).Fs_minus == 2.0);
  CHECK_FALSE(stiction(0.5));  // below Fc
  const std::string both[] = {"loop.friction.Fs_minus", "loop.friction.Fs"};
  const double levels[] = {1.25, 1.75};
  const auto parts = LoopVariation(from, "--x", both).parts(levels);
  REQUIRE(parts);
  CHECK(law_of<Coulomb<double>>(*parts->friction).Fs == 1.75);
  CHECK(law_of<Coulomb<double>>(*parts->friction).Fs_minus == 1.25);
  CHECK(std::get<Pid>(parts->controller).kp == 3.0);

  CHECK_THROWS_WITH(LoopVariation(from, "--x", "loop.plant.mas"), Contains("--x loop.plant.mas") && Contains("mass"));
  CHECK_THROWS_AS(mass.loop({}), std::invalid_argument);
}

TEST_CASE("loops with other numbers are those of --set for every number of every shipped case", "[variation]") {
  std::mt19937 random(7);
  int compared = 0, loops = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(LIMCYCLE_SOURCE_DIR) + "/cases")) {
    if (entry.path().extension() != ".toml") continue;
    const Case from = load_case(entry.path().string(), {});
    if (!from.loop || !limcycle::test::is_done(loops++)) continue;
    const auto numbers = numbers_of(from);
    for (const auto& number : numbers) {
      const double value = std::isfinite(number.value) ? number.value : 1.0;
      const auto& other = numbers[random() % numbers.size()];
      for (const double factor : {0.5, 1.25, -1.0, 0.0}) compared += compare(from, {number.path}, {factor * value});
      compared += compare(from, {number.path}, {1e-5});
      if (other.path != number.path && std::isfinite(other.value))
        compared += compare(from, {number.path, other.path}, {1.5 * value, 0.75 * other.value});
    }
  }
  CHECK(compared > 1000 / limcycle::test::one_in());
}
