/// @file
/// Computing time of each point of a map, in the order of the map.
///   map_points CASE X_PATH FROM TO N  Y_PATH FROM TO N      prints CPU seconds, one point a line, x fastest
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "limcycle/analysis/study/map/hunting_map.hpp"
#include "limcycle/bench/measure.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/models/diagram/assemble.hpp"

namespace {

struct Side {
  std::string path;
  double from, to;
  int points;

  double at(int i) const { return from + (to - from) * i / (points - 1); }
};

Side side(char** words) { return {words[0], std::stod(words[1]), std::stod(words[2]), std::stoi(words[3])}; }

/// As `limcycle map` computes it (cli/commands/map.cpp).
void compute(const limcycle::Case& from, const limcycle::PredictOptions& options,
             const std::vector<std::pair<std::string, double>>& values) {
  const auto parts = limcycle::parts_with(from, values);
  if (!parts) return;
  try {
    limcycle::map_point(limcycle::build_loop(*parts), options);
  } catch (const std::invalid_argument&) {
    // no valid loop: the map states it, at almost no cost
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 10) {
    std::fprintf(stderr, "map_points CASE X_PATH FROM TO N Y_PATH FROM TO N\n");
    return 2;
  }
  const limcycle::Case from = limcycle::load_case(argv[1], {});
  const Side x = side(argv + 2), y = side(argv + 6);
  limcycle::PredictOptions options = from.predict;
  options.methods = {true, false, false};
  options.accuracy = std::max(options.accuracy, 1e-6);
  for (int j = 0; j < y.points; ++j)
    for (int i = 0; i < x.points; ++i) {
      const double begin = bench::cpu_seconds();
      compute(from, options, {{x.path, x.at(i)}, {y.path, y.at(j)}});
      std::printf("%.6e\n", bench::cpu_seconds() - begin);
    }
  return 0;
}
