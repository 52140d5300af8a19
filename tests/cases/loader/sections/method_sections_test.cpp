#include <catch2/catch.hpp>

#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using limcycle::test::lone_law;
using limcycle::test::message;
using limcycle::test::servo;
using limcycle::test::with;

namespace {

Case with_df(const std::string& body) { return read_case(lone_law + "[df]\n" + body, "a.toml"); }
std::string df_message(const std::string& body) { return message(lone_law + "[df]\n" + body); }
std::string simulate_message(const std::string& body) { return message(std::string(servo) + "[simulate]\n" + body); }

}  // namespace

TEST_CASE("section df: amplitude slowest, then frequency, then bias") {
  const Case from = with_df("amplitude = [1, 2]\nfrequency = [10, 20, 30]\nbias = [-1, 1]\n");
  const auto points = need_df(from).points();
  REQUIRE(points.size() == 12);
  CHECK(points[0].amplitude == 1.0);
  CHECK(points[0].frequency == 10.0);
  CHECK(points[0].bias == -1.0);
  CHECK(points[1].bias == 1.0);
  CHECK(points[1].frequency == 10.0);
  CHECK(points[2].frequency == 20.0);
  CHECK(points[6].amplitude == 2.0);
  CHECK(points[11].frequency == 30.0);
}

TEST_CASE("section df: spreads are logarithmic unless told, for bias linear, and end exactly") {
  const Case from = with_df(
      "amplitude = {from = 1e-6, to = 0.1, points = 6}\n"
      "frequency = {from = 1, to = 3, points = 3, spacing = \"linear\"}\n"
      "bias = {from = -1, to = 1, points = 5}\n");
  const auto& df = need_df(from);
  REQUIRE(df.amplitude.size() == 6);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(df.amplitude[i] == Approx(std::pow(10.0, -6.0 + static_cast<double>(i))).epsilon(1e-14));
  CHECK(df.amplitude.front() == 1e-6);
  CHECK(df.amplitude.back() == 0.1);
  CHECK(df.frequency == std::vector<double>{1, 2, 3});
  CHECK(df.bias == std::vector<double>{-1, -0.5, 0, 0.5, 1});
}

TEST_CASE("section df: options and their defaults") {
  const Case plain = with_df("amplitude = 0.5\nfrequency = [1]\n");
  CHECK(need_df(plain).amplitude == std::vector<double>{0.5});
  CHECK(need_df(plain).bias == std::vector<double>{0.0});
  CHECK(need_df(plain).options.harmonics == 7);
  CHECK(need_df(plain).options.accuracy == 1e-6);
  CHECK(need_df(plain).options.method == DfMethod::automatic);
  const Case set = with_df("amplitude = [1]\nfrequency = [1]\nharmonics = 3\naccuracy = 1e-9\nmethod = \"fft\"\n");
  CHECK(need_df(set).options.harmonics == 3);
  CHECK(need_df(set).options.accuracy == 1e-9);
  CHECK(need_df(set).options.method == DfMethod::fft);
}

TEST_CASE("section df: what is refused") {
  CHECK(df_message("frequency = [1]\n") == "a.toml:4: df.amplitude: is required: list or {from, to, points, spacing}");
  CHECK(df_message("amplitude = []\nfrequency = [1]\n") == "a.toml:5: df.amplitude = []: must not be empty");
  CHECK(df_message("amplitude = [1, -1]\nfrequency = [1]\n") == "a.toml:5: df.amplitude[1] = -1: must be > 0");
  CHECK(df_message("amplitude = [1]\nfrequency = [0]\n") == "a.toml:6: df.frequency[0] = 0: must be > 0 rad/s");
  CHECK(df_message("amplitude = [1]\nfrequency = [1]\nbias = [inf]\n") ==
        "a.toml:7: df.bias[0] = inf: must be a finite number");
  CHECK(df_message("amplitude = {from = 2, to = 1, points = 3}\nfrequency = [1]\n") ==
        "a.toml:5: df.amplitude.to = 1: must be greater than from = 2");
  CHECK(df_message("amplitude = {from = 1, to = 2, points = 0}\nfrequency = [1]\n") ==
        "a.toml:5: df.amplitude.points = 0: must be in 1 .. 1000000");
  CHECK(df_message("amplitude = {from = 1, to = 2, points = 2.5}\nfrequency = [1]\n") ==
        "a.toml:5: df.amplitude.points = 2.5: must be an integer, found a number");
  CHECK(df_message("amplitude = {from = 1, to = 2, points = 3, spacing = \"lin\"}\nfrequency = [1]\n")
            .starts_with("a.toml:5: df.amplitude.spacing = \"lin\": must be one of \"log\", \"linear\""));
  CHECK(df_message("amplitude = [1]\nfrequency = [1]\nbias = {from = -1, to = 1, points = 3, spacing = \"log\"}\n") ==
        "a.toml:7: df.bias.from = -1: must be > 0 with spacing = \"log\"");
  CHECK(df_message("amplitude = [1]\nfrequency = [1]\nharmonics = 0\n") ==
        "a.toml:7: df.harmonics = 0: must be in 1 .. 1000");
  CHECK(df_message("amplitude = [1]\nfrequency = [1]\naccuracy = 0\n") ==
        "a.toml:7: df.accuracy = 0: must be >= 1e-13 and <= 0.1");
  CHECK(df_message("amplitude = [1]\nfrequency = [1]\nmethod = \"fftt\"\n") ==
        "a.toml:7: df.method = \"fftt\": must be one of \"auto\", \"fft\", \"quadrature\"; did you mean \"fft\"?");
  CHECK(df_message(
            "amplitude = {from = 1, to = 2, points = 1000000}\nfrequency = {from = 1, to = 2, points = 1000000}\n") ==
        "a.toml:4: df: must have at most 5000000 points, found 1000000 x 1000000 x 1");
}

TEST_CASE("section search: empty, reversed, negative, not a pair") {
  const auto amplitude = [](const std::string& value) { return message(with(servo, "[1e-6, 1.0]", value)); };
  const std::string rule = "must be two numbers [from, to] with 0 < from < to";
  CHECK(amplitude("[1.0, 1e-6]") == "a.toml:18: search.amplitude = [1, 1e-06]: " + rule);
  CHECK(amplitude("[1.0, 1.0]") == "a.toml:18: search.amplitude = [1, 1]: " + rule);
  CHECK(amplitude("[]") == "a.toml:18: search.amplitude = []: " + rule);
  CHECK(amplitude("[1]") == "a.toml:18: search.amplitude = [1]: " + rule);
  CHECK(amplitude("[0.0, 1.0]") == "a.toml:18: search.amplitude = [0, 1]: " + rule);
  CHECK(amplitude("[nan, 1.0]") == "a.toml:18: search.amplitude[0] = nan: must be a finite number");
  CHECK(amplitude("1.0") ==
        "a.toml:18: search.amplitude = 1: must be a list of two numbers [from, to], found a number");
  CHECK(message(with(servo, "[0.01, 1000.0]", "[10.0, 1.0]")) ==
        "a.toml:19: search.frequency = [10, 1]: " + rule + ", rad/s");
  CHECK(message(with(servo, "frequency", "frequencies")) ==
        "a.toml:19: search.frequencies: unknown key; did you mean frequency?");
  CHECK(message(with(servo, "frequency = [0.01, 1000.0]\n", "")) ==
        "a.toml:17: search.frequency: is required: range [from, to], rad/s");
}

TEST_CASE("section predict") {
  const Case from = read_case(
      std::string(servo) + "[predict]\nmethods = [\"describing-function\"]\nstarts = 7\naccuracy = 1e-6\n", "a.toml");
  CHECK(from.predict.methods.describing_function);
  CHECK_FALSE(from.predict.methods.composite);
  CHECK_FALSE(from.predict.methods.harmonic_balance);
  CHECK(from.predict.starts == 7);
  CHECK(from.predict.accuracy == 1e-6);
  const Case plain = read_case(servo, "a.toml");
  CHECK(plain.predict.methods.describing_function);
  CHECK(plain.predict.methods.composite);
  CHECK(plain.predict.methods.harmonic_balance);
  CHECK(plain.predict.starts == PredictOptions{}.starts);
  CHECK(plain.predict.accuracy == 1e-8);
  const auto predict = [](const std::string& body) { return message(std::string(servo) + "[predict]\n" + body); };
  CHECK(predict("starts = 0\n") == "a.toml:21: predict.starts = 0: must be in 1 .. 1000");
  CHECK(predict("starts = 9223372036854775807\n") ==
        "a.toml:21: predict.starts = 9223372036854775807: must be in 1 .. 1000");
  CHECK(predict("methods = \"x\"\n") == "a.toml:21: predict.methods = \"x\": must be a list of names, found a string");
  CHECK(predict("methods = [\"harmonic-balanc\"]\n").find("harmonic-balance") != std::string::npos);
}

TEST_CASE("section simulate: options, states by name, signals") {
  const Case from = read_case(std::string(servo) +
                                  "[simulate]\nduration = 5\ninitial = {y = 1.0, z = 1e-6}\n"
                                  "force = {kind = \"sine\", amplitude = 2, frequency = 3, start = 1}\n"
                                  "reference = {kind = \"table\", times = [0, 1, 2], values = [0, 1, 0]}\n"
                                  "stepper = \"rodas5p\"\nrtol = 1e-9\nsample = 0.5\n",
                              "a.toml");
  const auto& options = need_simulate(from);
  CHECK(options.duration == 5.0);
  CHECK(options.initial == std::map<std::string, double>{{"y", 1.0}, {"z", 1e-6}});
  REQUIRE(options.force);
  CHECK(options.force->kind == Signal::Kind::sine);
  CHECK(options.force->value == 2.0);
  CHECK(options.force->frequency == 3.0);
  CHECK(options.force->start == 1.0);
  REQUIRE(options.reference);
  CHECK(options.reference->times == std::vector<double>{0, 1, 2});
  CHECK(options.stepper == "rodas5p");
  CHECK(options.rtol == 1e-9);
  CHECK(options.sample == 0.5);
  CHECK(read_case(std::string(servo) + "[simulate]\nduration = 5\nforce = 2\n", "a.toml").simulate->force->value ==
        2.0);
}

TEST_CASE("section simulate: what is refused") {
  CHECK(simulate_message("sample = 1\n") == "a.toml:20: simulate.duration: is required: how long, s");
  CHECK(simulate_message("duration = 0\n") == "a.toml:21: simulate.duration = 0: must be > 0 s");
  CHECK(simulate_message("duration = 1\ninitial = {w = 1}\n") ==
        "a.toml:22: simulate.initial.w: unknown key; known: y, v, I, z");
  CHECK(simulate_message("duration = 1\nstepper = \"rodas5\"\n").find("did you mean \"rodas5p\"?") !=
        std::string::npos);
  CHECK(simulate_message("duration = 1e9\nsample = 1\n") ==
        "a.toml:22: simulate.sample = 1: makes more than 5000000 rows of duration = 1000000000 s");
  CHECK(simulate_message("duration = 1\nforce = {kind = \"zigzag\", amplitude = 1}\n") ==
        "a.toml:22: simulate.force.rate: is required: slope of the flanks, 1/s");
  CHECK(simulate_message("duration = 1\nforce = {kind = \"step\", value = 1, rate = 2}\n") ==
        "a.toml:22: simulate.force.rate: unknown key; known: kind, value, start");
  CHECK(simulate_message("duration = 1\nforce = {kind = \"table\", times = [0, 0], values = [1, 2]}\n") ==
        "a.toml:22: simulate.force.times = [0, 0]: must increase, but entry 1 is not above the one before");
  CHECK(simulate_message("duration = 1\nforce = {kind = \"table\", times = [0, 1], values = [1]}\n") ==
        "a.toml:22: simulate.force.values = [1]: must have as many entries as times (2), found 1");
  CHECK(message(lone_law + "[simulate]\nduration = 1\n") == "a.toml:4: simulate: needs a loop: add [loop.plant]");
}

TEST_CASE("sections of other commands are read too") {
  CHECK(message(lone_law + "[sensitivity]\nsample = 1\n") ==
        "a.toml:5: sensitivity.sample: unknown key; did you mean samples?");
  CHECK(message(lone_law +
                "[sensitivity]\nparameters = [{path = \"loop.friction.Fs\", factor = 2}]\n[dissipativity]\n") == "");
  CHECK(message("sensitivity = 1\n" + lone_law) == "a.toml:1: sensitivity = 1: must be a table, found a number");
  CHECK(message("claim = [1]\n" + lone_law) == "a.toml:1: claim[0] = 1: must be a table, found a number");
  CHECK(message(lone_law + "[serch]\n") == "a.toml:4: serch: unknown key; did you mean search?");
}

TEST_CASE("section units: a symbol that is known scales, another one names, a table says both") {
  const auto unit = [](const std::string& written) {
    return read_case(std::string(servo) + "[units]\ny = " + written + "\n", "a.toml").y_unit.value();
  };
  CHECK(unit("\"mm\"").per_si == 1000.0);
  CHECK(unit("\"deg\"").per_si == Approx(57.29577951308232));
  CHECK(unit("\"%\"").per_si == 1.0);
  CHECK(unit("{symbol = \"in\", per_si = 39.37}").symbol == "in");
  CHECK(unit("{symbol = \"in\", per_si = 39.37}").per_si == 39.37);
  const auto refused = [](const std::string& body) { return message(std::string(servo) + "[units]\n" + body + "\n"); };
  CHECK(refused("y = \"\"").find("must be 1 to 12 letters or signs") != std::string::npos);
  CHECK(refused("y = {symbol = \"mm\"}").find("units.y.per_si: is required") != std::string::npos);
  CHECK(refused("y = {symbol = \"mm\", per_si = 0.0}").find("must be > 0") != std::string::npos);
  CHECK(refused("x = \"mm\"").find("unknown key") != std::string::npos);
}
