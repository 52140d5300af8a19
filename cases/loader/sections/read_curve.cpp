#include <cmath>
#include <map>

#include "limcycle/cases/loader/data/data_file.hpp"
#include "limcycle/cases/loader/sections/parameters.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"

namespace limcycle::case_file {
namespace {

constexpr std::string_view columns_of_curve[] = {"velocity", "force"};
constexpr const char* points_of_curve[] = {"velocities", "forces", "velocities_minus", "forces_minus"};

using Points = std::map<double, double>;  ///< friction at a speed, both > 0

/// Columns by these names, or the first two of a file without a header.
std::vector<CsvColumn> chosen_columns(const Section& section, const CsvReader& csv) {
  std::vector<CsvColumn> chosen;
  for (std::size_t k = 0; k < std::size(columns_of_curve); ++k) {
    const auto key = section.find(columns_of_curve[k]);
    chosen.push_back(key                    ? read_column(*key)
                     : csv.header().empty() ? CsvColumn(k + 1)
                                            : CsvColumn(std::string(columns_of_curve[k])));
  }
  return chosen;
}

void add(Points& points, const CsvReader& csv, double speed, double force) {
  if (!(speed > 0.0) || !std::isfinite(speed))
    throw csv.error("is at rest: the break-away force is Fs of the case; leave the row out");
  if (!(force > 0.0) || !std::isfinite(force))
    throw csv.error(
        "must have a force with the sign of the velocity, as friction has; scale = {force = -1.0} turns it");
  if (points.size() == longest_list)
    throw csv.error("is one of more than " + std::to_string(longest_list) + " points: average those near each other");
  if (!points.emplace(speed, force).second)
    throw csv.error("has a velocity that was met before: average the forces measured at it");
}

/// The lists of a direction in the place of the file, with its line for messages.
void put(Value::Table& table, const Value& file, const char* speed_key, const char* force_key, const Points& points) {
  Value speeds{Value::List{}, file.line, file.override}, forces = speeds;
  for (const auto& [speed, force] : points) {
    std::get<Value::List>(speeds.data).push_back({speed, file.line, file.override});
    std::get<Value::List>(forces.data).push_back({force, file.line, file.override});
  }
  table.push_back({speed_key, std::move(speeds)});
  table.push_back({force_key, std::move(forces)});
}

CurveFile read_curve(const Document& document, Value& law, const std::string& path) {
  const Section section(document, law, path);
  for (const char* key : points_of_curve)
    if (const auto place = section.find(key))
      throw place->error("stands beside `file`, which holds the points: leave one of them out");
  const Place file_key = section.at("file", "");
  const Value file_value = file_key.value;
  const std::string file = read_string(file_key);
  DataFile opened(section, file);
  CsvReader& csv = opened.csv;
  const auto scale = section.section("scale");
  if (scale) scale->allow({"velocity", "force"});
  const double per_velocity = read_scale(scale, "velocity"), per_force = read_scale(scale, "force");
  csv.choose(chosen_columns(section, csv));
  Points forward, backward;
  for (std::vector<double> row; csv.next(row);) {
    const double v = per_velocity * row[0], force = per_force * row[1];
    add(v < 0.0 ? backward : forward, csv, std::abs(v), v < 0.0 ? -force : force);
  }
  if (forward.empty()) throw csv.error("is the last line, and no row with a velocity above 0 was met");
  auto& table = std::get<Value::Table>(law.data);
  std::erase_if(table, [](const Value::Entry& entry) {
    return entry.key == "file" || entry.key == "velocity" || entry.key == "force" || entry.key == "scale";
  });
  put(table, file_value, "velocities", "forces", forward);
  if (!backward.empty()) put(table, file_value, "velocities_minus", "forces_minus", backward);
  return {path, file, opened.sha256, forward.size() + backward.size()};
}

/// True for a law over measured points that stand in a file.
bool is_in_file(const Value& law) {
  const auto *curve = law.text("curve"), *kind = law.text("kind");
  return law.find("file") != nullptr &&
         ((curve != nullptr && *curve == "table") || (kind != nullptr && kind->ends_with("-table")));
}

}  // namespace

std::vector<CurveFile> read_curves(Document& document) {
  std::vector<CurveFile> files;
  for_each_part(document, [&](Value& part, const std::string& path) {
    if (is_in_file(part)) files.push_back(read_curve(document, part, path));
  });
  return files;
}

}  // namespace limcycle::case_file
