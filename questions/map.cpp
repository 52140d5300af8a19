#include "limcycle/questions/map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "limcycle/analysis/study/map/simulated_points.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/questions/asking/argument_error.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {

namespace {

/// Empty where the values of the point are no valid case.
std::optional<Loop> loop_at(const HuntingMap& map, std::size_t k, const LoopVariation& variation) {
  const double values[] = {map.x_of(k), map.y_of(k)};
  return variation.loop(values);
}

}  // namespace

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
  if (map.methods.empty())
    text += " --outcomes";
  else if (methods)
    text += fmt::format(" --methods {}", fmt::join(map.methods, ","));
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
  if (const auto loop = loop_at(map, k, variation)) return map_point(*loop, options);
  MapPoint point;
  point.methods.resize(map.methods.size());
  return point;
}

namespace {

/// Points of one piece of work: with outcomes only, as many as fill the lanes, if the loop can be marched in them.
std::size_t points_at_once(const Case& from, const HuntingMap& map) {
  return map.methods.empty() && fits_lanes(build_loop(need_loop(from))) ? 32 : 1;
}

/// The points one by one, up to the one that was interrupted.
std::vector<MapPoint> judged_points(const HuntingMap& map, std::span<const std::size_t> points,
                                    const LoopVariation& variation, const PredictOptions& options) {
  std::vector<MapPoint> found;
  found.reserve(points.size());
  for (const std::size_t k : points) {
    MapPoint point = point_of(map, k, variation, options);
    if (options.stop && options.stop()) break;
    found.push_back(std::move(point));
  }
  return found;
}

std::vector<std::optional<Loop>> loops_of(const HuntingMap& map, std::span<const std::size_t> points,
                                          const LoopVariation& variation) {
  std::vector<std::optional<Loop>> loops;
  loops.reserve(points.size());
  for (const std::size_t k : points) loops.push_back(loop_at(map, k, variation));
  return loops;
}

}  // namespace

Status ask_map(const Case& from, HuntingMap& map, const Methods& methods, int starts, const std::string& design,
               const Asking& asking, const SweepRunner& sweep) {
  PredictOptions options = map_options(from, methods, asking.stop);
  if (starts > 0) options.starts = starts;
  const auto columns = map_columns(map.methods);
  const std::string paths[] = {map.x.path, map.y.path};
  const LoopVariation variation(from, "x, y", paths);
  const bool judged = !map.methods.empty();
  SweepTask task{map.size(), columns.size(), points_at_once(from, map), {}};
  const auto points_of = [&](std::span<const std::size_t> points) {
    return judged ? judged_points(map, points, variation, options)
                  : simulated_points(loops_of(map, points, variation), {options, asking.isa});
  };
  task.compute = [&](std::span<const std::size_t> points, std::span<double> rows) {
    const auto found = points_of(points);
    for (std::size_t i = 0; i < found.size(); ++i)
      std::ranges::copy(to_row(found[i]), rows.begin() + static_cast<std::ptrdiff_t>(i * columns.size()));
    return found.size();
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
