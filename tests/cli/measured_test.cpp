/// Plants that are known by data: the shipped axis against the two masses that its data were computed from, and roots
/// with the uncertainty of their data against the closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/cli/program.hpp"

using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;
using limcycle::test::squeezed;
using Json = nlohmann::ordered_json;

namespace {

const std::string basis = "loop.plant is measured (200 points from 0.6283 to 1885 rad/s in measured-axis.csv)";

}  // namespace

TEST_CASE("measured axis: it hunts as the known one does, to the error of its data") {
  const auto ran = run({"predict", shipped("measured-axis.toml"), "--json", "-"});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  REQUIRE(document["cycles"].size() == 1);
  const Json& cycle = document["cycles"][0];
  // Of the two masses themselves: period 5.06795764748 s, amplitude 1.04144646541e-3 m.
  CHECK(cycle["period"].get<double>() == Approx(5.06795764748).epsilon(0.01));
  CHECK(cycle["amplitude"].get<double>() == Approx(1.04144646541e-3).epsilon(0.01));
  CHECK(cycle["stable"] == true);
  const Json& measured = document["case"]["measured"].at(0);
  CHECK(measured["path"] == "loop.plant");
  CHECK(measured["file"] == "measured-axis.csv");
  CHECK(measured["order"] == 4);
  CHECK(measured["poles_at_zero"] == 1);
  CHECK(measured["deviations"].get<double>() == Approx(1.0).epsilon(0.15));
  CHECK(document["notes"].dump().find(basis) != std::string::npos);
}

TEST_CASE("measured plant: a root states the uncertainty of its data, in the document and in words") {
  const Scratch scratch;
  std::string rows;
  for (int i = 0; i < 60; ++i) {
    const double w = 0.05 * std::pow(400.0, i / 59.0);
    const auto G = 1.0 / std::pow(std::complex<double>(1.0, w), 3);
    rows += std::to_string(w) + ',' + std::to_string(G.real()) + ',' + std::to_string(G.imag()) + ',' +
            std::to_string(0.02 * std::abs(G)) + '\n';
  }
  scratch.put("d.csv", rows);
  const std::string file = scratch.put(
      "a.toml",
      "[loop.plant]\nkind = \"frf\"\nfile = \"d.csv\"\nfrequency = \"rad/s\"\nformat = \"re-im\"\nuncertainty = "
      "\"standard-deviation\"\norder = 3\n[loop.element]\nkind = \"relay\"\nlevel = 1.0\n[search]\namplitude = [1e-3, "
      "10.0]\nfrequency = [0.1, 10.0]\n");
  const auto ran = run({"predict", file, "--json", "-"});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  const Json& root = document["predictions"].at(0);
  REQUIRE(root["method"] == "describing-function");
  // 4 |G|/(pi A) = 1 and arg G = -pi at w = 3^(1/2), where d arg G/d ln w = -3 w/(1 + w^2) = -3 3^(1/2)/4.
  const double by_phase = 0.02 / (3.0 * std::sqrt(3.0) / 4.0);
  CHECK(root["uncertainty"]["frequency"].get<double>() == Approx(by_phase).epsilon(0.02));
  // ln A = ln |G(w)| + ..., d ln |G|/d ln w = -3 w^2/(1 + w^2) = -9/4.
  CHECK(root["uncertainty"]["amplitude"].get<double>() == Approx(std::hypot(0.02, 2.25 * by_phase)).epsilon(0.02));
  CHECK(document["notes"].dump().find("the uncertainty of the data leaves a standard deviation of") !=
        std::string::npos);
}

TEST_CASE("measured axis: every text states what it rests on, and no document replaces the data") {
  const Scratch scratch;
  const auto simulated =
      run({"simulate", shipped("measured-axis.toml"), "--set", "simulate.duration=0.5", "--no-check"});
  CHECK(simulated.code == 0);
  CHECK(squeezed(simulated.out).find(basis) != std::string::npos);
  CHECK(squeezed(simulated.out).find("a fit of order 4 with one pole at zero, which differs from the data by") !=
        std::string::npos);
  const auto checked = run({"check", shipped("measured-axis.toml"), "--fit", scratch.file("fit.svg")});
  CHECK(checked.code == 0);
  CHECK(checked.out.find("fit         a fit of order 4") != std::string::npos);
  const std::string picture = scratch.get("fit.svg");
  CHECK(picture.starts_with("<svg"));
  CHECK(picture.find("distance of the fit from the data") != std::string::npos);
  const auto over = run({"check", shipped("measured-axis.toml"), "--json", shipped("measured-axis.csv")});
  CHECK(over.code == 2);
  CHECK(over.err.find("is the data of loop.plant") != std::string::npos);
  const auto none = run({"check", shipped("pid-lugre.toml"), "--fit", scratch.file("none.svg")});
  CHECK(none.code == 2);
  CHECK(none.err.find("no measured plant") != std::string::npos);
}

TEST_CASE("measured plant: its dead time is a number of its own, and a cause that cannot be tried ends no prediction") {
  const Scratch scratch;
  std::ostringstream rows;
  rows.precision(17);
  for (int i = 0; i < 80; ++i) {
    const double w = 1e-3 * std::pow(2e4, i / 79.0);
    const std::complex<double> s(0.0, w);
    const auto G = 2.0 * std::exp(-1.5 * s) / ((5.0 * s + 1.0) * (2.0 * s + 1.0));
    rows << w << ',' << G.real() << ',' << G.imag() << '\n';
  }
  scratch.put("d.csv", rows.str());
  const std::string relay = "[loop.element]\nkind = \"relay\"\nlevel = 1.0\nhysteresis = 0.1\n";
  const std::string measured = scratch.put(
      "a.toml",
      "[loop.plant]\nkind = \"frf\"\nfile = \"d.csv\"\nfrequency = \"rad/s\"\nformat = \"re-im\"\ndelay = 1.5\n" +
          relay);
  const std::string known = scratch.put(
      "b.toml", "[loop.plant]\nkind = \"zpk\"\nzeros = []\npoles = [-0.2, -0.5]\ngain = 0.2\ndelay = 1.5\n" + relay);
  const auto of_data = run({"predict", measured, "--json", "-"}), of_poles = run({"predict", known, "--json", "-"});
  REQUIRE(of_data.code == 0);
  REQUIRE(of_poles.code == 0);
  const Json data = Json::parse(of_data.out)["cycles"].at(0), poles = Json::parse(of_poles.out)["cycles"].at(0);
  CHECK(data["period"].get<double>() == Approx(poles["period"].get<double>()).epsilon(1e-6));
  CHECK(data["amplitude"].get<double>() == Approx(poles["amplitude"].get<double>()).epsilon(1e-6));
}
