#include "limcycle/reports/case_files/case_format.hpp"

namespace limcycle {
namespace {

CaseSection before_any() {
  return {"", "Before any section.", {{"title", "\"My servo\"", "heading of the reports", "name of the file"}}};
}

CaseSection loop() {
  return {"loop",
          "The set-point and a load; its parts are in [loop.plant], [loop.controller], [loop.friction], [loop.element] "
          "and [loop.error].",
          {{"reference", "0.0", "set-point r, in the unit of y; or {kind = \"ramp\", rate = 0.01}: r = rate t", "0"},
           {"load", "0.0", "force added to u, N (servo-drive: A)", "0"}}};
}

CaseSection diagram() {
  return {
      "diagram",
      "In place of [loop]: blocks joined by the names of their signals. Each begins with [[diagram.block]], its "
      "name and kind, and its input, a sum such as \"r - axis.y\"; a friction law has on = \"axis\", or between two "
      "plants, in place of an input. `limcycle laws` lists the kinds.",
      {{"output", "\"axis.y\"", "the signal that is y", "", true},
       {"reference", "0.0", "set-point, the signal r; or {kind = \"ramp\", rate = 0.01}", "0"}}};
}

CaseSection units() {
  return {
      "units",
      "The unit in which texts, pages and pictures show y. Without it a y in metres is shown in mm or um where its "
      "swings are small. Documents stay in the units of the case.",
      {{"y", "\"mm\"", "mm, um, nm, cm, deg, the name of another, or { symbol = \"mm\", per_si = 1000.0 }", "", true}}};
}

CaseSection search() {
  return {
      "search",
      "Where roots of the harmonic balance are searched. Without it the box is chosen from the loop's own scales; "
      "`limcycle check` prints it.",
      {{"amplitude", "[1e-6, 1.0]", "from and to, of the element's input (with friction: of what rubs), m", "", true},
       {"frequency", "[0.01, 1000.0]", "from and to, rad/s", "", true}}};
}

CaseSection predict() {
  return {"predict",
          "How cycles are predicted and found.",
          {{"methods", R"(["describing-function", "composite-describing-function", "harmonic-balance"])",
            "which predict", "all three"},
           {"starts", "4", "simulations from different displacements", "4"},
           {"accuracy", "1e-8", "relative, of period and amplitude of a cycle", "1e-8"}}};
}

CaseSection simulate() {
  return {
      "simulate",
      "The run of `limcycle simulate`. A signal is a number or one of {kind = \"step\", value, start}, {kind = "
      "\"ramp\", rate, start}, {kind = \"sine\", amplitude, frequency, start}, {kind = \"zigzag\", amplitude, rate, "
      "start}, {kind = \"table\", times, values}.",
      {{"duration", "60.0", "how long, s", "", true},
       {"initial", "{}", "state to begin from, such as { y = 0.1 }; `limcycle check` lists the names", "all 0"},
       {"force", "0.0", "a signal added to the load, N", "0"},
       {"reference", "0.0", "a signal in place of loop.reference", "that one"},
       {"stepper", "\"auto\"", "auto, exact, rodas5p, dopri5, fehlberg78 or cash-karp54", "auto"},
       {"rtol", "1e-7", "relative tolerance of a step", "1e-7"},
       {"sample", "0.06", "from one sample to the next, s", "duration/1000"}}};
}

CaseSection df() {
  return {"df",
          R"(The table of `limcycle df`. An axis is a list, or {from, to, points, spacing = "log" or "linear"}.)",
          {{"amplitude", "{ from = 1e-6, to = 1.0, points = 13 }", "axis, of the element's input, m", "", true},
           {"frequency", "[1.0]", "axis, rad/s", "", true},
           {"bias", "[0.0]", "axis; of friction a mean velocity, m/s, else of the input", "[0]"},
           {"harmonics", "7", "number of harmonics in the output", "7"},
           {"accuracy", "1e-6", "wanted relative error", "1e-6"},
           {"method", "\"auto\"", "auto, fft or quadrature", "auto"}}};
}

CaseSection dissipativity() {
  return {"dissipativity",
          "Speeds that the questions of energy are about.",
          {{"speed", "1.0", "up to which the force is bounded, m/s", "1"},
           {"top_speed", "10.0", "largest of the motions that may take energy out, m/s", "none"}}};
}

CaseSection sensitivity() {
  return {
      "sensitivity",
      "How the numbers are spread. A parameter is {path, factor}, {path, from, to}, or {path, mean, deviation}, with "
      "distribution = \"uniform\", \"log-uniform\" or \"normal\".",
      {{"parameters", "[]", "list of them, such as { path = \"loop.friction.Fs\", factor = 1.2 }", "", true},
       {"correlation", "[]", R"(pairs of them, { between = ["loop.friction.Fs", "loop.friction.Fc"], value = 0.8 })",
        "none"},
       {"samples", "256", "base samples of the Sobol study", "256"},
       {"seed", "0", "of the samples", "0"}}};
}

CaseSection claim() {
  return {"claim",
          "A claim of your own, tested by `limcycle claims CASE`: QUANTITY COMPARISON FORMULA. It is written [[claim]] "
          "and may stand more than once.",
          {{"id", "\"period\"", "a name without spaces", "", true},
           {"quantity", "\"period\"", "period, amplitude, ...: a wrong one is answered with the list", "", true},
           {"formula", "\"2*pi\"", "with what it is compared: a formula of the case's numbers", "", true},
           {"comparison", "\"=\"", "=, <, <=, > or >=", "="},
           {"tolerance", "0.01", "relative, of an equality", "1e-6"},
           {"statement", "\"\"", "the claim in words", "none"},
           {"source", "\"\"", "where it is from", "the case"},
           {"expected", "\"holds\"", "holds or fails", "holds"},
           {"at", "{ amplitude = 1e-3, frequency = 1.0 }", "where a describing function is asked", "none"},
           {"over", "[]", "numbers drawn at random, as in [sensitivity]", "none"},
           {"random", "10", "how many draws", "10"}}};
}

}  // namespace

const std::vector<CaseSection>& case_sections() {
  static const std::vector<CaseSection> all{before_any(), loop(), diagram(),       units(),       search(), predict(),
                                            simulate(),   df(),   dissipativity(), sensitivity(), claim()};
  return all;
}

}  // namespace limcycle
