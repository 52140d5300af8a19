#pragma once
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Values of one parameter along one side of a map.
struct MapAxis {
  std::string path;  ///< "loop.controller.kd"
  double from = 0.0, to = 0.0;
  int points = 2;
  bool logarithmic = false;

  /// Value i of 0..points-1, evenly spaced between the ends, which are exact. Throws std::out_of_range.
  double value(int i) const;
};

/// Verdict on the answer of a method at a point. A method that predicts nothing where nothing oscillates is right.
enum class Worth { right, biased, missed, wrong, undecided, not_applicable };  // "wrong" is printed "false"
std::string_view to_string(Worth worth);

/// Verdict on one method at a point of a map.
struct MethodAtPoint {
  Worth worth = Worth::not_applicable;
  double amplitude = NAN;  ///< predicted over true, of y's first harmonic, at the prediction nearest to a cycle; or NaN
  double frequency = NAN;  ///< likewise
};

/// The same for the prediction nearest to its cycle. Predicting nothing is right only if every start was decided.
MethodAtPoint method_at(const std::string& method, const PredictReport& report);

/// Behaviour at one point of a map.
struct MapPoint {
  std::vector<Outcome> outcomes;  ///< outcomes of the motions, each once; none: the values are not a valid case
  int cycles = 0, stable = 0;     ///< distinct limit cycles, and the number of stable ones
  double amplitude = NAN;         ///< of the stable cycle with the largest swing; NaN without one
  double period = NAN;            ///< of the same, s
  std::vector<MethodAtPoint> methods;

  bool has(Outcome outcome) const;
  /// "rest", "rest or hunting", ..., "not valid".
  std::string in_words() const;
};

/// A map over two parameters: point k is column k % x.points, row k / x.points.
struct HuntingMap {
  MapAxis x, y;
  std::vector<std::string> methods;             ///< of Methods, as they are printed
  std::vector<std::optional<MapPoint>> points;  ///< empty: not computed yet

  std::size_t size() const { return static_cast<std::size_t>(x.points) * static_cast<std::size_t>(y.points); }
  const std::optional<MapPoint>& at(int column, int row) const {
    return points[static_cast<std::size_t>(row) * static_cast<std::size_t>(x.points) +
                  static_cast<std::size_t>(column)];
  }
  double x_of(std::size_t k) const { return x.value(static_cast<int>(k) % x.points); }
  double y_of(std::size_t k) const { return y.value(static_cast<int>(k) / x.points); }
  std::size_t known() const;
};

/// Of a map that judges none and has outcomes only: see simulated_points().
inline constexpr Methods no_methods{false, false, false};

/// Methods by name, in the order of `wanted`.
std::vector<std::string> names_of(const Methods& wanted);

/// predict() at one point, and the verdict on each method there: false if it predicts a cycle that does not exist,
/// missed if it misses one, biased if amplitude or frequency is off by more than 5 % or the stability is wrong.
/// `options` gives the methods, the number of starts and the accuracy. A loop that cannot be treated is undecided.
MapPoint map_point(const Loop& loop, const PredictOptions& options);

/// A point as a row of numbers for a store, and back; `methods`: their number.
std::vector<std::string> map_columns(const std::vector<std::string>& methods);
std::vector<double> to_row(const MapPoint& point);
/// Throws std::invalid_argument for a row that to_row cannot have produced.
MapPoint point_of_row(std::span<const double> row, std::size_t methods);

}  // namespace limcycle
