#include "limcycle/reports/figures/nyquist_figure.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using Json = nlohmann::json;

namespace {

/// N depends on frequency: 25 members, with -1/N = (A, w / 100). One root, at one of its points.
PredictReport walking(double root_imaginary) {
  PredictReport report = sample::hunting();
  auto& picture = report.nyquist;
  picture.family_amplitude = {0.1, 0.2, 0.4};
  picture.family_frequency.clear();
  picture.minus_inverse_N.clear();
  picture.frequency.clear();
  picture.G.clear();
  for (int i = 1; i <= 25; ++i) {
    picture.family_frequency.push_back(i);
    picture.minus_inverse_N.emplace_back();
    for (const double A : picture.family_amplitude) picture.minus_inverse_N.back().push_back({A, 0.01 * i});
    picture.frequency.push_back(i);
    picture.G.push_back({0.2, root_imaginary * i / 7.0});
  }
  report.predictions = {{"composite-describing-function", 1.0, 2.0, 0.1, 0.0, true, Verdict::biased, 0, ""},
                        {"describing-function", 1.0, 7.0, 0.2, 1e-12, true, Verdict::confirmed, 0, ""}};
  return report;
}

bool says(const Figure& figure, const std::string& words) { return figure.finding.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("Nyquist figure: the family as computed, a few members drawn, that of the root among them") {
  const auto report = walking(0.07);
  const auto figure = nyquist_figure(report, Units{.y = "rad", .force = "N", .input = "mm"});
  const auto data = Json::parse(figure.data);
  CHECK(data["family"]["A"] == Json({0.1, 0.2, 0.4}));
  CHECK(data["family"]["unit"] == "mm");
  REQUIRE(data["family"]["members"].size() == 25);
  int drawn = 0;
  for (const auto& member : data["family"]["members"]) {
    drawn += member["drawn"] ? 1 : 0;
    CHECK(member["im"][1] == Approx(0.01 * member["w"].get<double>()));
    CHECK(member["re"] == data["family"]["A"]);
  }
  CHECK(drawn == 8);  // each fourth from the first, and the root's own
  CHECK(data["family"]["members"][6]["drawn"] == true);
}

TEST_CASE("Nyquist figure: a root stands at its -1/N, and the words say whether G passes there") {
  const auto on = nyquist_figure(walking(0.07), {});
  const auto root = Json::parse(on.data)["roots"];
  REQUIRE(root.size() == 1);
  CHECK(root[0] ==
        Json({{"prediction", 1}, {"re", 0.2}, {"im", 0.07}, {"A", 0.2}, {"w", 7.0}, {"verdict", "confirmed"}}));
  CHECK(says(on, "meets the curves −1/N(A,ω) of the element at amplitude 0.200 m and 7.00 rad/s (confirmed)."));
  CHECK(Json::parse(on.data)["small_motions"] == false);

  const auto off = nyquist_figure(walking(0.1), {});
  CHECK(Json::parse(off.data)["roots"] == root);
  CHECK(Json::parse(off.data)["small_motions"] == true);
  CHECK(says(off, "off the curve G(jω): that is the one for small motions"));
  CHECK_FALSE(says(off, "meets"));
}

TEST_CASE("Nyquist figure: no frequency where N does not depend on it, and no root that was not predicted") {
  const auto figure = nyquist_figure(sample::hunting(), {});
  const auto data = Json::parse(figure.data);
  REQUIRE(data["family"]["members"].size() == 1);
  CHECK(data["family"]["members"][0]["w"].is_null());
  CHECK(data["roots"].empty());
  CHECK(says(figure, "predicts no limit cycle"));
}
