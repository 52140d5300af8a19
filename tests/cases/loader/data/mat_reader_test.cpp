#include <matio.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>

#include "limcycle/cases/loader/case.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

/// A variable of a MAT-file, columns after one another.
struct MatVariable {
  std::string name;
  std::size_t rows, columns;
  std::vector<double> real, imaginary = {};
};

/// A folder with a MAT-file, and cases beside it.
class MatFolder {
 public:
  MatFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("limcycle-mat-" + std::to_string(std::hash<const void*>{}(this)))) {
    std::filesystem::create_directories(path_);
  }
  MatFolder(const MatFolder&) = delete;
  MatFolder& operator=(const MatFolder&) = delete;
  ~MatFolder() { std::filesystem::remove_all(path_); }

  void write(const std::vector<MatVariable>& variables, mat_ft version = MAT_FT_MAT5,
             matio_compression packed = MAT_COMPRESSION_ZLIB) const {
    std::filesystem::remove(path_ / "p.mat");
    const std::unique_ptr<mat_t, int (*)(mat_t*)> file(Mat_CreateVer((path_ / "p.mat").c_str(), nullptr, version),
                                                       Mat_Close);
    for (auto one : variables) {
      std::size_t sizes[] = {one.rows, one.columns};
      mat_complex_split_t parts{one.real.data(), one.imaginary.data()};
      const bool complex = !one.imaginary.empty();
      const std::unique_ptr<matvar_t, void (*)(matvar_t*)> made(
          Mat_VarCreate(one.name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes,
                        complex ? static_cast<void*>(&parts) : one.real.data(), complex ? MAT_F_COMPLEX : 0),
          Mat_VarFree);
      REQUIRE(Mat_VarWrite(file.get(), made.get(), packed) == 0);
    }
  }
  void write_bytes(const std::string& bytes) const { std::ofstream(path_ / "p.mat", std::ios::binary) << bytes; }

  Case read(const std::string& plant, const std::vector<std::string>& overrides = {}) const {
    return read_case("[loop.plant]\nfile = \"p.mat\"\n" + plant +
                         "\n[loop.controller]\nkind = \"pid\"\nkp = 3.0\nkd = 6.0\n"
                         "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n",
                     (path_ / "a.toml").string(), overrides);
  }
  std::string refusal(const std::string& plant) const {
    try {
      read(plant);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

 private:
  std::filesystem::path path_;
};

const MatVariable A{"A", 2, 2, {0.0, 0.0, 1.0, -0.4}}, B{"B", 2, 1, {0.0, 2.0}}, C{"C", 1, 2, {1.0, 0.0}};

template <class Kind>
Kind plant_of(const Case& from) {
  return std::get<Kind>(from.loop->plant);
}

}  // namespace

TEST_CASE("mat: matrices of a state space, of every version of the format", "[mat]") {
  const MatFolder folder;
  const auto version = GENERATE(MAT_FT_MAT4, MAT_FT_MAT5, MAT_FT_MAT73);
  folder.write({A, B, C, {"unused", 1, 1, {7.0}}}, version, MAT_COMPRESSION_NONE);
  const Case from = folder.read("kind = \"state-space\"");
  const auto plant = plant_of<StateSpacePlant>(from);
  CHECK(plant.A == (Eigen::MatrixXd(2, 2) << 0.0, 1.0, 0.0, -0.4).finished());
  CHECK(plant.B == Eigen::Vector2d(0.0, 2.0));
  CHECK(plant.C == Eigen::RowVector2d(1.0, 0.0));
  REQUIRE(from.matrices.size() == 1);
  CHECK(from.matrices[0].path == "loop.plant");
  CHECK(from.matrices[0].file == "p.mat");
  CHECK(from.matrices[0].sha256.size() == 64);
  CHECK(from.matrices[0].variables == std::vector<std::string>{"A", "B", "C"});
  REQUIRE(data_of(from).size() == 1);
}

TEST_CASE("mat: packed files, lists as rows and columns, complex poles", "[mat]") {
  const MatFolder folder;
  folder.write({{"numerator", 1, 1, {2.0}}, {"denominator", 3, 1, {1.0, 0.4, 0.0}}});
  const auto fraction = plant_of<TransferFunction>(folder.read("kind = \"transfer-function\""));
  CHECK(fraction.numerator == std::vector{2.0});
  CHECK(fraction.denominator == std::vector{1.0, 0.4, 0.0});
  folder.write({{"poles", 1, 2, {-0.5, -0.5}, {2.0, -2.0}}, {"zeros", 0, 0, {}}});
  const auto poles = plant_of<ZeroPoleGain>(folder.read("kind = \"zpk\"\ngain = 3.0")).poles;
  CHECK(poles == std::vector<std::complex<double>>{{-0.5, 2.0}, {-0.5, -2.0}});
}

TEST_CASE("mat: what the case gives itself is not taken from the file", "[mat]") {
  const MatFolder folder;
  folder.write({A, B, C});
  const Case from = folder.read("kind = \"state-space\"\nB = [[0.0], [5.0]]");
  CHECK(plant_of<StateSpacePlant>(from).B(1, 0) == 5.0);
  CHECK(from.matrices[0].variables == std::vector<std::string>{"A", "C"});
  const Case changed = folder.read("kind = \"state-space\"", {"loop.plant.A=[[0.0, 1.0], [0.0, -9.0]]"});
  CHECK(plant_of<StateSpacePlant>(changed).A(1, 1) == -9.0);
}

TEST_CASE("mat: points of a frequency response, of more rows than a matrix may have", "[mat]") {
  const MatFolder folder;
  MatVariable points{"points", 500, 3, {}};
  points.real.resize(1500);
  for (std::size_t i = 0; i < 500; ++i) {
    const double w = 0.1 * std::pow(1000.0, static_cast<double>(i) / 499.0);
    const std::complex<double> s(0.0, w), G = 1.0 / (s * (2.0 * s + 0.3));
    points.real[i] = w;
    points.real[500 + i] = G.real();
    points.real[1000 + i] = G.imag();
  }
  folder.write({points});
  const Case from = folder.read("kind = \"frf\"\nfrequency = \"rad/s\"\nformat = \"re-im\"");
  CHECK(plant_of<MeasuredPlant>(from).data->size() == 500);
  CHECK(from.matrices.size() == 1);
}

TEST_CASE("mat: what is wrong with a file is said with line and key", "[mat]") {
  const MatFolder folder;
  const std::string state_space = "kind = \"state-space\"";
  CHECK_THAT(folder.refusal(state_space), Contains("a.toml:2: loop.plant.file = \"p.mat\": no such file"));
  folder.write_bytes("MATLAB 5.0 MAT-file, but not really");
  CHECK_THAT(folder.refusal(state_space), Contains("is no MAT-file with variables"));
  folder.write({{"numerator", 1, 1, {1.0}}});
  CHECK_THAT(folder.refusal(state_space),
             Contains("holds none of the variables A, B, C") && Contains("it holds numerator"));
  folder.write({{"A", 2, 2, {0.0, 0.0, 1.0, NAN}}});
  CHECK_THAT(folder.refusal(state_space), Contains("variable A, which has an element that is not finite"));
  folder.write({{"A", 1, 1, {1.0}, {1.0}}});
  CHECK_THAT(folder.refusal(state_space), Contains("variable A, which is complex"));
  folder.write({{"A", 300, 1, std::vector<double>(300, 1.0)}});
  CHECK_THAT(folder.refusal(state_space), Contains("more than 201 rows"));
  folder.write({{"denominator", 2, 2, {1.0, 2.0, 3.0, 4.0}}});
  CHECK_THAT(folder.refusal("kind = \"transfer-function\""), Contains("must be a row or a column"));
  folder.write({A, B});
  CHECK_THAT(folder.refusal(state_space), Contains("loop.plant.C: is required"));
  folder.write({A, B, C});
  CHECK_THAT(folder.refusal("kind = \"mass\"\nmass = 1.0"), Contains("loop.plant.file: unknown key"));
}
