#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/tests/cases/message.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using limcycle::test::message;
using limcycle::test::with;

namespace {

constexpr std::string_view cascade = R"([diagram]
output = "axis.y"
reference = 0.5
[[diagram.block]]
name = "position"
kind = "gain"
gain = 30.0
input = "r - axis.y"
[[diagram.block]]
name = "velocity"
kind = "pid"
kp = 2400.0
ki = 120000.0
saturation = 800.0
input = "position - axis.v"
[[diagram.block]]
name = "axis"
kind = "mass"
mass = 12.0
input = "velocity"
[[diagram.block]]
name = "guide"
kind = "coulomb"
on = "axis"
Fs = 60.0
Fc = 40.0
)";

/// The sections of a case file by their headings, without comments.
std::map<std::string, std::vector<std::string>> sections(const std::string& text) {
  std::map<std::string, std::vector<std::string>> all;
  std::string heading;
  for (const std::string& line : test::lines_of(text)) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[')
      heading = line.substr(1, line.find(']') - 1);
    else
      all[heading].push_back(line);
  }
  return all;
}

/// A case of five slots, written with blocks.
std::string as_diagram(const std::string& text) {
  auto all = sections(text);
  std::string out = "[diagram]\noutput = \"plant.y\"\n", signal;
  for (const auto& line : all["loop"])
    if (line.starts_with("reference")) out += line + "\n";
  const auto block = [&](const std::string& section, const std::string& name, const std::string& more) {
    out += "[[diagram.block]]\nname = \"" + name + "\"\n" + more + "\n";
    for (const auto& line : all[section]) out += line + "\n";
  };
  const bool controlled = all.contains("loop.controller"), element = all.contains("loop.element");
  const bool friction = all.contains("loop.friction");
  std::string later;
  const auto through = [&](const std::string& section, const std::string& name) {
    if (!all.contains(section)) return;
    std::string kept = std::exchange(out, {});
    block(section, name, "input = \"" + signal + "\"");
    later += std::exchange(out, std::move(kept));
    signal = name;
  };
  if (controlled || element || !friction) signal = "r - plant.y";
  through("loop.error", "error");
  through("loop.controller", "controller");
  through("loop.element", "element");
  if (signal.empty()) {
    later += "[[diagram.block]]\nname = \"nothing\"\nkind = \"constant\"\nvalue = 0.0\n";
    signal = "nothing";
  }
  block("loop.plant", "plant", "input = \"" + signal + "\"");
  out += later;
  if (friction) block("loop.friction", "friction", "on = \"plant\"");
  return out;
}

}  // namespace

TEST_CASE("diagram: blocks are read by name, and numbers have the paths of their blocks") {
  const Case from = read_case(cascade, "a.toml", {"diagram.axis.mass=14.0"});
  REQUIRE(from.loop);
  REQUIRE(from.loop->diagram);
  const Diagram& diagram = *from.loop->diagram;
  REQUIRE(diagram.blocks.size() == 4);
  CHECK(diagram.blocks[1].inputs.front().back().output == "v");
  CHECK(diagram.blocks[1].inputs.front().back().factor == -1.0);
  CHECK(std::get<Mass>(std::get<Plant>(diagram.blocks[2].what)).mass == 14.0);
  CHECK(diagram.blocks[3].contact == Contact::opposes);
  CHECK(from.loop->reference == 0.5);
  CHECK(from.element_path == "diagram.guide");
  CHECK(df_element(from).kind() == "coulomb");
  CHECK(number_at(from, "--x", "diagram.velocity.ki").value == 120000.0);
  CHECK_THROWS_AS(number_at(from, "--x", "diagram.velocity.friction_compensation"), InputError);
  CHECK_THROWS_AS(LoopVariation(from, "--x", "diagram.velocity.friction_compensation"), InputError);
  const LoopVariation vary(from, "--x", "diagram.guide.Fs");
  const auto loop = vary(70.0);
  REQUIRE(loop);
  CHECK(loop->elements.back().number("Fs") == 70.0);
  CHECK(loop->elements.back().number("Fs_minus") == 70.0);  // not written: it follows
  CHECK_FALSE(vary(30.0));                                  // below Fc
}

TEST_CASE("diagram: every shipped loop, written with blocks, is the same loop") {
  int compared = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(LIMCYCLE_SOURCE_DIR) + "/cases")) {
    if (file.path().extension() != ".toml") continue;
    const Case slots = load_case(file.path().string());
    if (!slots.loop || slots.loop->diagram || slots.loop->load != 0.0) continue;
    if (actuator_of(slots.loop->controller).friction_compensation > 0.0) continue;  // a block of its own
    if (sampling_of(slots.loop->controller).is_on()) continue;                      // refused in a diagram
    INFO(file.path().filename());
    const std::string text = as_diagram(slots.text);
    INFO(text);
    const Case blocks = read_case(text, file.path().string());  // data of a plant stand beside it
    const Loop a = build_loop(*slots.loop), b = build_loop(*blocks.loop);
    REQUIRE(a.elements.size() == b.elements.size());
    for (const double w : {0.1, 3.0, 40.0}) {
      const Eigen::MatrixXcd Ha = a.element_response(w), Hb = b.element_response(w);
      CHECK((Ha - Hb).norm() <= 1e-12 * Ha.norm());
      CHECK((a.output_response(w) - b.output_response(w)).norm() <= 1e-12 * a.output_response(w).norm());
    }
    CHECK(a.delay == b.delay);
    CHECK(a.external_origin(reference_value) == b.external_origin(reference_value));
    for (std::size_t i = 0; i < a.elements.size(); ++i) CHECK(a.elements[i].kind() == b.elements[i].kind());
    ++compared;
  }
  CHECK(compared >= 15);
}

TEST_CASE("diagram: a mistake is refused with line, block and what to write") {
  CHECK(message(with(cascade, "r - axis.y", "r - axs.y")) ==
        "a.toml:8: diagram.position.input = \"r - axs.y\": there is no block \"axs\"; did you mean axis?");
  CHECK_THAT(message(with(cascade, "r - axis.y", "r axis.y")),
             StartsWith("a.toml:8: diagram.position.input") && Contains("a sign between two signals is missing"));
  CHECK_THAT(message(with(cascade, "r - axis.y", "2 - axis.y")), Contains("a factor is followed by *"));
  CHECK_THAT(message(with(cascade, "position - axis.v", "position - axis.w")),
             Contains("diagram.axis") && Contains("has no output \"w\"; it has y, v"));
  CHECK_THAT(message(with(cascade, "input = \"velocity\"\n", "")),
             StartsWith("a.toml:16: diagram.axis.input: is required"));
  CHECK_THAT(message(with(cascade, "name = \"velocity\"", "name = \"position\"")),
             StartsWith("a.toml:10: diagram.block.name = \"position\": is taken by the block of line 4"));
  CHECK_THAT(message(with(cascade, "name = \"velocity\"", "name = \"r\"")), Contains("is a word of the case format"));
  CHECK_THAT(message(with(cascade, "on = \"axis\"\n", "input = \"axis.v\"\n")), Contains("nothing reads the output"));
  CHECK_THAT(message(with(cascade, "on = \"axis\"\n", "")), Contains("diagram.guide.on: is required: the body"));
  CHECK_THAT(message(with(cascade, "on = \"axis\"", "on = \"position\"")),
             Contains("diagram.guide") && Contains("acts on position, which is no plant"));
  CHECK_THAT(message(with(cascade, "kind = \"gain\"", "kind = \"gian\"")), Contains("did you mean \"gain\"?"));
  CHECK_THAT(message(with(cascade, "mass = 12.0", "mas = 12.0")), Contains("did you mean mass?"));
  CHECK_THAT(message("[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n" + std::string(cascade)),
             Contains("cannot stand beside [loop]"));
  CHECK_THAT(message(with(cascade, "output = \"axis.y\"", "output = \"velocity\"")), Contains("made of states"));
  const std::string loose = std::string(cascade) +
                            "[[diagram.block]]\nname = \"extra\"\nkind = \"gain\"\ngain = 1.0\n" +
                            "input = \"axis.y\"\n";
  CHECK_THAT(message(loose), Contains("diagram.extra") && Contains("nothing reads the output"));
  const std::string of_itself = std::string(cascade) +
                                "[[diagram.block]]\nname = \"extra\"\nkind = \"low-pass\"\ntime_constant = 1.0\n" +
                                "input = \"axis.y - extra\"\n";
  CHECK_THAT(message(of_itself), Contains("diagram.extra") && Contains("nothing reads the output"));
  CHECK_THAT(message(with(cascade, "input = \"position - axis.v\"", "input = \"position - velocity\"")),
             Contains("diagram.velocity") && Contains("algebraic loop"));
}
