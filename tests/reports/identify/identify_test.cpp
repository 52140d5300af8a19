#include "limcycle/reports/identify/identify.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/models/catalogue.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using IdentifyJson = nlohmann::ordered_json;

namespace {

/// Friction of a table of velocities, without noise but for a small pattern; Fs stands in no row.
IdentifyReport table_report(const FreeChoice& choice = {}, const IdentifyOptions& options = {}) {
  FrictionRecord record{RecordKind::steady_velocity, "sweep.csv", {}, {}, {}, {}, 0.0};
  for (int i = 1; i <= 24; ++i) {
    record.v.push_back(0.01 * i);
    record.F.push_back(2.0 + 3.0 * record.v.back() + 0.01 * ((i * 7) % 5 - 2));
  }
  IdentifyRequest request;
  request.laws = {*find_kind(catalogue_of_elements().friction_laws, "coulomb")};
  request.records = {record};
  request.choice = choice;
  return identify(request, options);
}

}  // namespace

TEST_CASE("identify report: a number that the records do not determine has no digits") {
  const IdentifyReport report = table_report();
  const std::string text = identify_text("a rig", report);
  CHECK_THAT(text, Contains("The records do not determine Fs.") && Contains("not determined: Fs"));
  const auto document = IdentifyJson::parse(identify_json({}, report));
  CHECK(document["command"] == "identify");
  CHECK(document["chosen"] == "coulomb");
  const auto& parameters = document["laws"][0]["parameters"];
  REQUIRE(parameters.size() == 3);
  for (const auto& one : parameters) {
    const bool undetermined = one["name"] == "loop.friction.Fs";
    CHECK(one["identifiable"] == !undetermined);
    CHECK(one["value"].is_null() == undetermined);
    CHECK(one["high"].is_null() == undetermined);
  }
  CHECK(parameters[0]["low"].get<double>() < 2.0);
  CHECK(parameters[0]["high"].get<double>() > 2.0);
  CHECK_THAT(identify_csv(report), Contains("coulomb,true,") && Contains("loop.friction.Fs,N,,"));
}

TEST_CASE("identify report: what one more record would tell") {
  IdentifyReport report = table_report();
  IdentifiedLaw& law = report.laws.front();
  CHECK(IdentifyJson::parse(identify_json({}, report))["plan"].is_null());
  law.plan = IdentifyPlan{
      .noise = 0.02,
      .noise_is_assumed = true,
      .values = {2.0, 1.5, 0.0},
      .half_width = {0.1, infinite, 0.5},
      .records = {{RecordKind::lag, 100, {0.05, infinite, 0.4}}, {RecordKind::break_away, 200, {0.08, 0.3, 0.5}}}};
  const std::string text = identify_text("a rig", report);
  CHECK_THAT(text, Contains("5.0 %") && Contains("2.5 % *") && Contains("4.0 %"));
  CHECK_THAT(text, Contains("20 % *") && Contains("0.50 N s/m") && Contains("0.40 N s/m *"));
  CHECK_THAT(
      text,
      Contains("The number that is known least is Fs: a further record of the kind break-away\nwould narrow it most"));
  CHECK_THAT(text, Contains("2 % of the largest force (assumed)"));
  const auto plan = IdentifyJson::parse(identify_json({}, report))["plan"];
  CHECK(plan["now"][1]["half_width"].is_null());
  CHECK(plan["now"][0]["name"] == "loop.friction." + law.numbers[0].name);
  CHECK(plan["records"][1]["half_widths"][1] == 0.3);
  law.plan->records[1].half_width[1] = infinite;
  CHECK_THAT(identify_text("a rig", report), Contains("No further record of these kinds would determine Fs."));
}

TEST_CASE("identify report: the fitted law takes the place of the one in the case") {
  const IdentifyReport report = table_report();
  const std::string text =
      "title = \"t\"\n[loop.plant]\nkind = \"mass\"\nmass = 1.0\n[loop.friction]  # a guess\nkind = \"lugre\"\nFs = "
      "9.0\n"
      "[loop.controller]\nkind = \"pid\"\nkp = 1.0\n[identify]\nlaw = \"coulomb\"\n[[identify.record]]\nkind = "
      "\"lag\"\n"
      "[sensitivity]\nsamples = 4\n[search]\namplitude = [1.0, 2.0]\n";
  const std::string fitted = fitted_case(text, "t", report.laws.front());
  CHECK_THAT(fitted,
             Contains("[loop.friction]\nkind = \"coulomb\"\nFc = ") && Contains("# not determined by the records"));
  CHECK_THAT(fitted, Contains("[loop.controller]") && Contains("[search]\namplitude = [1.0, 2.0]\n"));
  CHECK_THAT(fitted, !Contains("lugre") && !Contains("identify") && !Contains("samples = 4"));
  CHECK_THAT(fitted, Contains("path = \"loop.friction.sigma2\"") &&
                         Contains("path = \"loop.friction.Fs\"\ndistribution = \"log-uniform\""));
  IdentifiedLaw joint = report.laws.front();
  joint.correlated = {"Fc", "sigma2", "other"};
  joint.correlations = (Eigen::MatrixXd(3, 3) << 1.0, -0.25, 0.5, -0.25, 1.0, 0.1, 0.5, 0.1, 1.0).finished();
  CHECK_THAT(
      fitted_case(text, "t", joint),
      Contains("[sensitivity]\ncorrelation = [\n  {between = [\"loop.friction.Fc\", \"loop.friction.sigma2\"], value "
               "= -0.250000},\n]\n[[sensitivity.parameters]]") &&
          !Contains("other"));
  IdentifiedLaw at_bound = report.laws.front();
  at_bound.numbers.back().value = 0.0;
  at_bound.numbers.back().low = 0.0;
  CHECK_THAT(fitted_case(text, "t", at_bound),
             Contains("path = \"loop.friction.sigma2\"\ndistribution = \"uniform\"\nfrom = 0.0\n"));
  CHECK_THAT(fitted_case("[identify]\n", "a \"rig\"", report.laws.front()), Contains("title = \"a \\\"rig\\\"\""));
  CHECK_THROWS_AS(fitted_case("[diagram]\noutput = \"a.y\"\n", "t", report.laws.front()), std::invalid_argument);
}

TEST_CASE("identify report: a fixed value stands in the fitted case, and rows of a matrix are no headers") {
  const IdentifyReport report = table_report({{}, {{"Fs", 10.0}}, 4});
  const std::string text =
      "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n[loop.plant]\nkind = \"state-space\"\nA = [\n  [0.0, 1.0],  # "
      "[a]\n"
      "  [-1.0]\n]\n[identify]\nlaw = \"coulomb\"\n[df]\nx = 1\n";
  const std::string fitted = fitted_case(text, "t", report.laws.front());
  CHECK_THAT(fitted, Contains("\nFs = 10.0\n") && Contains("A = [\n  [0.0, 1.0],  # [a]\n  [-1.0]\n]\n[df]\nx = 1\n"));
}

TEST_CASE("identify report: a stop is said, and not that records determine too little") {
  int asked = 0;
  IdentifyOptions options;
  options.stop = [&] { return ++asked > 8; };
  const std::string text = identify_text("a rig", table_report({}, options));
  CHECK_THAT(text, Contains("the work was stopped") && Contains("Status: interrupted"));
  CHECK_THAT(text, !Contains("no fit converged"));
}

TEST_CASE("identify report: the picture has a panel for each record, and finite places only") {
  const std::string picture = identify_picture(table_report());
  CHECK_THAT(picture, Contains("steady-velocity") && Contains("class=\"law\""));
  CHECK_THAT(picture, Contains("measured less fitted: at most "));
  CHECK_THAT(picture, !Contains("nan") && !Contains("inf"));
}
