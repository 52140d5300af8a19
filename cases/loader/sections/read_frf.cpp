#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "limcycle/cases/loader/data/data_file.hpp"
#include "limcycle/cases/loader/sections/parameters.hpp"
#include "limcycle/models/measured/measured_plant.hpp"

namespace limcycle::case_file {
namespace {

/// Rows of a file, or those of the case.
class FrequencyRows {
 public:
  explicit FrequencyRows(CsvReader& csv) : csv_(&csv) {}
  explicit FrequencyRows(Place points) : points_(std::move(points)) {}

  bool next(std::vector<double>& row) {
    if (csv_ != nullptr) return csv_->next(row);
    const auto& rows = *points_->value.as<Value::List>();
    if (next_ == rows.size()) return false;
    row = read_list(points_->item(next_++), longest_list);
    return true;
  }
  InputError error(const std::string& rule, const std::string& value = {}) const {
    if (csv_ != nullptr) return csv_->error(rule, value);
    return points_->item(next_ - 1).error(rule);
  }

 private:
  CsvReader* csv_ = nullptr;
  std::optional<Place> points_;
  std::size_t next_ = 0;
};

bool has_uncertainty(const MeasuredPlant& plant) { return plant.uncertainty.index > 0; }

/// Which columns of the file are read.
using Columns = std::vector<CsvColumn>;

Columns columns_of(const Section& section, const MeasuredPlant& plant) {
  Columns columns;
  const std::size_t count = has_uncertainty(plant) ? 4 : 3;
  if (!plant.columns.empty() && plant.columns.size() != count)
    throw section.error("columns", fmt::format("must be {} numbers{}", count,
                                               has_uncertainty(plant) ? ", the last that of the uncertainty" : ""));
  for (std::size_t i = 0; i < count; ++i) {
    const double number = plant.columns.empty() ? static_cast<double>(i + 1) : plant.columns[i];
    if (number != std::floor(number) || number > 1e6) throw section.error("columns", "must be whole numbers from 1");
    columns.emplace_back(static_cast<std::size_t>(number));
  }
  return columns;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Throws if the header names another unit than the case.
void check_header(const CsvReader& csv, const Columns& columns, const MeasuredPlant& plant) {
  if (csv.header().empty()) return;
  const auto has = [&](std::size_t i, std::string_view word) {
    const std::string& name = csv.header()[std::get<std::size_t>(columns[i]) - 1];
    return lower(name).find(word) != std::string::npos;
  };
  const auto refuse = [&](std::size_t i, const std::string& key, std::string_view written) {
    const std::string& name = csv.header()[std::get<std::size_t>(columns[i]) - 1];
    throw csv.error(
        fmt::format("is the name of a column that the case reads with {} = \"{}\"; change one of them", key, written),
        name);
  };
  const auto frequency = MeasuredPlant::frequencies[static_cast<std::size_t>(plant.frequency.index)];
  const auto format = MeasuredPlant::formats[static_cast<std::size_t>(plant.format.index)];
  if (has(0, plant.frequency.index == 0 ? "hz" : "rad")) refuse(0, "frequency", frequency);
  if (plant.format.index != 2 && (has(1, "db") || has(1, "decibel"))) refuse(1, "format", format);
  if (plant.format.index == 2 && has(1, "real")) refuse(1, "format", format);
  if (plant.format.index == 0 && (has(1, "mag") || has(2, "phase") || has(2, "deg"))) refuse(2, "format", format);
  if (plant.format.index != 0 && (has(2, "rad") || has(2, "imag"))) refuse(2, "format", format);
}

std::complex<double> response_in(const FrequencyRows& rows, const MeasuredPlant& plant, double first, double second) {
  if (plant.format.index == 0) {
    if (first == 0.0 && second == 0.0) throw rows.error("has the response 0: leave the row out");
    return {first, second};
  }
  if (plant.format.index == 1 && !(first > 0.0))
    throw rows.error("must be > 0: it is a magnitude. Is it in decibels? Then format = \"decibel-degrees\"",
                     fmt::format("{}", first));
  const double size = plant.format.index == 1 ? first : std::pow(10.0, first / 20.0);
  if (!(size > 0.0) || !std::isfinite(size))
    throw rows.error("decibels are beyond what a number holds: is it a magnitude? Then format = \"magnitude-degrees\"",
                     fmt::format("{}", first));
  return std::polar(size, second * std::numbers::pi / 180.0);
}

/// Relative standard deviation of real and imaginary part. Of a coherence c after n averages:
/// ((1 - c)/(2 n c))^(1/2) (Bendat and Piersol, Random Data, 4th ed. 2010, 9.2.4).
double deviation_in(const FrequencyRows& rows, const MeasuredPlant& plant, double size, double value) {
  if (plant.uncertainty.index == 1) {
    if (!(value >= 0.0)) throw rows.error("must be >= 0: it is a standard deviation", fmt::format("{}", value));
    return value / size;
  }
  if (!(value > 0.0 && value <= 1.0))
    throw rows.error("must be > 0 and <= 1: it is a coherence", fmt::format("{}", value));
  return std::sqrt((1.0 - value) / (2.0 * plant.averages * value));
}

void check_rising(const FrequencyRows& rows, const FrequencyData& data, double frequency) {
  if (!(frequency > 0.0))
    throw rows.error("must be > 0: it is a frequency; leave the row at zero out", fmt::format("{}", frequency));
  if (!data.frequency.empty() && !(frequency > data.frequency.back()))
    throw rows.error(
        "must be more than the frequency of the row before: sort the rows, and leave out those that are twice "
        "there",
        fmt::format("{}", frequency));
}

/// Phases within one turn in radians, behind a magnitude that falls: degrees would turn by tens there.
void check_degrees(const FrequencyRows& rows, const MeasuredPlant& plant, const FrequencyData& data,
                   double largest_phase) {
  const EndSlopes slopes = end_slopes(data);
  if (plant.format.index == 0 || largest_phase > 2.02 * std::numbers::pi || std::min(slopes.low, slopes.high) > -0.75)
    return;
  throw rows.error(fmt::format(
      "all phases lie within {:.3g}, although the response falls by {:.2g} decades a decade: are they in radians? "
      "They must be in degrees (or format = \"re-im\")",
      largest_phase, -std::min(slopes.low, slopes.high)));
}

FrequencyData data_in(FrequencyRows rows, const MeasuredPlant& plant) {
  FrequencyData data;
  double largest_phase = 0.0;
  for (std::vector<double> row; rows.next(row);) {
    const double frequency = plant.frequency.index == 0 ? row[0] : 2.0 * std::numbers::pi * row[0];
    check_rising(rows, data, frequency);
    if (data.size() == longest_data)
      throw rows.error(fmt::format("is one of more than {} points: keep every n-th", longest_data));
    data.frequency.push_back(frequency);
    data.response.push_back(response_in(rows, plant, row[1], row[2]));
    largest_phase = std::max(largest_phase, std::abs(row[2]));
    if (has_uncertainty(plant))
      data.deviation.push_back(deviation_in(rows, plant, std::abs(data.response.back()), row[3]));
  }
  check_degrees(rows, plant, data, largest_phase);
  return data;
}

FrequencyData data_of_file(const Section& section, const MeasuredPlant& plant) {
  const Columns columns = columns_of(section, plant);
  DataFile opened(section, plant.file);
  opened.csv.choose(columns);
  check_header(opened.csv, columns, plant);
  FrequencyData data = data_in(FrequencyRows(opened.csv), plant);
  data.file = plant.file;
  data.sha256 = std::move(opened.sha256);
  return data;
}

FrequencyData data_of_points(const Section& section, const MeasuredPlant& plant) {
  FrequencyData data = data_in(FrequencyRows(section.at(points_of_data, "rows of the data")), plant);
  data.file = "the case";
  return data;
}

}  // namespace

void complete(const Section& section, MeasuredPlant& plant) {
  if (plant.validate()) return;  // reported by whoever reads the plant
  plant.data = std::make_shared<const FrequencyData>(plant.file.empty() ? data_of_points(section, plant)
                                                                        : data_of_file(section, plant));
  try {
    plant.response = plant.measured();
  } catch (const std::invalid_argument&) {  // reported by validate()
  }
}

}  // namespace limcycle::case_file
