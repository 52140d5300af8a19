#include <sys/wait.h>

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/golden.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/setting.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

namespace {

std::size_t widest_line(const std::string& text) {
  std::size_t width = 0;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    // UTF-8: bytes that continue a character take no column.
    const auto own = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    width = std::max(width, static_cast<std::size_t>(own));
  }
  return width;
}

}  // namespace

TEST_CASE("predict: golden documents") { check_goldens("predict"); }

TEST_CASE("predict: a diagram with friction between two bodies and under one of them") {
  const auto ran = run({"predict", shipped("cart-on-frame.toml"), "--json", "-"});
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  REQUIRE(document["cycles"].size() >= 1);
  // By SciPy's LSODA from event to event, the forces that hold both bodies from a system of two equations.
  CHECK(document["cycles"][0]["period"].get<double>() == Approx(9.580551).epsilon(1e-6));
  CHECK(document["cycles"][0]["amplitude"].get<double>() == Approx(0.00550067).epsilon(1e-5));
  CHECK(document["cycles"][0]["stable"] == true);
  // By differences of motions over one period. When the cart breaks away from the frame, the jump of that force breaks
  // the frame away from its feet at once: taken for a switch of its own, this gave a multiplier of 124.
  CHECK(document["cycles"][0]["multipliers"][0][0].get<double>() == Approx(0.302938).epsilon(1e-5));
  CHECK(document["cycles"][0]["multipliers"][1][0].get<double>() == Approx(0.0585181).epsilon(1e-5));
}

TEST_CASE("predict: y in the unit that the case wants, in texts and pages, documents in its own") {
  const Scratch scratch;
  std::ifstream file(shipped("pid-lugre.toml"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string plain = scratch.put("a.toml", text),
                    in_mm = scratch.put("b.toml", text + "\n[units]\ny = \"mm\"\n");
  const auto metres = run({"predict", plain, "--csv", scratch.file("a.csv")});
  const auto ran = run({"predict", in_mm, "--csv", scratch.file("b.csv"), "--html", scratch.file("b.html")});
  REQUIRE(ran.code == 0);
  CHECK(scratch.get("a.csv") == scratch.get("b.csv"));
  CHECK_THAT(squeezed(metres.out), Contains("amplitude 0.06390 m."));
  CHECK_THAT(squeezed(ran.out),
             Contains("amplitude 63.90 mm.") && Contains("from y(0) = 1000 mm") && !Contains("0.0639"));
  CHECK_THAT(scratch.get("b.html"), Contains("amplitude 63.90 mm"));
}

TEST_CASE("predict: small swings are shown in mm and um, and in documents in metres") {
  const Scratch scratch;
  const auto asked = [&](double Fs, const char* unit) {
    const std::string law = fmt::format("loop.friction={{kind=\"coulomb\",Fs={},Fc={}}}", Fs, Fs / 1.5);
    std::vector<std::string> words{"predict", shipped("pid-lugre.toml"), "--set", law,
                                   "--json",  scratch.file("r.json")};
    if (*unit != '\0') words.insert(words.end(), {"--set", fmt::format("units={{y=\"{}\"}}", unit)});
    return squeezed(run(words).out);
  };
  const auto metres = [&] { return Json::parse(scratch.get("r.json"))["cycles"][0]["amplitude"].get<double>(); };
  CHECK_THAT(asked(1.5, ""), Contains(fmt::format("amplitude {:#.4g} m.", metres())));
  const double large = metres();  // the amplitude is as large as the forces
  CHECK_THAT(asked(0.06, ""), Contains(fmt::format("amplitude {:#.4g} mm.", 1e3 * metres())) && Contains(" mm: "));
  CHECK(metres() == Approx(0.04 * large));
  CHECK_THAT(asked(6e-5, ""), Contains(fmt::format("amplitude {:#.4g} um.", 1e6 * metres())));
  CHECK_THAT(asked(0.06, "m"), Contains(fmt::format("amplitude {:#.4g} m.", metres())) && !Contains(" mm"));
  CHECK_THAT(asked(0.06, "um"), Contains(" um."));
}

TEST_CASE("predict: the default case is answered in words, in documents and as a page") {
  const Scratch scratch;
  const auto ran = run({"predict", shipped("pid-lugre.toml"), "--json", scratch.file("r.json"), "--csv",
                        scratch.file("r.csv"), "--html", scratch.file("r.html"), "--svg", scratch.file("r.svg")});
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(ran.out, Contains("This loop hunts: it settles into a limit cycle of period 24.44 s"));
  CHECK_THAT(ran.out, Contains("The describing function does not find this cycle."));
  CHECK_THAT(ran.out, Contains("24.4367865 "));
  CHECK_THAT(ran.out, Contains("report: " + scratch.file("r.html")));
  CHECK(widest_line(ran.out.substr(0, ran.out.find("report: "))) <= 80);

  const auto document = Json::parse(scratch.get("r.json"));
  REQUIRE(document["cycles"].size() == 1);
  CHECK(document["cycles"][0]["period"].get<double>() == Approx(24.436786455993).epsilon(1e-8));
  REQUIRE(document["predictions"].size() == 1);
  CHECK(document["predictions"][0]["method"] == "composite-describing-function");
  CHECK(document["predictions"][0]["verdict"] == "biased");
  CHECK(document["missed"] == Json::array({{{"method", "describing-function"}, {"cycle", 0}},
                                           {{"method", "harmonic-balance"}, {"cycle", 0}}}));
  CHECK_THAT(scratch.get("r.csv"), StartsWith("kind,index,method,amplitude") && Contains("\ncycle,0,shooting,0.06"));
  const auto page = scratch.get("r.html");
  CHECK_THAT(page, StartsWith("<!DOCTYPE html>"));
  for (const char* figure : {"nyquist", "time", "phase", "loop"})
    CHECK(page.find(std::string("data-figure=\"") + figure) != std::string::npos);
  CHECK(page.find("kind = &quot;lugre&quot;") != std::string::npos);  // the case file itself
  CHECK_THAT(scratch.get("r.svg"), StartsWith("<svg ") && Contains("class=\"stuck\""));
}

TEST_CASE("predict: -o tells a page and a picture by their ending") {
  const Scratch scratch;
  const std::string relay = shipped("relay-third-order.toml");
  const auto page = run({"predict", relay, "-o", scratch.file("a.html")});
  CHECK(page.code == 0);
  CHECK_THAT(page.out, Contains("Limit cycles") && Contains("report: " + scratch.file("a.html")));
  CHECK_THAT(scratch.get("a.html"), StartsWith("<!DOCTYPE html>"));
  CHECK(run({"predict", relay, "-o", scratch.file("a.svg")}).code == 0);
  CHECK_THAT(scratch.get("a.svg"), StartsWith("<svg "));
  const auto text = run({"predict", relay, "-o", scratch.file("a.txt")});
  CHECK(text.code == 0);
  CHECK(text.out.empty());
  CHECK_THAT(scratch.get("a.txt"), Contains("Limit cycles"));
}

TEST_CASE("predict: with - stdout carries one document and nothing else") {
  const std::string relay = shipped("relay-third-order.toml");
  const auto json = run({"predict", relay, "--json", "-"});
  CHECK(json.code == 0);
  CHECK(Json::parse(json.out)["command"] == "predict");
  const auto csv = run({"predict", relay, "--csv", "-"});
  CHECK(csv.code == 0);
  CHECK_THAT(csv.out, StartsWith("kind,"));
  CHECK(csv.out.find("Limit cycles") == std::string::npos);
}

TEST_CASE("predict: the same run gives the same bytes") {
  const std::string relay = shipped("relay-third-order.toml");
  CHECK(run({"predict", relay, "--json", "-"}).out == run({"predict", relay, "--json", "-"}).out);
}

TEST_CASE("predict: a required agreement") {
  CHECK(run({"predict", shipped("pid-lugre.toml"), "--require-agreement"}).code == 1);  // the cycle is missed
  CHECK(run({"predict", shipped("relay-third-order.toml"), "--require-agreement"}).code == 0);
}

TEST_CASE("predict: a page that cannot be written costs neither the table nor an older page") {
  const Scratch scratch;
  const std::string relay = shipped("relay-third-order.toml");
  const auto full = run({"predict", relay, "--html", "/dev/full"});
  CHECK(full.code == 3);
  CHECK_THAT(full.out, Contains("Limit cycles"));
  CHECK_THAT(full.err, Contains("cannot write to /dev/full"));

  const std::string old = scratch.put("old.html", "an older result");
  const std::string command = "trap '' XFSZ; ulimit -f 100; " + quoted(tested_program) + " predict " + quoted(relay) +
                              " --html " + quoted(old) + " > " + quoted(scratch.file("out")) + " 2> " +
                              quoted(scratch.file("err"));
  const int status = std::system(command.c_str());
  CHECK(WEXITSTATUS(status) == 3);
  CHECK(scratch.get("old.html") == "an older result");
  CHECK_THAT(scratch.get("out"), Contains("Limit cycles"));
  CHECK_THAT(scratch.get("err"), Contains("cannot write to " + old));
  const auto files = std::distance(std::filesystem::directory_iterator(std::filesystem::path(old).parent_path()), {});
  CHECK(files == 3);  // no draft remains
}

TEST_CASE("predict: a page that cannot be opened is refused before anything is computed") {
  const auto ran = run({"predict", shipped("pid-lugre.toml"), "--html", "/no/such/folder/page.html"});
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK_THAT(ran.err, Contains("--html /no/such/folder/page.html"));
}

TEST_CASE("predict: why the loop hunts, as remedy says it, and nothing where it does not hunt") {
  const auto ran = run({"predict", shipped("pid-lugre.toml"), "--json", "-"});
  REQUIRE(ran.code == 0);
  const Json cause = Json::parse(ran.out)["cause"];
  CHECK(cause["kind"] == "integral-action-and-stiction");
  const auto cure = run({"remedy", shipped("pid-lugre.toml"), "--only", "velocity-feedforward", "--json", "-"});
  CHECK(Json::parse(cure.out)["cause"]["why"] == cause["why"]);
  CHECK_THAT(squeezed(run({"predict", shipped("pid-lugre.toml")}).out),
             Contains("amplitude 0.06390 m. From 5 of 6 starts") &&
                 Contains(cause["why"].get<std::string>() + " limcycle remedy looks for changes that end it."));
  const auto still = run({"predict", shipped("pid-lugre-no-stiction.toml"), "--json", "-"});
  CHECK(Json::parse(still.out)["cause"].is_null());
  // Its cycle is far outside the box: the first sentence says that it does not hunt there, and needs no reason.
  const auto outside =
      run({"predict", shipped("pid-lugre.toml"), "--set", "search.amplitude=[10.0,100.0]", "--json", "-"});
  CHECK(Json::parse(outside.out)["cause"].is_null());
}
