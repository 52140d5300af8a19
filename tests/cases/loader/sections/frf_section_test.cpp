#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>

#include "limcycle/models/measured/plants_of_loop.hpp"
#include "limcycle/tests/cases/message.hpp"
#include "limcycle/tests/measured.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Complex = std::complex<double>;

namespace {

/// A folder with a file of data, and cases beside it.
class FrfFolder {
 public:
  FrfFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("limcycle-frf-" + std::to_string(std::hash<const void*>{}(this)))) {
    std::filesystem::create_directories(path_);
  }
  FrfFolder(const FrfFolder&) = delete;
  FrfFolder& operator=(const FrfFolder&) = delete;
  ~FrfFolder() { std::filesystem::remove_all(path_); }

  void write(const std::string& text) const { std::ofstream(path_ / "d.csv", std::ios::binary) << text; }

  Case read(const std::string& keys) const {
    return read_case(
        "[loop.plant]\nkind = \"frf\"\nfile = \"d.csv\"\n" + keys +
            "\n[loop.controller]\nkind = \"pid\"\nkp = 3.0\nkd = 6.0\n[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n",
        (path_ / "a.toml").string());
  }
  std::string refusal(const std::string& keys) const {
    try {
      read(keys);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

 private:
  std::filesystem::path path_;
};

using Row = std::function<std::string(double w, Complex G)>;

Complex mass(Complex s) { return 1.0 / (s * (2.0 * s + 0.3)); }

std::string rows(const Row& row, int points = 60) {
  std::string text;
  const FrequencyData data = limcycle::test::sampled_response(mass, 0.1, 100.0, points);
  for (std::size_t i = 0; i < data.size(); ++i) text += row(data.frequency[i], data.response[i]) + "\n";
  return text;
}

double degrees(Complex G) { return std::arg(G) * 180.0 / std::numbers::pi; }

const std::string in_rad = "frequency = \"rad/s\"\n";

std::string re_im(double w, Complex G) { return fmt::format("{},{},{}", w, G.real(), G.imag()); }

}  // namespace

TEST_CASE("frf: units and formats of the data give the same plant") {
  const FrfFolder folder;
  const auto check = [&](const std::string& text, const std::string& keys) {
    folder.write(text);
    const Case from = folder.read(keys);
    const auto plants = measured_plants(*from.loop);
    REQUIRE(plants.size() == 1);
    CHECK(plants[0].path == "loop.plant");
    const auto& data = plants[0].response->data();
    REQUIRE(data.size() == 60);
    CHECK(data.sha256 == sha256(text));
    for (std::size_t i = 0; i < data.size(); ++i)
      CHECK(std::abs(data.response[i] / mass({0.0, data.frequency[i]}) - 1.0) < 1e-9);
    CHECK(plants[0].response->fit().shape.order == 2);
    CHECK(plants[0].response->fit().shape.poles_at_zero == 1);
  };
  check(rows(re_im), in_rad + "format = \"re-im\"");
  check("w (rad/s),real,imag\n" + rows(re_im), in_rad + "format = \"re-im\"");
  check(rows([](double w, Complex G) {
          return fmt::format("{};{};{}", w / (2.0 * std::numbers::pi), std::abs(G), degrees(G));
        }),
        "frequency = \"Hz\"\nformat = \"magnitude-degrees\"");
  check(rows([](double w, Complex G) {
          return fmt::format("{}\t{}\t{}", w, 20.0 * std::log10(std::abs(G)), degrees(G) - 360.0);
        }),
        in_rad + "format = \"decibel-degrees\"");
  check(rows([](double w, Complex G) { return fmt::format("{} {} 7 {}", G.imag(), w, G.real()); }),
        in_rad + "format = \"re-im\"\ncolumns = [2, 4, 1]");
}

TEST_CASE("frf: every key is checked for its type and range, and those that are required are asked for") {
  const FrfFolder folder;
  folder.write(rows(re_im));
  const std::string required = in_rad + "format = \"re-im\"\n";
  REQUIRE(folder.refusal(required).empty());
  CHECK_THAT(folder.refusal(in_rad), Contains("loop.plant.format: is required"));
  CHECK_THAT(folder.refusal("format = \"re-im\""), Contains("loop.plant.frequency: is required"));
  CHECK_THAT(folder.refusal(required + "ordr = 2"), Contains("unknown key") && Contains("did you mean order?"));
  for (const auto& row : MeasuredPlant::parameters()) {
    if (row.required || row.key == "file") continue;
    INFO(row.key);
    const std::string key(row.key);
    CHECK_THAT(folder.refusal(required + key + " = 1979-05-27"),
               Contains("loop.plant." + key) && Contains("must be a"));
    if (!row.choices.empty())
      CHECK_THAT(folder.refusal(required + key + " = \"nonsense\""), Contains("must be one of"));
    else
      CHECK_THAT(folder.refusal(required + key + " = \"nonsense\""), Contains("found a string"));
    if (row.range.low == 0.0 && key != "columns")
      CHECK_THAT(folder.refusal(required + key + " = -1.0"), Contains("must be >= 0"));
  }
  CHECK_THAT(folder.refusal(required + "gain = 0.0"), Contains("must not be zero"));
  CHECK_THAT(folder.refusal(required + "columns = [1, 2, 0]"),
             Contains("loop.plant.columns") && Contains("must be > 0"));
  CHECK_THAT(folder.refusal(required + "columns = [1, 2, 2.5]"), Contains("must be whole numbers"));
  const Case from =
      folder.read(required + "gain = -2.0\norder = 4\npoles_at_zero = \"one\"\nrelative_degree = \"two\"");
  const auto& plant = std::get<MeasuredPlant>(from.loop->plant);
  CHECK(plant.gain == -2.0);
  CHECK(plant.wish() == FitWish{4, 1, 2});
}

TEST_CASE("frf: what the fourth column says of the uncertainty is taken") {
  const FrfFolder folder;
  folder.write(rows([](double w, Complex G) { return re_im(w, G) + fmt::format(",{}", 0.02 * std::abs(G)); }));
  const std::string keys = in_rad + "format = \"re-im\"\n";
  const auto deviation = [&](const std::string& more) {
    return measured_plants(*folder.read(keys + more).loop)[0].response->data().deviation;
  };
  CHECK(deviation("").empty());
  CHECK(deviation("uncertainty = \"standard-deviation\"").at(7) == Approx(0.02));
  folder.write(rows([](double w, Complex G) { return re_im(w, G) + ",0.8"; }));
  CHECK(deviation("uncertainty = \"coherence\"\naverages = 8").at(7) == Approx(std::sqrt(0.2 / (16.0 * 0.8))));
  CHECK_THAT(folder.refusal(keys + "uncertainty = \"coherence\""),
             Contains("loop.plant.averages = 0 (by default): must be at least 1"));
  folder.write(rows([](double w, Complex G) { return re_im(w, G) + ",1.2"; }));
  CHECK_THAT(folder.refusal(keys + "uncertainty = \"coherence\"\naverages = 8"),
             Contains("d.csv:1: \"1.2\" must be > 0 and <= 1"));
}

TEST_CASE("frf: bad data are refused with file and row") {
  const FrfFolder folder;
  const std::string keys = in_rad + "format = \"re-im\"", polar = in_rad + "format = \"magnitude-degrees\"";
  const auto refusal = [&](const std::string& text, const std::string& with) {
    folder.write(text);
    return folder.refusal(with);
  };
  CHECK_THAT(refusal("1,0.1,0.2\n3,0.1,0.2\n2,0.1,0.2\n", keys),
             Contains("d.csv:3: \"2\" must be more than the frequency"));
  CHECK_THAT(refusal("1,0.1,0.2\n1,0.1,0.2\n", keys), Contains("d.csv:2:"));
  CHECK_THAT(refusal("0,0.1,0.2\n1,0.1,0.2\n", keys), Contains("d.csv:1: \"0\" must be > 0"));
  CHECK_THAT(refusal("1,0.1,nan\n", keys), Contains("d.csv:1: \"nan\" in column 3 is not a finite number"));
  CHECK_THAT(refusal("1,0,0\n", keys), Contains("has the response 0"));
  CHECK_THAT(refusal("1,0.1,0.2\n", keys), Contains("a.toml:3: loop.plant.file = \"d.csv\": holds 1 point: too few"));
  CHECK_THAT(refusal("1:0.1:0.2\n2:0.1:0.2\n", keys), Contains("has 1 column separated by blanks"));
  const std::string decibels =
      rows([](double w, Complex G) { return fmt::format("{},{},{}", w, 20.0 * std::log10(std::abs(G)), degrees(G)); });
  CHECK_THAT(refusal(decibels, polar), Contains("is it in decibels?") || Contains("Is it in decibels?"));
  const std::string radians =
      rows([](double w, Complex G) { return fmt::format("{},{},{}", w, std::abs(G), std::arg(G)); });
  CHECK_THAT(refusal(radians, polar), Contains("are they in radians?"));
  CHECK_THAT(refusal("f [Hz],re,im\n" + rows(re_im), keys), Contains("d.csv:1: \"f [Hz]\" is the name of a column"));
  CHECK_THAT(refusal("w,mag,phase\n" + rows(re_im), keys), Contains("format = \"re-im\""));
  CHECK_THAT(folder.refusal(keys + "\ncolumns = [1, 2]"),
             Contains("loop.plant.columns") && Contains("must be 3 numbers"));
  CHECK_THAT(folder.refusal(keys + "\norder = 41"), Contains("loop.plant.order"));
  CHECK_THAT(limcycle::test::message("[loop.plant]\nkind = \"frf\"\nfile = \"no.csv\"\nfrequency = \"Hz\"\nformat = "
                                     "\"re-im\"\n[loop.friction]\nkind = \"coulomb\"\nFc = 1\n"),
             Contains("loop.plant.file = \"no.csv\": no such file: "));
}

TEST_CASE("frf: rows in the case in the place of a file", "[frf]") {
  const FrfFolder folder;
  folder.write(rows([](double w, Complex G) { return fmt::format("{},{},{}", w, G.real(), G.imag()); }));
  const auto of_file = measured_plants(*folder.read("frequency = \"rad/s\"\nformat = \"re-im\"").loop)[0].response;
  const std::string list =
      rows([](double w, Complex G) { return fmt::format("[{}, {}, {}],", w, G.real(), G.imag()); });
  const auto with_plant = [](const std::string& keys) {
    return "[loop.plant]\nkind = \"frf\"\nfrequency = \"rad/s\"\nformat = \"re-im\"\n" + keys +
           "\n[loop.controller]\nkind = \"pid\"\nkp = 3.0\nkd = 6.0\n"
           "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n";
  };
  const Case from = read_case(with_plant("points = [" + list + "]"), "a.toml");
  const auto of_points = measured_plants(*from.loop)[0].response;
  CHECK(of_points->data().frequency == of_file->data().frequency);
  CHECK(of_points->data().response == of_file->data().response);
  CHECK(of_points->fit_in_words() == of_file->fit_in_words());
  CHECK_THAT(basis_in_words(measured_plants(*from.loop)[0]), Contains("in the case"));
  CHECK(data_of(from).empty());

  const auto refused = [&](const std::string& keys) { return limcycle::test::message(with_plant(keys)); };
  CHECK_THAT(refused(""), Contains("loop.plant.file") && Contains("or their rows as points"));
  CHECK_THAT(refused("file = \"d.csv\"\npoints = [[1.0, 1.0, 0.0]]"), Contains("stands beside `file`"));
  CHECK_THAT(refused("points = [[1.0, 1.0]]"), Contains("must have 3 numbers a row"));
  CHECK_THAT(refused("columns = [1, 2, 3]\npoints = [[1.0, 1.0, 0.0]]"), Contains("loop.plant.columns"));
  CHECK_THAT(
      refused("points = [[1.0, 1.0, 0.0], [0.5, 1.0, 0.0]]"),
      Contains("a.toml:5: loop.plant.points[1]") && Contains("must be more than the frequency of the row before"));
}
