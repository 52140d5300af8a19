#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/tests/cli/program.hpp"

using limcycle::test::Ran;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;
using limcycle::test::squeezed;
using Json = nlohmann::ordered_json;

TEST_CASE("check tells what the default case holds") {
  const Ran ran = run({"check", shipped("pid-lugre.toml")});
  CHECK(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK(ran.out.find("title       PID position servo that hunts on LuGre friction\n") == 0);
  for (const auto* line :
       {"plant       mass\n", "controller  pid\n", "elements    loop.friction: lugre\n", "states      y, v, I, z\n",
        "order       3 (linear part)\n", ": stable without the elements\n",
        "search box  amplitude 1e-06 .. 1, frequency 0.01 .. 1000 rad/s (from the case)\n", "The case is valid.\n"})
    CHECK(ran.out.find(line) != std::string::npos);
}

TEST_CASE("check: a diagram is listed and drawn") {
  const Scratch scratch;
  const std::string file = scratch.file("a.toml"), picture = scratch.file("a.svg");
  REQUIRE(run({"new", "--diagram", "-o", file}).code == 0);
  const Ran ran = run({"check", file, "-o", picture, "--json", scratch.file("a.json")});
  REQUIRE(ran.code == 0);
  CHECK(ran.out.find("blocks      position: gain of r - axis.y\n            velocity: pid of position - axis.v\n") !=
        std::string::npos);
  CHECK(ran.out.find("guide: stribeck on axis\n") != std::string::npos);
  const Json document = Json::parse(scratch.get("a.json"));
  CHECK(document.at("plant").is_null());
  CHECK(document.at("blocks").size() == 5);
  CHECK(document.at("blocks").at(1) ==
        Json::parse(R"({"name": "velocity", "kind": "pid", "inputs": ["position - axis.v"]})"));
  const std::string drawn = scratch.get("a.svg");
  CHECK(drawn.starts_with("<svg "));
  for (const auto* name :
       {">position: gain<", ">velocity: pid<", ">saturation = 800<", ">axis: mass<", ">guide: stribeck<"})
    CHECK(drawn.find(name) != std::string::npos);
}

TEST_CASE("check: the JSON document") {
  const std::string file = shipped("pid-lugre.toml");
  const Ran ran =
      run({"check", file, "--json", "-", "--set", "loop.controller.kd=7.0", "--seed", "5", "--isa", "x86-64"});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  CHECK(document.at("schema") == "limcycle/1");
  CHECK(document.at("command") == "check");
  CHECK(document.at("case").at("file") == file);
  CHECK(document.at("case").at("title") == "PID position servo that hunts on LuGre friction");
  CHECK(document.at("case").at("sha256") == limcycle::load_case(file).sha256);
  const Json& made = document.at("provenance");
  CHECK(made.at("seed") == 5);
  CHECK(made.at("threads") == 1);
  CHECK(made.at("isa") == "x86-64");
  CHECK(made.at("overrides") == Json::array({"loop.controller.kd=7.0"}));
  for (const auto* key : {"version", "commit", "compiler", "build_type"})
    CHECK_FALSE(made.at(key).get<std::string>().empty());
  CHECK(document.at("plant") == "mass");
  CHECK(document.at("elements") == Json::parse(R"([{"path": "loop.friction", "kind": "lugre"}])"));
  CHECK(document.at("states") == Json::array({"y", "v", "I", "z"}));
  CHECK(document.at("order") == 3);
  CHECK(document.at("stable") == true);
  CHECK(document.at("search").at("amplitude") == Json::array({1e-6, 1.0}));
  std::vector<std::string> keys;
  for (const auto& [key, value] : document.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"schema", "command", "case", "provenance", "plant", "controller", "blocks",
                                         "elements", "states", "order", "delay", "slowest_pole", "stable", "search"});
}

TEST_CASE("check: the poles without the elements") {
  const auto checked = [](const std::string& name, const std::string& override = "title=\"t\"") {
    return Json::parse(run({"check", shipped(name), "--json", "-", "--set", override}).out);
  };
  // The servo has s^3 + 6 s^2 + 3 s + 4: one real pole, and a pair whose sum is -6 less that pole.
  double low = -6.0, high = -5.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (((middle + 6.0) * middle + 3.0) * middle + 4.0 < 0.0 ? low : high) = middle;
  }
  CHECK(checked("pid-lugre.toml").at("slowest_pole").get<double>() == Approx((-6.0 - low) / 2.0).epsilon(1e-12));
  CHECK(checked("relay-integrator.toml").at("slowest_pole") == 0.0);
  CHECK(checked("relay-integrator.toml").at("stable") == false);
  CHECK(checked("van-der-pol.toml").at("slowest_pole").get<double>() == Approx(0.5));
  CHECK(checked("pid-lugre.toml", "loop.controller={kind=\"none\"}").at("stable") == false);  // a free mass
  const Json delayed = checked("relay-third-order.toml", "loop.plant.delay=0.5");
  CHECK(delayed.at("stable").is_null());
  CHECK(delayed.at("slowest_pole").is_null());
  CHECK(delayed.at("delay") == 0.5);
}

TEST_CASE("check: a case of a lone law, and where the documents go") {
  const Scratch scratch;
  const Ran ran = run({"check", shipped("df-lugre.toml"), "--json", scratch.file("j"), "--csv", scratch.file("c"), "-o",
                       scratch.file("t")});
  CHECK(ran.code == 0);
  CHECK(ran.out.empty());
  CHECK(scratch.get("t").find("df: 40 x 40 x 1 points") != std::string::npos);
  const Json document = Json::parse(scratch.get("j"));
  CHECK(document.at("plant").is_null());
  CHECK(document.at("search").is_null());
  CHECK(document.at("states") == Json::array({"z"}));
  CHECK(scratch.get("c").starts_with("title,plant,controller,elements,states,order,"));
}

TEST_CASE("check names every element of a loop in the order in which they are evaluated") {
  const auto elements = [](const std::string& name, const std::vector<std::string>& overrides = {}) {
    std::vector<std::string> arguments{"check", shipped(name), "--json", "-"};
    for (const auto& override : overrides) arguments.insert(arguments.end(), {"--set", override});
    const Json document = Json::parse(run(arguments).out);
    std::string text;
    for (const auto& element : document.at("elements"))
      text += element.at("path").get<std::string>() + ": " + element.at("kind").get<std::string>() + "\n";
    return text;
  };
  CHECK(elements("over-compensated.toml") ==
        "loop.controller.friction_compensation: friction-compensation\nloop.friction: coulomb\n");
  CHECK(elements("dead-zoned-error.toml", {"loop.controller.saturation=5.0"}) ==
        "loop.error: dead-zone\nloop.error.rate: output-rate\nloop.controller.saturation: saturation\n"
        "loop.friction: lugre\n");
  CHECK(elements("relay-delay.toml") == "loop.element: relay\n");
  CHECK(elements("froude-pendulum.toml") == "loop.plant.gravity: gravity\nloop.friction: lugre\n");
}

TEST_CASE("every shipped case passes check") {
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIMCYCLE_SOURCE_DIR) + "/cases"))
    if (entry.path().extension() == ".toml") CHECK(run({"check", entry.path().string(), "--quiet"}).code == 0);
}

TEST_CASE("laws lists every kind once, with one line each") {
  const Ran ran = run({"laws"});
  CHECK(ran.code == 0);
  for (const auto& entry : limcycle::catalogue()) CHECK(ran.out.find("\n  " + entry.kind + " ") != std::string::npos);
  CHECK(ran.out.find("Friction laws") < ran.out.find("Elements"));
  CHECK(ran.out.find("Elements on the error ([loop.error]; also dead-zone and saturation)\n") != std::string::npos);
}

TEST_CASE("laws KIND tells every parameter with unit, default, range and meaning") {
  for (const auto& entry : limcycle::catalogue()) {
    INFO(entry.kind);
    const Ran ran = run({"laws", entry.kind});
    CHECK(ran.code == 0);
    const std::string text = squeezed(ran.out);
    for (const auto& parameter : entry.parameters) {
      CHECK(text.find(" " + parameter.key + " ") != std::string::npos);
      CHECK(text.find(parameter.meaning) != std::string::npos);
    }
  }
  const std::string lugre = squeezed(run({"laws", "lugre"}).out);
  CHECK(lugre.find("Canudas de Wit") != std::string::npos);
  CHECK(lugre.find("exponential | tustin | lorentzian") != std::string::npos);
  CHECK(lugre.find("as Fs") != std::string::npos);
  CHECK(run({"laws", "state-space"}).out.find("state-space (controller)") != std::string::npos);
  CHECK(run({"laws", "quantizer"}).out.starts_with("quantizer (error element)\n"));
  for (const auto* controller : {"none", "pid", "transfer-function", "state-space"})
    CHECK(run({"laws", controller}).out.find("\nfriction_compensation  N ") != std::string::npos);
}

TEST_CASE("laws: the JSON document holds the parameter tables") {
  const Json document = Json::parse(run({"laws", "--json", "-"}).out);
  CHECK(document.at("schema") == "limcycle/1");
  CHECK(document.at("command") == "laws");
  CHECK(document.at("case") ==
        Json::parse(R"({"title": null, "file": null, "sha256": null, "measured": [], "curves": [], "matrices": []})"));
  CHECK(document.at("laws").size() == limcycle::catalogue().size());
  const Json lugre = Json::parse(run({"laws", "lugre", "--json", "-"}).out).at("laws").at(0);
  CHECK(lugre.at("states") == 1);
  CHECK(lugre.at("group") == "friction");
  for (const auto& parameter : lugre.at("parameters")) {
    if (parameter.at("key") == "delta") {
      CHECK(parameter.at("default") == 2.0);
      CHECK(parameter.at("range") ==
            Json::parse(R"({"low": 0.0, "high": null, "low_open": true, "high_open": false})"));
    }
    if (parameter.at("key") == "Fs_minus") CHECK(parameter.at("default_from") == "Fs");
    if (parameter.at("key") == "sigma0") CHECK((parameter.at("required") == true && parameter.at("unit") == "N/m"));
    if (parameter.at("key") == "curve") CHECK(parameter.at("default") == "exponential");
  }
}

TEST_CASE("laws: every friction law tells its features, in text, JSON, CSV and the page of documentation") {
  const std::string page = run({"laws", "--markdown"}).out;
  for (const auto& entry : limcycle::catalogue()) {
    INFO(entry.kind);
    if (entry.group != "friction") {
      CHECK(page.find("\n### " + entry.kind + "\n") != std::string::npos);
      continue;
    }
    REQUIRE(entry.features);
    const auto& features = *entry.features;
    for (const auto words : {features.drift, features.rate, features.passivity, features.evidence})
      CHECK_FALSE(words.empty());
    const Json law = Json::parse(run({"laws", entry.kind, "--json", "-"}).out).at("laws").at(0);
    CHECK(law.at("features").at("memory") == limcycle::to_string(features.memory));
    CHECK(law.at("features").at("drifts") == features.drifts);
    CHECK(law.at("features").at("passivity") == features.passivity);
    CHECK(law.at("states").is_null() == law.at("states_per_entry").is_number());
    const std::string text = run({"laws", entry.kind}).out;
    for (const auto* label : {"\nstates     ", "\nmemory     ", "\ndrift      ", "\nrate       ", "\npassive    ",
                              "\nconfirmed  ", "\nsource     "})
      CHECK(text.find(label) != std::string::npos);
    CHECK(page.find("\n| [" + entry.kind + "](#" + entry.kind + ") | ") != std::string::npos);
    CHECK(page.find("\n## " + entry.kind + "\n") != std::string::npos);
    for (const auto& parameter : entry.parameters)
      CHECK(page.find("\n| `" + parameter.key + "` | ") != std::string::npos);
  }
  CHECK(Json::parse(run({"laws", "relay", "--json", "-"}).out).at("laws").at(0).at("features").is_null());
}

TEST_CASE("laws: the CSV document has a line a parameter") {
  const std::string csv = run({"laws", "coulomb", "--csv", "-"}).out;
  CHECK(csv.starts_with(
      "group,kind,key,unit,type,required,default,low,high,meaning,states,memory,drifts,drift,rate,passivity,evidence\n"
      "friction,coulomb,Fc,N,number,true,,0,,sliding (Coulomb) level,0,none,false,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 6);
}

TEST_CASE("version and help") {
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"--version"}, {"check", "--version"}}) {
    const Ran ran = run(arguments);
    CHECK(ran.code == 0);
    CHECK(ran.out.starts_with("limcycle "));
    CHECK(ran.err.empty());
  }
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"--help"}, {"laws", "--help"}, {"check", "-h"}}) {
    const Ran ran = run(arguments);
    CHECK(ran.code == 0);
    CHECK(ran.out.find("Usage: ") != std::string::npos);
    CHECK(ran.err.empty());
  }
  for (const auto* command : {"predict", "df", "simulate", "check", "laws"})
    CHECK(run({"--help"}).out.find(command) != std::string::npos);
}
