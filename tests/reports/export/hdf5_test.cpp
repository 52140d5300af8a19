#include "limcycle/reports/export/hdf5.hpp"

#include <hdf5.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

using namespace limcycle;

namespace {

/// An HDF5 file in memory, read by the library that others read it with.
class ReadBack {
 public:
  explicit ReadBack(const std::string& json) : bytes_(hdf5_document(json)) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 16, false);
    H5Pset_file_image(access, bytes_.data(), bytes_.size());
    file_ = H5Fopen("read-back.h5", H5F_ACC_RDONLY, access);
    H5Pclose(access);
    REQUIRE(file_ >= 0);
  }
  ~ReadBack() { H5Fclose(file_); }
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;

  const std::string& bytes() const { return bytes_; }

  std::vector<hsize_t> shape(const std::string& name) const {
    const hid_t data = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), space = H5Dget_space(data);
    REQUIRE(data >= 0);
    std::vector<hsize_t> sizes(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
    H5Sclose(space);
    H5Dclose(data);
    return sizes;
  }
  std::vector<double> numbers(const std::string& name) const {
    const hid_t data = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    REQUIRE(data >= 0);
    const hid_t type = H5Dget_type(data);
    CHECK(H5Tequal(type, H5T_IEEE_F64LE) > 0);
    std::vector<double> values(points_of(data));
    CHECK((values.empty() || H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0));
    H5Tclose(type);
    H5Dclose(data);
    return values;
  }
  std::vector<std::string> texts(const std::string& name) const {
    const hid_t data = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    REQUIRE(data >= 0);
    const hid_t type = H5Dget_type(data);
    REQUIRE(H5Tget_class(type) == H5T_STRING);
    const std::size_t size = H5Tget_size(type), count = points_of(data);
    std::string all(size * count, '\0');
    CHECK(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) >= 0);
    std::vector<std::string> list;
    for (std::size_t i = 0; i < count; ++i) list.emplace_back(all.substr(i * size, size).c_str());
    H5Tclose(type);
    H5Dclose(data);
    return list;
  }
  std::uint64_t rows(const std::string& group) const {
    std::uint64_t count = 99;
    const hid_t attribute = H5Aopen_by_name(file_, group.c_str(), "rows", H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(attribute >= 0);
    H5Aread(attribute, H5T_NATIVE_UINT64, &count);
    H5Aclose(attribute);
    return count;
  }
  bool has(const std::string& name) const { return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0; }
  hid_t file() const { return file_; }

 private:
  static std::size_t points_of(hid_t data) {
    const hid_t space = H5Dget_space(data);
    const auto count = H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    return static_cast<std::size_t>(count);
  }
  std::string bytes_;
  hid_t file_;
};

using Sizes = std::vector<hsize_t>;

}  // namespace

TEST_CASE("hdf5: numbers, yes and no, nothing and texts of an object", "[hdf5]") {
  const ReadBack file(R"({"a": 0.1, "n": 3, "yes": true, "no": false, "none": null, "text": "servo", "empty": "",
                          "accented": "Größe", "inner": {"b": -1e-300}})");
  CHECK(file.numbers("a") == std::vector{0.1});
  CHECK(file.shape("a").empty());
  CHECK(file.numbers("n") == std::vector{3.0});
  CHECK(file.numbers("yes") == std::vector{1.0});
  CHECK(file.numbers("no") == std::vector{0.0});
  CHECK(std::isnan(file.numbers("none").at(0)));
  CHECK(file.texts("text") == std::vector<std::string>{"servo"});
  CHECK(file.texts("empty") == std::vector<std::string>{""});
  CHECK(file.texts("accented") == std::vector<std::string>{"Größe"});
  CHECK(file.numbers("inner/b") == std::vector{-1e-300});
}

TEST_CASE("hdf5: a list of objects is a group of columns", "[hdf5]") {
  const ReadBack file(R"({"cycles": [
    {"period": 1.5, "stable": true, "why": "a", "multipliers": [[0.5, 0.0], [0.25, 1.0]], "trust": null},
    {"period": null, "stable": null, "why": null, "multipliers": [[0.75, 0.0]], "trust": {"ratio": 2.0, "by": "xyz"}},
    {"stable": false, "why": "longer", "multipliers": [], "trust": null}]})");
  CHECK(file.rows("cycles") == 3);
  const auto period = file.numbers("cycles/period");
  CHECK(period[0] == 1.5);
  CHECK((std::isnan(period[1]) && std::isnan(period[2])));
  const auto stable = file.numbers("cycles/stable");
  CHECK((stable[0] == 1.0 && std::isnan(stable[1]) && stable[2] == 0.0));
  CHECK(file.texts("cycles/why") == std::vector<std::string>{"a", "", "longer"});
  CHECK(file.shape("cycles/multipliers") == Sizes{3, 2, 2});
  const auto multipliers = file.numbers("cycles/multipliers");
  CHECK(multipliers[0] == 0.5);
  CHECK(multipliers[3] == 1.0);
  CHECK(multipliers[4] == 0.75);
  CHECK((std::isnan(multipliers[6]) && std::isnan(multipliers[8]) && std::isnan(multipliers[11])));
  CHECK(std::isnan(file.numbers("cycles/trust/ratio").at(0)));
  CHECK(file.numbers("cycles/trust/ratio").at(1) == 2.0);
  CHECK(file.texts("cycles/trust/by") == std::vector<std::string>{"", "xyz", ""});
}

TEST_CASE("hdf5: lists of numbers and texts, of any depth, and lists of objects in rows", "[hdf5]") {
  const ReadBack file(R"({"list": [1, 2, null], "rows": [[1, 2], [3], []], "words": ["a", null, "ccc"], "empty": [],
    "deep": [[[1, 2], [3, 4]], [[5, 6], [7, 8]]], "mixed": [1, "two"], "texts": [["a", "b"], ["c"]],
    "laws": [{"kind": "x", "numbers": [{"v": 1.0}, {"v": 2.0}]}, {"kind": "y", "numbers": []}]})");
  CHECK(file.shape("list") == Sizes{3});
  CHECK(file.shape("rows") == Sizes{3, 2});
  CHECK(file.numbers("rows")[2] == 3.0);
  CHECK(file.texts("words") == std::vector<std::string>{"a", "", "ccc"});
  CHECK(file.shape("empty") == Sizes{0});
  CHECK(file.shape("deep") == Sizes{2, 2, 2});
  CHECK(file.numbers("deep") == std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8});
  CHECK(file.texts("mixed") == std::vector<std::string>{"1", "two"});
  CHECK(file.texts("texts/0") == std::vector<std::string>{"a", "b"});
  CHECK(file.texts("texts/1") == std::vector<std::string>{"c", ""});
  CHECK(file.texts("laws/kind") == std::vector<std::string>{"x", "y"});
  CHECK(file.numbers("laws/numbers/0/v") == std::vector<double>{1.0, 2.0});
  CHECK(file.rows("laws/numbers/1") == 0);
}

TEST_CASE("hdf5: all bits of a seed, any name, the order of the document, the same bytes each time", "[hdf5]") {
  const std::string json = R"({"z": 1, "a": {"seed": 18446744073709551615}, "m": {"per/second": 2.0, "": 3.0}})";
  const ReadBack file(json);
  std::uint64_t seed = 0;
  const hid_t data = H5Dopen2(file.file(), "a/seed", H5P_DEFAULT);
  H5Dread(data, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &seed);
  H5Dclose(data);
  CHECK(seed == 18446744073709551615ULL);
  CHECK(file.numbers("m/per_second") == std::vector{2.0});
  CHECK(file.has("m/_"));
  char name[8] = {};
  H5Lget_name_by_idx(file.file(), ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, 0, name, sizeof name, H5P_DEFAULT);
  CHECK(std::string(name) == "z");
  CHECK(hdf5_document(json) == file.bytes());
}

TEST_CASE("hdf5: what is no object is refused", "[hdf5]") {
  CHECK_THROWS_AS(hdf5_document("[1, 2]"), std::invalid_argument);
  CHECK_THROWS_AS(hdf5_document("{\"a\": "), std::invalid_argument);
}
