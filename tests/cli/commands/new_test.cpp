#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/reports/case_files/new_case.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/share.hpp"

using limcycle::Case;
using limcycle::NewCase;
using limcycle::read_case;
using limcycle::test::Ran;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::some_of;
using Kinds = std::vector<std::string>;

namespace {

Kinds kinds_in(const std::string& group) {
  Kinds kinds;
  for (const auto& entry : limcycle::catalogue())
    if (entry.group == group && entry.kind != "frf") kinds.push_back(entry.kind);  // that one needs a file of data
  return kinds;
}

/// Without one there is no friction, and no cascade: the output of a plant of first order follows a force at once.
bool has_velocity(const std::string& plant) { return plant != "first-order"; }

/// Error of the reader for a case; empty if there is none.
std::string complaint(const std::string& text) {
  try {
    read_case(text, "new");
    return {};
  } catch (const limcycle::InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("new: every plant with every controller and every friction law is a valid case") {
  int cases = 0;
  for (const auto& plant : kinds_in("plant"))
    for (const auto& controller : some_of(kinds_in("controller")))
      for (const auto& friction : kinds_in("friction"))
        for (const bool all : {false, true}) {
          INFO(plant << ' ' << controller << ' ' << friction << ' ' << all);
          if (!has_velocity(plant)) {
            CHECK(complaint(limcycle::new_case({plant, controller, friction})).find("relative degree 2") !=
                  std::string::npos);
            continue;
          }
          const Case made = read_case(limcycle::new_case({plant, controller, friction, {}, {}, all}), "new");
          REQUIRE(made.loop);
          CHECK(kind_of(made.loop->plant) == plant);
          CHECK(kind_of(made.loop->controller) == controller);
          CHECK(made.loop->friction->kind() == friction);
          // Lists have no single number to spread.
          if (friction != "maxwell-slip") CHECK(made.sensitivity.has_value() == all);
          CHECK(made.simulate.has_value() == all);
          ++cases;
        }
  CHECK(cases == 2 * 9 * std::ssize(some_of(kinds_in("controller"))) * 23);
}

TEST_CASE("new: a cascade as a diagram, without kinds of slots") {
  const Ran made = run({"new", "--diagram"});
  REQUIRE(made.code == 0);
  const Case from = read_case(made.out, "new");
  REQUIRE(from.loop);
  REQUIRE(from.loop->diagram);
  CHECK(from.loop->diagram->blocks.size() == 5);
  const Ran refused = run({"new", "--diagram", "--plant", "belt"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("--diagram") != std::string::npos);
}

TEST_CASE("new: a sampled axis with a measured friction curve, in few lines") {
  const Ran made = run(
      {"new", "--plant", "mass", "--controller", "cascade", "--friction", "stribeck-table", "--sampled", "--brief"});
  REQUIRE(made.code == 0);
  CHECK(std::ranges::count(made.out, '\n') < 60);
  const Case from = read_case(made.out, "new");
  REQUIRE(from.loop);
  const auto& cascade = std::get<limcycle::Cascade>(from.loop->controller);
  CHECK(cascade.sample_time == 0.01);
  CHECK(cascade.position_every == 4.0);
  CHECK(cascade.input_step == 1e-6);
  CHECK(made.out.find("\n# ") < made.out.find("[loop.plant]"));  // comments, but no optional keys
  CHECK(made.out.find("# saturation") == std::string::npos);
  CHECK(made.out.find("[simulate]") == std::string::npos);
  const Ran refused = run({"new", "--diagram", "--sampled"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("sample_time into the blocks") != std::string::npos);
}

TEST_CASE("new: every element, alone and beside friction, before every plant and behind every controller") {
  for (const auto& plant : kinds_in("plant"))
    for (const auto& controller : some_of(kinds_in("controller")))
      for (const auto& friction : {"", "lugre", "coulomb"})
        for (const auto& element : kinds_in("element")) {
          if (!has_velocity(plant) && (controller == "cascade" || !std::string(friction).empty())) continue;
          INFO(plant << ' ' << controller << ' ' << friction << ' ' << element);
          CHECK(complaint(limcycle::new_case({plant, controller, friction, element, {}, true})) == "");
        }
}

TEST_CASE("new: the kinds that are told beside the chosen one are those that may stand there") {
  const auto others = [](const std::string& text, const std::string& section) {
    const auto at = text.find("# others", text.find("\n[" + section + "]\n"));
    return limcycle::test::squeezed(text.substr(at, text.find("kind =", at) - at));
  };
  const auto text = limcycle::new_case({"mass", "pid", {}, "relay", "dead-zone", false});
  CHECK(others(text, "loop.error") == "# others quantizer, saturation ");
  CHECK(others(text, "loop.element")
            .starts_with("# others saturation, rate-limit, dead-zone, hysteretic-dead-zone, backlash, # "
                         "valve-stiction, cubic, sine, "
                         "lookup, clamped-pi, reset-integrator, # stop-reset-integrator, impulses, window, or a"));
}

TEST_CASE("new: every element on the error, and every friction law as an element, where the format has it") {
  for (const auto& plant : kinds_in("plant"))
    for (const auto& controller : some_of(kinds_in("controller"))) {
      if (!has_velocity(plant) && controller == "cascade") continue;
      for (const auto& error : {"dead-zone", "saturation", "quantizer"}) {
        INFO(plant << ' ' << controller << ' ' << error);
        const std::string friction = has_velocity(plant) ? "lugre" : "", element = friction.empty() ? "relay" : "";
        const auto why = complaint(limcycle::new_case({plant, controller, friction, element, error}));
        // Friction alone does not use the error, which then cannot have an element on it.
        const bool unused = controller == "none" && element.empty();
        CHECK((unused ? why.find("needs a controller") != std::string::npos : why.empty()));
      }
      for (const auto& law : kinds_in("friction")) {
        INFO(plant << ' ' << controller << ' ' << law);
        const auto why = complaint(limcycle::new_case({plant, controller, {}, law, {}}));
        const bool needs_force = law == "karnopp" || law == "quinn" || law == "awrejcewicz" || law == "wojewoda";
        CHECK(needs_force == (why.find("needs the applied force") != std::string::npos));
        CHECK(needs_force == !why.empty());
      }
    }
}

TEST_CASE("new: every key that stands as a comment is valid without the #") {
  const auto tried = [](const NewCase& wanted) {
    const std::string text = limcycle::new_case(wanted);
    int keys = 0;
    std::istringstream lines(text);
    std::size_t at = 0;
    for (std::string line; std::getline(lines, line); at += line.size() + 1) {
      const auto equals = line.find(" = ");
      if (!line.starts_with("# ") || equals == std::string::npos || line.find(' ', 2) != equals) continue;
      std::string active = text;
      active.erase(at, 2);
      INFO(line);
      CHECK(complaint(active) == "");
      ++keys;
    }
    return keys;
  };
  for (const auto& friction : kinds_in("friction")) CHECK(tried({.friction = friction, .all = true}) > 15);
  for (const auto& plant : kinds_in("plant"))
    if (has_velocity(plant)) CHECK(tried({.plant = plant, .all = true}) > 15);  // the other has no such key of its own
  for (const auto& controller : kinds_in("controller")) CHECK(tried({.controller = controller, .all = true}) > 15);
  for (const auto& element : kinds_in("element")) {
    CHECK(tried({.plant = "state-space", .element = element, .all = true}) > 15);
    CHECK(tried({.plant = "zpk", .element = element, .all = true}) > 15);
  }
}

TEST_CASE("new: a case tells every key of its parts with unit and meaning, in 80 columns") {
  for (const auto& entry : limcycle::catalogue()) {
    if (entry.group != "friction") continue;
    INFO(entry.kind);
    const std::string text = limcycle::new_case({.friction = entry.kind});
    for (const auto& parameter : entry.parameters) {
      CHECK((text.find("\n" + parameter.key + " = ") != std::string::npos ||
             text.find("\n# " + parameter.key + " = ") != std::string::npos));
      CHECK(text.find(parameter.meaning.substr(0, 12)) != std::string::npos);
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      INFO(line);
      CHECK((limcycle::display_width(line) <= 80 || line.find(" = [") != std::string::npos));
    }
  }
}

TEST_CASE("new: the program writes, refuses and suggests") {
  const Scratch scratch;
  const std::string file = scratch.file("servo.toml");
  const auto first = run({"new", "-o", file});
  CHECK(first.code == 0);
  CHECK(first.out.empty());
  CHECK(first.err.find("limcycle predict " + file) != std::string::npos);
  CHECK(scratch.get("servo.toml") == limcycle::new_case({}));
  CHECK(run({"new"}).out == limcycle::new_case({}));
  CHECK(run({"new", "--element", "relay"}).out ==
        limcycle::new_case({.plant = "transfer-function", .controller = "none", .friction = "", .element = "relay"}));

  const auto again = run({"new", "--plant", "belt", "-o", file});
  CHECK(again.code == 2);
  CHECK(again.err.find("exists already") != std::string::npos);
  CHECK(scratch.get("servo.toml") == limcycle::new_case({}));
  CHECK(run({"new", "--plant", "belt", "-o", file, "--force", "--quiet"}).err.empty());
  CHECK(scratch.get("servo.toml") == limcycle::new_case({.plant = "belt"}));

  CHECK(run({"new", "--friction", "lugree"}).err.find("did you mean lugre?") != std::string::npos);
  CHECK(run({"new", "--plant", "two_mass"}).err.find("did you mean two-mass?") != std::string::npos);
  const auto measured = run({"new", "--plant", "frf"});
  CHECK(measured.code == 2);
  CHECK(measured.err.find("cases/measured-axis.toml") != std::string::npos);
  for (const auto* flag : {"--plant", "--controller", "--friction", "--element", "--error"})
    CHECK(run({"new", flag, "nothing-like-it"}).code == 2);
  const auto apart = run({"new", "--element", "karnopp"});
  CHECK(apart.code == 2);
  CHECK(apart.err.find("do not fit together") != std::string::npos);
  CHECK(run({"new", "--friction", "none"}).code == 2);  // all parts would be linear
}

TEST_CASE("new: predict answers on new cases") {
  const Scratch scratch;
  const auto answers = [&](std::vector<std::string> kinds) {
    kinds.insert(kinds.begin(), "new");
    kinds.insert(kinds.end(), {"--quiet", "--force", "-o", scratch.file("case.toml")});
    CAPTURE(kinds);
    REQUIRE(run(kinds).code == 0);
    const auto ran = run({"predict", scratch.file("case.toml")});
    CHECK(ran.code == 0);
    CHECK(ran.out.find("This loop ") != std::string::npos);
  };
  std::vector<std::vector<std::string>> cases{{"--diagram"}, {"--sampled"}};
  for (const auto& plant : kinds_in("plant"))
    cases.push_back(has_velocity(plant) ? std::vector<std::string>{"--plant", plant, "--friction", "coulomb"}
                                        : std::vector<std::string>{"--plant", plant});
  for (const auto* controller : {"none", "transfer-function", "state-space", "cascade"})
    cases.push_back({"--controller", controller, "--friction", "stribeck"});
  for (const auto& element : kinds_in("element")) cases.push_back({"--element", element});
  cases.push_back({"--friction", "lugre"});
  for (const auto* error : {"dead-zone", "quantizer", "saturation"})
    cases.push_back({"--error", error, "--friction", "coulomb"});
  cases.push_back({"--plant", "belt", "--controller", "none", "--friction", "non-drift"});
  for (const auto& kinds : some_of(cases)) answers(kinds);
}

TEST_CASE("new: predict answers on a new case with every friction law") {
  const Scratch scratch;
  const std::string file = scratch.file("case.toml");
  for (const auto& friction : some_of(kinds_in("friction"))) {
    CAPTURE(friction);
    REQUIRE(run({"new", "--friction", friction, "--quiet", "--force", "-o", file}).code == 0);
    const auto ran = run({"predict", file});
    CHECK(ran.code == 0);
    CHECK(ran.out.find("This loop ") != std::string::npos);
  }
}

TEST_CASE("new: the describing function of elements that begin to slip is searched to its end, across its jumps") {
  const Scratch scratch;
  const std::string file = scratch.file("case.toml");
  REQUIRE(run({"new", "--friction", "gms", "--quiet", "-o", file}).code == 0);
  const auto ran =
      run({"predict", file, "--set", "predict.starts=1", "--set", "predict.methods=['describing-function']", "--set",
           "search.amplitude=[1e-5, 5e-5]", "--set", "search.frequency=[100.0, 300.0]"});
  CHECK(ran.code == 0);
  CHECK(ran.out.find("The describing function does not find this cycle.") != std::string::npos);
  CHECK(ran.out.find("solutions may be missing") == std::string::npos);
}
