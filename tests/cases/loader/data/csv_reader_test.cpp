#include "limcycle/cases/loader/data/csv_reader.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Rows = std::vector<std::vector<double>>;

namespace {

/// A file of its own in the folder for temporary files.
class TemporaryCsv {
 public:
  explicit TemporaryCsv(const std::string& text)
      : path_((std::filesystem::temp_directory_path() /
               ("limcycle-csv-" + std::to_string(std::hash<std::string>{}(text)) + ".csv"))
                  .string()) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  TemporaryCsv(const TemporaryCsv&) = delete;
  TemporaryCsv& operator=(const TemporaryCsv&) = delete;
  ~TemporaryCsv() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Rows rows_of(const std::string& text, const std::vector<CsvColumn>& columns) {
  const TemporaryCsv file(text);
  CsvReader reader(file.path());
  reader.choose(columns);
  Rows rows;
  for (std::vector<double> row; reader.next(row);) rows.push_back(row);
  return rows;
}

std::string refusal(const std::string& text, const std::vector<CsvColumn>& columns) {
  try {
    rows_of(text, columns);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

const std::vector<CsvColumn> both{std::size_t{1}, std::size_t{2}};

}  // namespace

TEST_CASE("CSV: commas, semicolons, tabs and blanks separate, with any line ends, comments and a byte order mark") {
  const Rows expected{{1.0, -2.5}, {3e-4, 4.0}};
  for (const char* text : {"1,-2.5\n3e-4,4\n", "1;-2.5\r\n3e-4;+4\r\n", "1;-2,5\r\n3e-4;4,0", "1\t-2.5\n3e-4\t4",
                           "1  -2.5\n 3e-4   4 \n", "\xEF\xBB\xBF# comment\n\n% another\n1 , -2.5\n  \n3e-4 , 4\n",
                           "time,force\n1,-2.5\n3e-4,4\n", "\"a, b\",\"c\"\n1,-2.5\n# between\n3e-4,4\n"})
    CHECK(rows_of(text, both) == expected);
}

TEST_CASE("CSV: columns are named by the header or by number, in any order") {
  const std::string text = "time [s];position;force\n0;1;2\n3;4;5\n";
  CHECK(rows_of(text, {std::string("force"), std::size_t{1}}) == Rows{{2.0, 0.0}, {5.0, 3.0}});
  CHECK_THAT(refusal(text, {std::string("forze")}),
             Contains("has no column \"forze\"") && Contains("did you mean force?"));
  CHECK(rows_of(text, {std::string("time")}) == Rows{{0.0}, {3.0}});  // the unit need not be repeated
  CHECK(rows_of("# a rig\n# force (N), time\n1,2\n", {std::string("time")}) == Rows{{2.0}});
  CHECK_THAT(refusal("# force and time\n1,2\n", {std::string("time")}), Contains("has no header"));
  CHECK_THAT(refusal("time,force,force [kN]\n0,1,1\n", {std::string("force")}), Contains("has two columns \"force\""));
  CHECK_THAT(refusal("1,2\n", {std::string("a")}), Contains("has no header: name the column \"a\" by its number"));
  CHECK_THAT(refusal(text, {std::size_t{4}}), Contains("has 3 columns separated by semicolons; column 4 is asked for"));
  CHECK_THAT(refusal("1:2:3\n", both), Contains("has 1 column separated by blanks; column 2 is asked for"));
}

TEST_CASE("CSV: what is no finite number is refused with its line and column") {
  CHECK_THAT(refusal("a,b\n1,2\n3,x\n", both), EndsWith(":3: \"x\" in column 2 (b) is no number"));
  CHECK_THAT(refusal("1,2\n3,nan\n", both), EndsWith(":2: \"nan\" in column 2 is not a finite number"));
  CHECK_THAT(refusal("1,2\n3,1e999\n", both), Contains("is not a finite number"));
  CHECK_THAT(refusal("1,2\n3,\n", both), EndsWith(":2: column 2 is empty"));
  CHECK_THAT(refusal("1;2\n1,234.5;2\n", both), Contains("\"1,234.5\" in column 1 is no number"));
  CHECK_THAT(refusal("1,2\n3,4,5\n", both), EndsWith(":2: has 3 fields, the first row has 2"));
  CHECK(refusal("1,2,x\n3,4,y\n", both).empty());  // a column that is not asked for may hold anything
}

TEST_CASE("CSV: files that are none are refused") {
  CHECK_THAT(refusal("", both), Contains("holds no row of data"));
  CHECK_THAT(refusal("# only a comment\n\n", both), Contains("holds no row of data"));
  CHECK_THAT(refusal(std::string("1,2\n\0,3\n", 8), both), Contains("zero byte"));
  CHECK_THAT(refusal(std::string(70'000, '1'), both), Contains("too long for a row"));
  CHECK_THROWS_WITH(CsvReader("/nowhere/at-all.csv"), EndsWith("/nowhere/at-all.csv: no such file"));
  CHECK_THROWS_WITH(CsvReader(std::filesystem::temp_directory_path().string()), Contains("is a directory"));
}
