#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using limcycle::test::message;

namespace {

std::string friction(const std::string& kind, const std::string& more) {
  return "[loop.friction]\nkind = \"" + kind + "\"\n" + more + "[df]\namplitude = [1e-3]\nfrequency = [1.0]\n";
}

const std::string points = "velocities = [0.001, 0.01]\nforces = [1.2, 1.0]\nFs = 1.5\n";

/// A folder with a file of points, and cases beside it.
class CurveFolder {
 public:
  CurveFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("limcycle-curve-" + std::to_string(std::hash<const void*>{}(this)))) {
    std::filesystem::create_directories(path_);
  }
  CurveFolder(const CurveFolder&) = delete;
  CurveFolder& operator=(const CurveFolder&) = delete;
  ~CurveFolder() { std::filesystem::remove_all(path_); }

  /// A case whose curve is this text.
  Case read(const std::string& text, const std::string& keys = {}) const {
    std::ofstream(path_ / "sweep.csv", std::ios::binary) << text;
    return read_case(friction("stribeck", "curve = \"table\"\nfile = \"sweep.csv\"\nFs = 1.5\n" + keys),
                     (path_ / "a.toml").string());
  }
  std::string refusal(const std::string& text, const std::string& keys = {}) const {
    try {
      read(text, keys);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("measured friction: curve = \"table\" stands for the law over measured points") {
  const Case by_curve = read_case(friction("stribeck", "curve = \"table\"\n" + points), "case.toml", {});
  const Case by_name = read_case(friction("stribeck-table", points), "case.toml", {});
  REQUIRE(by_curve.element);
  CHECK(by_curve.element->kind() == "stribeck-table");
  CHECK(by_curve.element->values() == by_name.element->values());
  CHECK(by_curve.element->number("Fs_minus") == 1.5);
  const std::string bristle = "curve = \"table\"\nsigma0 = 1e5\n" + points;
  CHECK(read_case(friction("lugre", bristle), "case.toml", {}).element->kind() == "lugre-table");
  const std::string blocks = "curve = \"table\"\nk = [1e4]\nalpha = [1.0]\nC = 10.0\n" + points;
  CHECK(read_case(friction("gms", blocks), "case.toml", {}).element->kind() == "gms-table");
}

TEST_CASE("measured friction: points that make no curve are refused with the rule") {
  const auto with = [](const std::string& text) { return message(friction("stribeck", "curve = \"table\"\n" + text)); };
  CHECK(with("velocities = [0.01, 0.001]\nforces = [1.2, 1.0]\nFs = 1.5\n").find("must ascend") != std::string::npos);
  CHECK(with("velocities = [0.001]\nforces = [1.2, 1.0]\nFs = 1.5\n").find("must be as many as the 1") !=
        std::string::npos);
  CHECK(with("velocities = [0.0, 0.1]\nforces = [1.2, 1.0]\nFs = 1.5\n").find("> 0") != std::string::npos);
  CHECK(with("velocities = [0.1]\nforces = [1.0]\n").find("Fs: is required") != std::string::npos);
  CHECK(with(points + "vs = 0.1\n").find("vs: unknown key") != std::string::npos);
  const std::string other = message(friction("karnopp", "curve = \"table\"\n" + points));
  CHECK(other.find("is for the kinds stribeck, lugre, gms") != std::string::npos);
}

TEST_CASE("measured friction: points in a file are those of lists") {
  const CurveFolder folder;
  const Case lists = read_case(friction("stribeck", "curve = \"table\"\n" + points), "case.toml", {});
  const Case file = folder.read("velocity,force\n0.01,1.0\n0.001,1.2\n");
  CHECK(file.element->values() == lists.element->values());
  REQUIRE(file.curves.size() == 1);
  CHECK(file.curves[0].path == "loop.friction");
  CHECK(file.curves[0].file == "sweep.csv");
  CHECK(file.curves[0].points == 2);
  CHECK(file.curves[0].sha256 == sha256("velocity,force\n0.01,1.0\n0.001,1.2\n"));
  CHECK(lists.curves.empty());
  CHECK(folder.read("0.001 1.2\n0.01 1.0\n").element->values() == lists.element->values());
  const std::string columns = "velocity = \"v [mm/s]\"\nforce = 1\nscale = {velocity = 1e-3, force = -1.0}\n";
  CHECK(folder.read("F;v [mm/s]\n-1,2;1\n-1,0;10\n", columns).element->values() == lists.element->values());
}

TEST_CASE("measured friction: rows with a negative velocity are the other direction") {
  const CurveFolder folder;
  const Case both = folder.read("velocity,force\n-0.02,-0.8\n-0.002,-1.1\n0.001,1.2\n0.01,1.0\n");
  const Case lists = read_case(
      friction("stribeck", "curve = \"table\"\nvelocities_minus = [0.002, 0.02]\nforces_minus = [1.1, 0.8]\n" + points),
      "case.toml", {});
  CHECK(both.element->values() == lists.element->values());
  CHECK(both.curves[0].points == 4);
}

TEST_CASE("measured friction: a file that holds no curve is refused with its row") {
  const CurveFolder folder;
  CHECK_THAT(folder.refusal("velocity,force\n0.0,1.5\n0.1,1.0\n"), Contains("sweep.csv:2") && Contains("is at rest"));
  CHECK_THAT(folder.refusal("velocity,force\n0.1,1.0\n0.2,-1.0\n"),
             Contains("sweep.csv:3") && Contains("sign of the velocity"));
  CHECK_THAT(folder.refusal("velocity,force\n0.1,1.0\n0.1,1.1\n"), Contains("was met before"));
  CHECK_THAT(folder.refusal("velocity,force\n-0.1,-1.0\n"), Contains("no row with a velocity above 0"));
  CHECK_THAT(folder.refusal("v,F\n0.1,1.0\n"), Contains("velocity"));
  CHECK_THAT(folder.refusal("velocity,force\n0.1,nan\n"), Contains("sweep.csv:2"));
  CHECK_THAT(folder.refusal("velocity,force\n0.1,1.0\n", "forces = [1.0]\n"), Contains("stands beside `file`"));
  CHECK_THAT(folder.refusal("velocity,force\n0.1,1.0\n", "scale = {velocity = 0.0}\n"), Contains("must not be 0"));
  CHECK_THAT(message(friction("stribeck", "curve = \"table\"\nfile = \"none.csv\"\nFs = 1.5\n")),
             Contains("no such file"));
}
