#include "limcycle/questions/map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/questions/argument_error.hpp"
#include "limcycle/reports/number.hpp"

namespace limcycle {

Methods map_methods(const std::string& argument, const std::vector<std::string>& names) {
  const auto known = names_of({true, true, true});
  Methods chosen{names.empty(), false, false};
  bool* const switches[] = {&chosen.describing_function, &chosen.composite, &chosen.harmonic_balance};
  for (const auto& name : names) {
    *switches[position_named(argument, name, known, "unknown method")] = true;
  }
  return chosen;
}

MapReport map_over(const Case& from, const MapAxis& x, const MapAxis& y, const Methods& methods,
                   const std::string& dashes) {
  MapReport report;
  report.x_unit = number_at(from, dashes + "x", x.path).unit;
  report.y_unit = number_at(from, dashes + "y", y.path).unit;
  if (x.path == y.path) throw argument_error(dashes + "y", y.path, "must be another parameter than " + dashes + "x");
  HuntingMap& map = report.map;
  map.x = x;
  map.y = y;
  map.methods = names_of(methods);
  need_memory_for(map, {}, dashes);
  return report;
}

void need_memory_for(const HuntingMap& map, const HeldDocuments& held, const std::string& dashes) {
  const auto methods = static_cast<double>(map.methods.size());
  // A point with its row in a sweep, and its part of each document (of JSON: as a tree, and twice as text).
  double bytes = sizeof(map.points[0]) + 8.0 * static_cast<double>(map_columns(map.methods).size()) + 80.0;
  if (held.json) bytes += 1000.0 + 500.0 * methods;
  if (held.csv) bytes += 60.0 + 35.0 * methods;
  need_memory(dashes + "x, " + dashes + "y", static_cast<double>(map.size()), bytes, "fewer points");
}

std::string flags_of(const HuntingMap& map, bool methods, int starts) {
  const auto side = [](const MapAxis& axis) {
    return fmt::format("{}={}:{}:{}{}", axis.path, shortest(axis.from), shortest(axis.to), axis.points,
                       axis.logarithmic ? ":log" : "");
  };
  std::string text = "--x " + side(map.x) + " --y " + side(map.y);
  if (methods) text += fmt::format(" --methods {}", fmt::join(map.methods, ","));
  if (starts > 0) text += fmt::format(" --starts {}", starts);
  return text;
}

PredictOptions map_options(const Case& from, const Methods& methods, const std::function<bool()>& stop) {
  PredictOptions options = from.predict;
  options.methods = methods;
  options.accuracy = std::max(from.predict.accuracy, 1e-6);  // far below the 5 % that matter
  options.stop = stop;
  return options;
}

MapPoint point_of(const HuntingMap& map, std::size_t k, const LoopVariation& variation, const PredictOptions& options) {
  const double values[] = {map.x_of(k), map.y_of(k)};
  if (const auto loop = variation.loop(values)) return map_point(*loop, options);
  MapPoint point;
  point.methods.resize(map.methods.size());
  return point;
}

Status ask_map(const Case& from, HuntingMap& map, const Methods& methods, int starts, const std::string& design,
               const Asking& asking, const SweepRunner& sweep) {
  PredictOptions options = map_options(from, methods, asking.stop);
  if (starts > 0) options.starts = starts;
  const auto columns = map_columns(map.methods);
  const std::string paths[] = {map.x.path, map.y.path};
  const LoopVariation variation(from, "x, y", paths);
  SweepTask task{map.size(), columns.size(), 1, {}};
  task.compute = [&](std::span<const std::size_t> points, std::span<double> rows) -> std::size_t {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const MapPoint point = point_of(map, points[i], variation, options);
      if (asking.stopped()) return i;
      std::ranges::copy(to_row(point), rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    }
    return points.size();
  };
  const SweptRows swept = sweep(task, columns, design);
  map.points.assign(map.size(), std::nullopt);
  for (std::size_t k = 0; k < map.size(); ++k)
    if (swept.known[k])
      map.points[k] =
          point_of_row(std::span(swept.rows).subspan(k * columns.size(), columns.size()), map.methods.size());
  return swept.status;
}

}  // namespace limcycle
