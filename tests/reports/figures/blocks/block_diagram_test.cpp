#include "limcycle/reports/figures/blocks/block_diagram.hpp"

#include <catch2/catch.hpp>
#include <regex>

#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/reports/figures/blocks/block_words.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/tests/reports/markup.hpp"

using namespace limcycle;

namespace {

const Units no_units{"", "", ""};

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

LoopParts servo() {
  LoopParts parts;
  parts.plant = Mass{.mass = 2.0};
  Pid pid;
  pid.kp = 3.0;
  pid.kd = 6.0;
  parts.controller = pid;
  LuGre<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 0.001;
  law.sigma0 = 1e5;
  law.sigma1 = 316.22776601683796;
  parts.friction = law;
  return parts;
}

/// A loop with all possible parts, and polynomials that do not fit on a line.
LoopParts everything() {
  LoopParts parts = servo();
  TransferFunctionController controller;
  controller.numerator = {1.0, 2.5, 3.141592653589793, 17.0, 12345.678, 1.0};
  controller.denominator = {0.001234, 1.0, 2.0, 3.0, 4e5, 1.0, 0.0};
  controller.friction_compensation = 0.9;
  controller.saturation = 10.0;
  controller.lag = 0.01;
  parts.controller = controller;
  Relay<double> relay;
  relay.level = 2.0;
  parts.element = relay;
  Quantizer<double> quantizer;
  quantizer.step = 0.25;
  parts.error = quantizer;
  parts.reference_rate = 0.001;
  parts.load = -0.5;
  return parts;
}

/// Boxes of the blocks, as x, y, width, height.
std::vector<std::array<double, 4>> boxes(const std::string& svg) {
  const std::regex box(
      "<rect class=\"diagram-box\" x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
  std::vector<std::array<double, 4>> out;
  for (std::sregex_iterator at(svg.begin(), svg.end(), box), end; at != end; ++at)
    out.push_back({std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3]), std::stod((*at)[4])});
  return out;
}

bool overlap(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  return a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3];
}

void check_drawing(const LoopParts& parts, std::size_t blocks) {
  const std::string svg = block_diagram(parts, {});
  CHECK(test::markup_fault(svg) == "");
  CHECK_FALSE(holds(svg, "nan"));
  CHECK(holds(svg, "role=\"img\" aria-label=\"Block diagram. "));
  const auto placed = boxes(svg);
  REQUIRE(placed.size() == blocks);
  std::smatch size;
  REQUIRE(std::regex_search(svg, size, std::regex("viewBox=\"0 0 ([0-9]+) ([0-9]+)\"")));
  for (std::size_t i = 0; i < placed.size(); ++i) {
    CHECK(placed[i][0] > 0.0);
    CHECK(placed[i][1] > 0.0);
    CHECK(placed[i][0] + placed[i][2] < std::stod(size[1]));
    CHECK(placed[i][1] + placed[i][3] < std::stod(size[2]));
    for (std::size_t k = 0; k < i; ++k) CHECK_FALSE(overlap(placed[i], placed[k]));
  }
}

}  // namespace

TEST_CASE("block diagram: numbers are short but true") {
  CHECK(diagram_number(0.1) == "0.1");
  CHECK(diagram_number(1e-6) == "1e−6");
  CHECK(diagram_number(-2.5e12) == "−2.5e12");
  CHECK(diagram_number(316.22776601683796) == "316.228");
  CHECK(polynomial_in_s({1.0, 0.0, -3.0, 1.0}) == "s³ − 3 s + 1");
  CHECK(polynomial_in_s({-1.0, 0.5}) == "−s + 0.5");
  CHECK(polynomial_in_s({0.0, 0.0}) == "0");
  CHECK(polynomial_in_s(std::vector<double>(11, 1.0)).starts_with("s¹⁰ + s⁹ + "));
}

TEST_CASE("block diagram: a long sum is broken between its terms, and what is left out is told") {
  const std::string sum = "100 s³ + 200 s² − 300 s + 400";
  CHECK(broken_sum(sum, 80, 3) == std::vector<std::string>{sum});
  CHECK(broken_sum(sum, 16, 3) == std::vector<std::string>{"100 s³ + 200 s²", "− 300 s + 400"});
  CHECK(broken_sum(sum, 8, 2) == std::vector<std::string>{"100 s³", "+ 200 s² …"});
}

TEST_CASE("block diagram: a servo shows each of its numbers with its unit") {
  const std::string svg = block_diagram(servo(), {});
  for (const char* words :
       {">controller: pid<", ">kp = 3 N/m<", ">kd = 6 N s/m<", ">plant: mass<", ">mass = 2 kg<", ">friction: lugre<",
        ">Fs = 1.5 N<", ">sigma1 = 316.228 N s/m<", ">r = 0 m<", ">v = dy/dt<"})
    CHECK(holds(svg, words));
  CHECK(holds(svg,
              "<title>lugre (Fc = 1 N, Fs = 1.5 N, vs = 0.001 m/s, sigma0 = 1e+05 N/m, sigma1 = "
              "316.22776601683796 N s/m). "));
  CHECK_FALSE(holds(svg, "ki = "));  // not written, with the default 0
  CHECK_FALSE(holds(svg, "saturation"));
  check_drawing(servo(), 3);
}

TEST_CASE("block diagram: everything a loop can have is drawn once, and nothing on top of another") {
  check_drawing(everything(), 8);
  const std::string svg = block_diagram(everything(), {});
  for (const char* words : {">on the error: quantizer<", ">controller: transfer-function<", ">friction compensation<",
                            ">0.9 N sgn(v)<", ">saturation<", ">±10 N<", ">lag<", ">0.01 s + 1<", ">element: relay<",
                            ">load = −0.5 N<", ">r = t × 0.001 m/s<"})
    CHECK(count(svg, words) == 1);
  // A list that is cut is complete in the title and in the label.
  CHECK(count(svg, "3.141592653589793") == 2);
}

TEST_CASE("block diagram: every kind of plant, with and without a controller") {
  std::vector<Plant> plants{
      Mass{.mass = 1.0},
      TwoMass{.motor_mass = 1.0, .load_mass = 2.0, .stiffness = 10.0, .friction_on = {1}},
      Belt{.mass = 1.0, .stiffness = 2.0, .speed = 0.1},
      FroudePendulum{.mass = 5.0, .arm = 0.2, .inertia = 0.25, .shaft_radius = 0.02, .shaft_speed = 4.0},
      TransferFunction{.numerator = {1.0}, .denominator = {1.0, 2.0, 0.0}, .delay = 0.3},
      ZeroPoleGain{.zeros = {}, .poles = {-1.0, {-2.0, 1.0}, {-2.0, -1.0}}, .gain = 2.0},
      StateSpacePlant{
          .A = Eigen::MatrixXd::Zero(2, 2), .B = Eigen::MatrixXd::Ones(2, 1), .C = Eigen::MatrixXd::Ones(1, 2)}};
  for (const auto& plant : plants) {
    LoopParts parts = servo();
    parts.plant = plant;
    check_drawing(parts, 3);
    parts.controller = NoController{};
    check_drawing(parts, 2);
    CHECK(loop_in_words(parts, {}).starts_with("No controller acts on the plant "));
    parts.load = 1.0;
    check_drawing(parts, 2);
  }
  LoopParts parts = servo();
  parts.plant = plants[1];
  CHECK(holds(block_diagram(parts, {}), ">v of the load<"));
  parts.plant = plants[2];
  CHECK(holds(block_diagram(parts, {}), ">v = dy/dt − 0.1<"));
  parts.plant = plants[5];
  CHECK(holds(block_diagram(parts, {}), ">poles = [−1, −2 + j 1, −2 − j 1] 1/s<"));
}

TEST_CASE("block diagram: a loop without units shows times only") {
  LoopParts parts;
  parts.plant = TransferFunction{.numerator = {1.0}, .denominator = {1.0, 1.0}, .delay = 0.5};
  Relay<double> relay;
  relay.level = 1.0;
  parts.element = relay;
  const std::string svg = block_diagram(parts, no_units);
  CHECK(holds(svg, ">level = 1<"));
  CHECK(holds(svg, ">delay = 0.5 s<"));
  CHECK(holds(svg, ">r = 0<"));
  CHECK(loop_in_words(parts, no_units) ==
        "The error, r = 0 less the measured y, goes through the element relay (level = 1) to the plant "
        "transfer-function (numerator = [1], denominator = [1, 1], delay = 0.5 s).");
}

TEST_CASE("block diagram: the loop in sentences has every number in full") {
  const std::string words = loop_in_words(everything(), {});
  for (const char* part :
       {"through quantizer (step = 0.25) on the error, the controller transfer-function (", "4e+05, 1, 0])",
        "friction compensation 0.9 N sgn(v), added, saturation ±10 N, a lag of 0.01 s, the element relay (level = 2)",
        "to the plant mass (mass = 2 kg). A constant load = −0.5 N acts on the plant. Friction, lugre (",
        "opposes the rubbing velocity v = dy/dt."})
    CHECK(holds(words, part));
}
