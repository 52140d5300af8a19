#include "limcycle/cli/map_of.hpp"

#include <algorithm>
#include <stdexcept>

#include "limcycle/analysis/study/map/hunting_map.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/need_memory.hpp"
#include "limcycle/cli/parameter_range.hpp"

namespace limcycle {

MapReport map_of(const Case& from, const std::string& x, const std::string& y, const Methods& methods) {
  MapReport report;
  report.map.x = map_axis("--x", x);
  report.map.y = map_axis("--y", y);
  report.x_unit = number_at(from, "--x", report.map.x.path).unit;
  report.y_unit = number_at(from, "--y", report.map.y.path).unit;
  if (report.map.x.path == report.map.y.path) throw std::invalid_argument("--x and --y name the same parameter");
  report.map.methods = names_of(methods);
  // Size of a point with its row in a sweep; documents need more.
  const double rows = 8.0 * static_cast<double>(map_columns(report.map.methods).size());
  need_memory("--x, --y", static_cast<double>(report.map.size()), sizeof(report.map.points[0]) + rows + 80.0,
              "fewer points");
  report.map.points.resize(report.map.size());
  return report;
}

PredictOptions map_options(const Case& from, const Methods& methods) {
  PredictOptions options = from.predict;
  options.methods = methods;
  options.accuracy = std::max(from.predict.accuracy, 1e-6);  // far below the 5 % that matter
  options.stop = interrupted;
  return options;
}

MapPoint point_of(const HuntingMap& map, std::size_t k, const LoopVariation& variation, const PredictOptions& options) {
  const double values[] = {map.x_of(k), map.y_of(k)};
  if (const auto loop = variation.loop(values)) return map_point(*loop, options);
  MapPoint point;
  point.methods.resize(map.methods.size());
  return point;
}

}  // namespace limcycle
