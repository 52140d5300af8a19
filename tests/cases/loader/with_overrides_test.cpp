#include "limcycle/cases/loader/with_overrides.hpp"

#include <catch2/catch.hpp>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/remedy_candidates.hpp"

using namespace limcycle;

namespace {

const std::string servo_text = R"(title = "A servo"  # of the workshop
[loop.plant]
kind = "mass"
mass = 1.0   # kg

[loop.controller]
kind = "pid"
kp = 3.0
ki = 4.0     # N/(m s)
kd = 6.0

[loop.friction]
kind = "coulomb"
Fs = 1.5
Fc = 1.0
)";

Case servo_case(const std::vector<std::string>& overrides = {}) {
  return read_case(servo_text, "servo.toml", overrides);
}

}  // namespace

TEST_CASE("with overrides: values are replaced in place, new ones added, comments kept") {
  const auto text = text_with_overrides(servo_case({"loop.plant.mass=2.0"}),
                                        {"loop.controller.ki=0.25", "loop.plant.damping=1.5",
                                         "loop.error.kind=\"dead-zone\"", "loop.error.half_width=0.01"},
                                        "changed");
  REQUIRE(text);
  CHECK_THAT(*text, Catch::Matchers::Contains("title = \"A servo\"  # of the workshop\n"));
  CHECK_THAT(*text, Catch::Matchers::Contains("mass = 2.0   # kg\n"));
  CHECK_THAT(*text, Catch::Matchers::Contains("ki = 0.25     # N/(m s)  # changed\n"));
  CHECK_THAT(*text, Catch::Matchers::Contains("kind = \"mass\"\ndamping = 1.5  # changed\n"));
  CHECK_THAT(*text, Catch::Matchers::Contains("[loop.error]\nkind = \"dead-zone\"  # changed\n"));
  const Case changed = read_case(*text, "changed.toml");
  CHECK(number_at(changed, "", "loop.error.half_width").value == 0.01);
  CHECK(number_at(changed, "", "loop.plant.mass").value == 2.0);
}

TEST_CASE("with overrides: inline tables and blocks of a diagram") {
  const Case one_line = read_case(
      "loop.plant = {kind = \"mass\", mass = 1.0}\nloop.friction = {kind = \"coulomb\", Fs = 1.5, Fc = 1.0}\n",
      "x.toml");
  const auto text = text_with_overrides(one_line, {"loop.friction.Fs=1.25"}, "less");
  REQUIRE(text);
  CHECK_THAT(*text, Catch::Matchers::Contains("Fs = 1.25, Fc = 1.0}  # less\n"));
  // Fc stands inside no other name; a key that ends like another is not taken for it
  const Case masses = read_case(
      "[loop.plant]\nkind = \"two-mass\"\nmotor_mass = 1.0\nload_mass = 2.0\nstiffness = 5.0\n"
      "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n",
      "y.toml");
  const auto load = text_with_overrides(masses, {"loop.plant.load_mass=3.0"}, "");
  REQUIRE(load);
  CHECK_THAT(*load, Catch::Matchers::Contains("motor_mass = 1.0\nload_mass = 3.0\n"));
  const std::string diagram = R"([diagram]
output = "axis.y"
[[diagram.block]]
name = "pid"
kind = "pid"
kp = 3.0
ki = 4.0
kd = 6.0
input = "r - axis.y"
[[diagram.block]]
name = "axis"
kind = "mass"
mass = 1.0
input = "pid"
[[diagram.block]]
name = "guide"
kind = "coulomb"
on = "axis"
Fs = 1.5
Fc = 1.0
)";
  const auto blocks =
      text_with_overrides(read_case(diagram, "d.toml"), {"diagram.pid.ki=1.0", "diagram.axis.damping=2.0"}, "");
  REQUIRE(blocks);
  const Case changed = read_case(*blocks, "d.toml");
  CHECK(number_at(changed, "", "diagram.pid.ki").value == 1.0);
  CHECK(number_at(changed, "", "diagram.axis.damping").value == 2.0);
}

TEST_CASE("with overrides: a value over several lines is refused, not damaged") {
  const Case several = read_case(
      "[loop.plant]\nkind = \"transfer-function\"\nnumerator = [\n1.0]\ndenominator = [1.0, 3.0, 3.0, 1.0]\n"
      "[loop.element]\nkind = \"relay\"\nlevel = 1.0\n",
      "z.toml");
  CHECK_FALSE(text_with_overrides(several, {"loop.plant.numerator=[2.0]"}, ""));
  CHECK(text_with_overrides(several, {"loop.element.level=2.0"}, ""));
}

TEST_CASE("remedy candidates: each name once, applicable where the case has its number") {
  const auto candidates = remedy_candidates(servo_case());
  std::vector<std::string> names, fit;
  for (const auto& one : candidates) {
    names.push_back(one.name);
    CHECK(one.why_not.empty() == (one.parts || one.sized));
    if (one.why_not.empty()) fit.push_back(one.name);
  }
  CHECK(names == std::vector<std::string>{
                     "error-dead-zone", "integrator-dead-zone", "integrator-hysteresis", "integrator-leak",
                     "integrator-clamp", "integrator-reset", "integrator-stop-reset", "gain-kp", "gain-ki", "gain-kd",
                     "gain-line-bandwidth", "gain-line-margin", "friction-compensation", "impulse-compensation",
                     "dither", "integral-band", "velocity-feedforward", "damping", "stiffness"});
  std::erase(names, "velocity-feedforward");
  CHECK(fit == names);
  const auto& zone = candidates.front();
  const auto parts = zone.parts(0.02);
  REQUIRE(parts);
  CHECK(parts->error->number("half_width") == 0.02);
  CHECK_FALSE(zone.parts(-1.0));
  const auto reset = std::ranges::find(candidates, "integrator-reset", &RemedyCandidate::name);
  CHECK(reset->is_absent());
  CHECK(std::get<Pid>(reset->parts(0.5)->controller).integral_reset == 0.5);
  CHECK_FALSE(reset->parts(2.1));
  for (const auto& one : remedy_candidates(servo_case({"loop.controller.leak=0.1"})))
    if (one.name == "integrator-reset") CHECK(one.why_not.find("cannot stand beside leak") != std::string::npos);
}

TEST_CASE("remedy candidates: impulses and a reset at a stop have the sizes of the hunting motion") {
  const auto candidates = remedy_candidates(servo_case());
  const HuntingSizes sizes{0.064, 0.26, 1.5};
  const auto sized = [&](const std::string& name) {
    return std::ranges::find(candidates, name, &RemedyCandidate::name)->sized(sizes);
  };
  const RemedyCandidate impulses = sized("impulse-compensation");
  REQUIRE(impulses.why_not.empty());
  CHECK(impulses.band == 0.0064);
  const auto parts = impulses.parts(2.0);
  REQUIRE(parts);
  const auto& pid = std::get<Pid>(parts->controller);
  CHECK(pid.impulse == 2.0);
  CHECK(pid.impulse_band == 0.0064);
  CHECK(pid.ki == 0.0);
  CHECK(pid.impulse_width < pid.impulse_pause);
  const auto reset = sized("integrator-stop-reset").parts(1.5);
  REQUIRE(reset);
  CHECK(std::get<Pid>(reset->controller).integral_reset == 1.5);
  CHECK(std::get<Pid>(reset->controller).reset_speed == 0.00017);
  const auto limited = remedy_candidates(servo_case({"loop.controller.integral_limit=2.0"}));
  const auto held = std::ranges::find(limited, "impulse-compensation", &RemedyCandidate::name)->sized(sizes);
  CHECK(held.why_not.find("needs ki") != std::string::npos);
}

TEST_CASE("remedy candidates: along a line of gains kd follows kp, in the loop and in the case") {
  const Case from = servo_case();
  for (const auto& one : remedy_candidates(from)) {
    if (!one.name.starts_with("gain-line")) continue;
    CAPTURE(one.name);
    const double kp = 1.5 * one.own;
    const auto parts = one.parts(kp);
    REQUIRE(parts);
    const Case written = read_again(from, remedy_overrides(one, kp));
    CHECK(std::get<Pid>(written.loop->controller).kp == kp);
    CHECK(std::get<Pid>(written.loop->controller).kd == std::get<Pid>(parts->controller).kd);
  }
}

TEST_CASE("remedy candidates: a dither is a sine in [simulate], of which the case then has a section") {
  const auto candidates = remedy_candidates(servo_case());
  const auto dither = std::ranges::find(candidates, "dither", &RemedyCandidate::name);
  REQUIRE(dither->why_not.empty());
  const auto text = text_with_overrides(servo_case(), remedy_overrides(*dither, 2.5), "dither");
  REQUIRE(text);
  const Case with = read_case(*text, "with.toml");
  REQUIRE(with.simulate);
  REQUIRE(with.simulate->force);
  CHECK(with.simulate->force->kind == Signal::Kind::sine);
  CHECK(with.simulate->force->value == 2.5);
  CHECK(with.simulate->force->frequency == dither->frequency);
  for (const auto& one : remedy_candidates(with))
    if (one.name == "dither") CHECK(one.why_not == "[simulate] has a force already");
  for (const auto& one : remedy_candidates(servo_case({"loop.controller.sample_time=0.01"})))
    if (one.name == "dither") CHECK(one.why_not.find("sampling") != std::string::npos);
}

TEST_CASE("remedy candidates: samples of a spread repeat, and leave the remedy's own number alone") {
  const Case from = read_case(servo_text +
                                  "[sensitivity]\nparameters = [{path = \"loop.friction.Fs\", from = 1.1, to = "
                                  "1.9}, {path = \"loop.controller.ki\", factor = 1.5}]\n",
                              "spread.toml");
  CHECK_FALSE(sampled_parts(servo_case(), 0));
  const auto sampled = sampled_parts(from, 7);
  REQUIRE(sampled);
  const auto candidates = remedy_candidates(from);
  const auto ki = std::ranges::find(candidates, "gain-ki", &RemedyCandidate::name);
  const auto first = sampled(*ki, 0.5, 3), again = sampled_parts(from, 7)(*ki, 0.5, 3), other = sampled(*ki, 0.5, 4);
  REQUIRE((first && again && other));
  CHECK(first->friction->number("Fs") == again->friction->number("Fs"));
  CHECK(first->friction->number("Fs") != other->friction->number("Fs"));
  CHECK(std::get<Pid>(first->controller).ki == 0.5);
}
