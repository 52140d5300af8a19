#include "limcycle/reports/precision/atlas.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/lines.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

namespace {

AtlasPoint made(double stiffness, const std::string& stepper, double setting, RunClass kind, double error = not_known,
                const std::string& why = {}, bool fixed = false) {
  return {"lugre", stiffness, stepper, setting, fixed, kind, error, 1234, why};
}

StepperAtlas sample_atlas() {
  StepperAtlas atlas;
  atlas.points = {made(1e5, "rodas5p", 1e-3, RunClass::right, 1e-4),
                  made(1e5, "rodas5p", 1e-6, RunClass::right, 1e-8),
                  made(1e8, "rodas5p", 1e-3, RunClass::creeps, 0.3, "periods differ by <40> %"),
                  made(1e8, "rodas5p", 1e-6, RunClass::right, 7e-8),
                  made(1e5, "dopri5", 1e-3, RunClass::right, 2e-5),
                  made(1e8, "dopri5", 1e-3, RunClass::too_slow, not_known, "given up after 9 steps"),
                  made(1e5, "euler", 1e-2, RunClass::diverges, not_known, "ended with status not_finite", true),
                  made(1e8, "euler", 1e-2, RunClass::diverges, not_known, "ended with status not_finite", true)};
  atlas.references = {{"lugre", 1e5, true, true, 24.4, 1e-10, "period 24.4 s"},
                      {"lugre", 1e8, true, true, 23.7, 1e-10, "period 23.7 s"},
                      {"lugre", 1e9, false, false, not_known, not_known, "nothing agreed"}};
  return atlas;
}

Provenance provenance_of_test() {
  Provenance from;
  from.title = "a & b";
  return from;
}

}  // namespace

TEST_CASE("atlas report: which tolerance is right everywhere") {
  const auto answer = atlas_answer(sample_atlas());
  CHECK_THAT(answer,
             Contains("rodas5p at 1e-06 or tighter") && Contains("dopri5 at 1e-03 or tighter where it is not too"));
  CHECK_THAT(atlas_answer({}), Contains("no stepper can be assessed"));
  auto worse = sample_atlas();
  worse.points[3].kind = RunClass::rough;
  CHECK_THAT(atlas_answer(worse), Contains("At no tolerance right everywhere: rodas5p."));

  const Table table = atlas_table(sample_atlas(), "lugre");
  REQUIRE(table.rows.size() == 3);
  CHECK(table.rows[0] == std::vector<std::string>{"rodas5p", "1e-03", "1e-06"});
  CHECK(table.rows[1] == std::vector<std::string>{"dopri5", "1e-03", "too slow"});
  CHECK(table.rows[2] == std::vector<std::string>{"euler", "diverges", "diverges"});
}

TEST_CASE("atlas report: text, documents, picture, page") {
  const auto text = atlas_text("title", sample_atlas());
  CHECK_THAT(text, Contains("Right everywhere") && Contains("4 right") && Contains("left out, no verified reference"));
  for (const auto& line : test::lines_of(text)) CHECK(line.size() <= 100);

  const auto document = Json::parse(atlas_json(provenance_of_test(), sample_atlas()));
  CHECK(document["command"] == "precision");
  REQUIRE(document["points"].size() == 8);
  CHECK(document["points"][2]["result"] == "creeps");
  CHECK(document["points"][5]["error"].is_null());
  CHECK(document["points"][6]["of"] == "step");
  CHECK(document["reference"][2]["verified"] == false);
  CHECK(document["limits"][1]["loosest_right"] == 1e-6);
  CHECK(document["limits"][4]["loosest_right"].is_null());

  CHECK_THAT(atlas_csv(sample_atlas()), StartsWith("law,stiffness,stepper,setting,of,result,error,steps,why\nlugre,"));
  const auto picture = atlas_picture(sample_atlas());
  CHECK_THAT(picture, StartsWith("<svg") && Contains("periods differ by &lt;40&gt; %") && Contains("misses event"));
  CHECK_THAT(picture, !Contains("nan") && !Contains("<40>"));
  const auto page = atlas_page(sample_atlas(), provenance_of_test(), "[loop]");
  CHECK_THAT(page, Contains("<svg") && Contains("precision") && Contains("nothing agreed"));
}
