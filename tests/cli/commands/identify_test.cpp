#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/setting.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

const std::string rig_law =
    "title = \"a rig\"\n[loop.friction]\nkind = \"stribeck\"\nFs = 1.5\nFc = 1.0\nvs = 0.001\nsigma2 = 20.0\n"
    "[df]\namplitude = [1.0]\nfrequency = [1.0]\n";

}  // namespace

TEST_CASE("synthesize, identify: from a law to records and back") {
  const Scratch scratch;
  const std::string law = scratch.put("law.toml", rig_law), rig = scratch.file("rig");
  const auto made =
      run({"synthesize", law, "--noise", "0.01", "--seed", "5", "-o", rig, "--json", scratch.file("s.json")});
  REQUIRE(made.code == 0);
  const auto truth = Json::parse(scratch.get("s.json"));
  CHECK(truth["law"]["kind"] == "stribeck");
  CHECK(truth["records"].size() == 4);
  CHECK(run({"synthesize", law, "-o", rig}).code == 2);  // not over another one
  CHECK(run({"synthesize", law, "-o", rig, "--force", "--seed", "5"}).code == 0);

  const auto fitted = run({"identify", rig + "/identify.toml", "--json", scratch.file("i.json"), "--svg",
                           scratch.file("i.svg"), "--fitted", scratch.file("fitted.toml")});
  REQUIRE(fitted.code == 0);
  CHECK_THAT(fitted.out, Contains("95 % interval") && Contains("Fs") && Contains("fitted.toml"));
  const auto document = Json::parse(scratch.get("i.json"));
  CHECK(document["chosen"] == "stribeck");
  for (const auto& one : document["laws"][0]["parameters"]) {
    CHECK(one["identifiable"] == true);
    CHECK(one["low"].get<double>() < one["value"].get<double>());
  }
  CHECK_THAT(scratch.get("i.svg"), Contains("<svg") && Contains("break-away"));
  CHECK(run({"check", scratch.file("fitted.toml")}).code == 0);

  // the same again, for any number of threads
  REQUIRE(run({"identify", rig + "/identify.toml", "--threads", "3", "--json", scratch.file("j.json")}).code == 0);
  CHECK(document["laws"] == Json::parse(scratch.get("j.json"))["laws"]);
}

TEST_CASE("identify: a record that is not there is named with its key, and predict does not need it") {
  const Scratch scratch;
  const std::string law = scratch.put(
      "law.toml", rig_law + "[identify]\nlaw = \"lugre\"\n[[identify.record]]\nkind = \"lag\"\nfile = \"no.csv\"\n");
  const auto ran = run({"identify", law});
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Contains("law.toml: identify.record[0].file: no such file: ") && Contains("no.csv"));
  CHECK(run({"check", law}).code == 0);
}

TEST_CASE("identify: the shipped records give the law that made them") {
  const Scratch scratch;
  REQUIRE(run({"identify", shipped("records/servo.toml"), "--json", scratch.file("i.json")}).code == 0);
  const auto document = Json::parse(scratch.get("i.json"));
  CHECK(document["chosen"] == "lugre");
  const std::pair<const char*, double> truth[] = {{"loop.friction.Fs", 1.5}, {"loop.friction.sigma0", 1e5}};
  for (const auto& [name, value] : truth) {
    double found = 0.0;
    for (const auto& one : document["laws"][2]["parameters"])
      if (one["name"] == name) found = one["value"].get<double>();
    CHECK(found == Approx(value).epsilon(0.02));
  }
}

TEST_CASE("identify, synthesize: a time limit ends them with 3, and other files are kept") {
  const Scratch scratch;
  const std::string fitted = scratch.file("fitted.toml");
  const auto ran = run({"identify", shipped("records/servo.toml"), "--time-limit", "0.001", "--fitted", fitted,
                        "--json", scratch.file("i.json"), "--csv", scratch.file("i.csv")});
  CHECK(ran.code == 3);
  CHECK_THAT(ran.err, Contains("no fitted case to write"));
  CHECK(Json::parse(scratch.get("i.json"))["status"] == "time-limit");
  CHECK_THAT(scratch.get("i.csv"), Contains("law,chosen"));
  CHECK_FALSE(std::filesystem::exists(fitted));

  const std::string law = scratch.put("law.toml", rig_law), rig = scratch.file("rig");
  // It takes milliseconds, so that it may be done before the limit is looked at: whole, or not at all.
  const int code = run({"synthesize", shipped("pid-lugre.toml"), "--time-limit", "1e-6", "-o", rig}).code;
  CHECK((code == 3 || code == 0));
  CHECK(std::filesystem::exists(rig) == (code == 0));
  std::filesystem::remove_all(rig);
  std::filesystem::create_directory(rig);
  scratch.put("rig/lag.csv", "mine");
  const auto refused = run({"synthesize", law, "-o", rig});
  CHECK(refused.code == 2);
  CHECK_THAT(squeezed(refused.err), Contains("lag.csv") && Contains("--force"));
  CHECK(scratch.get("rig/lag.csv") == "mine");
}

TEST_CASE("identify, synthesize: a case whose files would be out of reach is not written elsewhere") {
  const Scratch scratch;
  std::string data = "frequency,real,imag\n";
  for (int i = 1; i <= 200; ++i)
    data += std::to_string(0.1 * i) + "," + std::to_string(-1.0 / (0.01 * i * i)) + ",0.0\n";
  scratch.put("plant.csv", data);
  const std::string plant =
      "[loop.plant]\nkind = \"frf\"\nfile = \"plant.csv\"\nfrequency = \"rad/s\"\nformat = "
      "\"re-im\"\n[loop.controller]\nkind = \"pid\"\nkp = 1.0\n";
  const auto refused = run({"synthesize", scratch.put("c.toml", rig_law + plant), "-o", scratch.file("rig")});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Contains("plant.csv"));
  CHECK_FALSE(std::filesystem::exists(scratch.file("rig")));
}

TEST_CASE("identify: bad input ends with 2 and a sentence with file and row") {
  const Scratch scratch;
  const auto said = [&](const std::string& csv, const std::string& keys = "") {
    scratch.put("r.csv", csv);
    const auto ran = run({"identify", scratch.put("c.toml",
                                                  "[identify]\nlaw = \"lugre\"\n[[identify.record]]\nkind = "
                                                  "\"pre-sliding\"\nfile = \"r.csv\"\n" +
                                                      keys)});
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    return ran.err;
  };
  std::string good = "time,position,velocity,force\n", wrong = good, backwards = good;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.01 * i;
    const auto row = [&](double time, double scale) {
      return std::to_string(time) + "," + std::to_string(scale * std::sin(5.0 * t)) + "," +
             std::to_string(5.0 * std::cos(5.0 * t)) + "," + std::to_string(std::sin(5.0 * t)) + "\n";
    };
    good += row(t, 1.0);
    wrong += row(t, 1000.0);
    backwards += row(i == 17 ? 0.0 : t, 1.0);
  }
  CHECK_THAT(said(wrong), Contains("r.csv") && Contains("1e+03 times as far") && Contains("another unit"));
  CHECK_THAT(said(backwards), Contains("time does not rise at row 18"));
  CHECK_THAT(said("time,position,velocity,force\n0,0,0,0\n1,1,1,1\n"), Contains("has 2 rows"));
  CHECK_THAT(said("time,position,velocity\n0,0,0\n"), Contains("has no column \"force\""));
  CHECK_THAT(said(good + "0.5,0,0,NaN\n"), Contains("r.csv:42: \"NaN\" in column 4 (force)"));
  CHECK_THAT(said(good, "position = \"x\"\n"), Contains("has no column \"x\""));
  CHECK(run({"identify", shipped("pid-lugre.toml")}).code == 2);
  CHECK(run({"predict", scratch.file("c.toml")}).code == 2);
  CHECK(run({"df", scratch.file("c.toml")}).code == 2);
  CHECK(run({"dissipativity", scratch.file("c.toml")}).code == 2);
  CHECK(run({"check", scratch.file("c.toml")}).code == 0);
  CHECK(run({"synthesize", shipped("van-der-pol.toml"), "-o", scratch.file("rig")}).code == 2);
}

TEST_CASE("synthesize, identify: free motions of the plant, from a law to records and back") {
  const Scratch scratch;
  const std::string plant = "[loop.plant]\nkind = \"mass\"\nmass = 1.0\nstiffness = 2000.0\n";
  const std::string law = scratch.put("law.toml", rig_law + plant), rig = scratch.file("rig");
  REQUIRE(run({"synthesize", law, "--free", "--seed", "2", "-o", rig, "--json", scratch.file("s.json")}).code == 0);
  const auto made = Json::parse(scratch.get("s.json"));
  REQUIRE(made["records"].size() == 6);
  CHECK(made["records"][5]["kind"] == "free-decay");
  CHECK(made["records"][5]["rows"] == 601);
  CHECK_THAT(scratch.get("rig/free-decay.csv"), Contains("time,position,velocity\n"));

  const auto fitted =
      run({"identify", rig + "/identify.toml", "--set",
           "identify.record=[{kind=\"steady-velocity\",file=\"steady-velocity.csv\"},{kind=\"free-decay\","
           "file=\"free-decay.csv\"}]",
           "--json", scratch.file("i.json"), "--svg", scratch.file("i.svg"), "--fitted", scratch.file("fitted.toml")});
  REQUIRE(fitted.code == 0);
  CHECK_THAT(squeezed(fitted.out), Contains("free-decay, velocity") && Contains("each simulated in one run"));
  const auto document = Json::parse(scratch.get("i.json"));
  CHECK(document["shooting"] == "single");
  CHECK(document["laws"][0]["start_states"] == 2);
  REQUIRE(document["records"].size() == 3);
  CHECK(document["records"][2]["quantity"] == "velocity");
  CHECK(document["records"][2]["largest_force"].is_null());
  CHECK_THAT(scratch.get("i.svg"), Contains("free-decay, position") && !Contains("nan"));
  CHECK(run({"check", scratch.file("fitted.toml")}).code == 0);
  CHECK(run({"synthesize", scratch.put("lone.toml", rig_law), "--free", "-o", scratch.file("other")}).code == 2);
}

TEST_CASE("identify: bad free records end with 2 and a sentence with file and row") {
  const Scratch scratch;
  const auto said = [&](const std::string& csv, const std::string& keys = "kind = \"free\"\n",
                        const std::string& loop =
                            "[loop.plant]\nkind = \"mass\"\nmass = 1.0\n[loop.friction]\nkind = "
                            "\"coulomb\"\nFc = 1.0\n") {
    scratch.put("r.csv", csv);
    const auto ran = run({"identify", scratch.put("c.toml", loop +
                                                                "[identify]\nlaw = \"coulomb\"\n[[identify.record]]\n"
                                                                "file = \"r.csv\"\n" +
                                                                keys)});
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    return squeezed(ran.err);
  };
  std::string good = "time,position,force\n", backwards = good, still = good;
  for (int i = 0; i < 40; ++i) {
    const auto row = [&](double time, double position) {
      return std::to_string(time) + "," + std::to_string(position) + "," + std::to_string(std::sin(0.3 * i)) + "\n";
    };
    good += row(0.01 * i, std::sin(0.3 * i));
    backwards += row(i == 17 ? 0.0 : 0.01 * i, std::sin(0.3 * i));
    still += row(0.01 * i, 0.7);
  }
  CHECK_THAT(said(good, "kind = \"free\"\n", ""), Contains("loop.plant") && Contains("the plant that moves"));
  CHECK_THAT(said("time,position\n0,0\n"), Contains("has no column \"force\""));
  CHECK_THAT(said("time,force\n0,0\n1,1\n", "kind = \"free\"\n"), Contains("has 2 rows"));
  CHECK_THAT(said("time,position,force\n0,0,0\n1,1,1\n"),
             Contains("r.csv: has 2 rows; a free record needs at least 10"));
  CHECK_THAT(said(backwards), Contains("time does not rise at row 18"));
  CHECK_THAT(said(still), Contains("the body does not move"));
  CHECK_THAT(said(good + "0.5,NaN,0\n"), Contains("r.csv:42: \"NaN\" in column 2 (position)"));
  CHECK_THAT(said("position,force\n0,0\n"), Contains("has no column \"time\""));
}

TEST_CASE("identify: a column in thousandths of a unit, as its header says, needs a scale") {
  const Scratch scratch;
  std::string rows = "velocity [mm/s],force [N]\n";
  for (int i = 1; i <= 30; ++i) rows += std::to_string(i) + "," + std::to_string(1.0 + 0.5 * std::exp(-0.1 * i)) + "\n";
  scratch.put("sweep.csv", rows);
  const std::string record =
      "[identify]\nlaw = \"stribeck\"\n[[identify.record]]\nkind = \"steady-velocity\"\n"
      "file = \"sweep.csv\"\n";
  const auto refused = run({"identify", scratch.put("a.toml", record)});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Contains("\"velocity [mm/s]\" is in mm/s") && Contains("scale = {velocity = 0.001}"));
  CHECK(run({"identify", scratch.put("b.toml", record + "scale = {velocity = 1e-3}\n")}).code == 0);
}

TEST_CASE("identify: levels that the records do not determine vary in the fitted case, and every draw is a law") {
  const Scratch scratch;
  // A force of 12 N at speeds too slow for any other: it may be that of breaking away.
  std::string rows = "velocity,force\n";
  limcycle::RandomStream draw(3, "sweep");
  for (const int sign : {1, -1})
    for (int i = 0; i < 25; ++i) {
      double noise = -6.0;  // normal, nearly
      for (int k = 0; k < 12; ++k) noise += draw.uniform();
      rows += std::to_string(sign * 1e-3 * std::pow(200.0, i / 24.0)) + "," +
              std::to_string(sign * 12.0 + 0.1 * noise) + "\n";
    }
  scratch.put("sweep.csv", rows);
  const std::string case_file = scratch.put(
      "a.toml",
      "[loop]\n[loop.plant]\nkind = \"mass\"\nmass = 5.0\n[loop.controller]\nkind = \"pid\"\nkp = 3000.0\nki = 8000.0\n"
      "kd = 200.0\n[loop.friction]\nkind = \"stribeck\"\nFs = 12.0\nFc = 8.0\nvs = 0.005\n"
      "[identify]\nlaw = \"stribeck\"\n[[identify.record]]\nkind = \"steady-velocity\"\nfile = \"sweep.csv\"\n"
      "scale = {velocity = 1e-3}\n");
  const auto fitted = run({"identify", case_file, "--fitted", scratch.file("f.toml")});
  CAPTURE(fitted.out, fitted.err);
  REQUIRE(fitted.code == 0);
  CHECK_THAT(fitted.out, Contains("do not determine"));
  const std::string text = scratch.get("f.toml");
  CHECK_THAT(text, Contains("path = \"loop.friction.Fc\"") && Contains("path = \"loop.friction.Fs\""));
  const auto ran = run({"sensitivity", scratch.file("f.toml"), "--samples", "64", "--json", scratch.file("s.json")});
  REQUIRE(ran.code == 0);
  const auto robustness = Json::parse(scratch.get("s.json"))["robustness"];
  CAPTURE(robustness.dump());
  CHECK(robustness["undecided"].get<int>() <= 3);
}
