#include "limcycle/analysis/study/tune/direct_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limcycle {
namespace {

using Position = std::vector<double>;

/// A direction, all equally likely, of length 1.
Position random_direction(std::size_t size, RandomStream& random) {
  Position v(size);
  double squares = 0.0;
  for (double& one : v) {
    one = std::sqrt(-2.0 * std::log(random.uniform())) * std::cos(2.0 * std::numbers::pi * random.uniform());
    squares += one * one;
  }
  for (double& one : v) one /= std::sqrt(squares);
  return v;
}

/// The places at one step from one, along the columns of a basis.
std::vector<Position> poll_places(const Position& centre, double step, const std::vector<Position>& basis) {
  std::vector<Position> places;
  for (const Position& direction : basis)
    for (const double sign : {1.0, -1.0}) {
      Position place = centre;
      for (std::size_t i = 0; i < place.size(); ++i)
        place[i] = std::clamp(centre[i] + sign * step * direction[i], 0.0, 1.0);
      if (place != centre) places.push_back(std::move(place));
    }
  return places;
}

/// The columns of the reflection I - 2 v v^T; the axes for v = 0.
std::vector<Position> reflected_axes(const Position& v) {
  const std::size_t n = v.size();
  std::vector<Position> basis(n, Position(n, 0.0));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) basis[j][i] = (i == j ? 1.0 : 0.0) - 2.0 * v[i] * v[j];
  return basis;
}

}  // namespace

bool DirectSearch::run(Position& place, RandomStream random, const FirstBetter& first_better,
                       const std::function<bool()>& stop) const {
  const std::size_t n = place.size();
  const auto moves_along = [&](const std::vector<Position>& basis, double step) {
    const auto places = poll_places(place, step, basis);
    const auto better = first_better(places, step);
    if (better) place = places[*better];
    return better.has_value();
  };
  const auto axes = reflected_axes(Position(n, 0.0));
  for (double step = first_step; step >= last_step;) {
    bool moved = moves_along(axes, step);
    for (int basis = 0; basis < bases && n > 1 && !moved && !stop(); ++basis)
      moved = moves_along(reflected_axes(random_direction(n, random)), step);
    if (stop()) return false;
    step = moved ? std::min(2.0 * step, first_step) : 0.5 * step;
  }
  return true;
}

}  // namespace limcycle
