#include "limcycle/analysis/frequency/describing_function/gain_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "limcycle/analysis/frequency/march/barycentric.hpp"

namespace limcycle {
namespace {

constexpr std::size_t nodes = 8;
constexpr double width = 2.0 * std::numbers::ln2;  ///< of the largest cell, in ln A and ln(A w)
constexpr double polynomial_share = 0.3;           ///< of the wanted accuracy, for the polynomial

/// Chebyshev points of the first kind, and the weights of barycentric interpolation on them.
struct ChebyshevRow {
  std::array<double, nodes> x{}, weight{};
  ChebyshevRow() {
    for (std::size_t i = 0; i < nodes; ++i) {
      const double angle = std::numbers::pi * (2.0 * static_cast<double>(i) + 1.0) / (2.0 * nodes);
      x[i] = std::cos(angle);
      weight[i] = (i % 2 == 0 ? 1.0 : -1.0) * std::sin(angle);
    }
  }
  std::array<double, nodes> shares(double at) const {
    std::array<double, nodes> share{};
    barycentric_shares(x, weight, at, share);
    return share;
  }
};

const ChebyshevRow& row() {
  static const ChebyshevRow made;
  return made;
}

double size_of(std::int64_t halvings) { return std::ldexp(width, -static_cast<int>(halvings)); }

}  // namespace

GainSurface::GainSurface(Element element, double bias, double accuracy)
    : element_(std::move(element)),
      table_(element_, {}, {.harmonics = 1, .accuracy = 0.3 * accuracy}),
      bias_(bias),
      accuracy_(accuracy),
      of_amplitude_(element_.facts().rate_independent && bias == 0.0),
      of_speed_(!of_amplitude_ && element_.states() == 0 && !element_.follows_position() &&
                element_.drive_band() == 0.0) {}

std::optional<std::complex<double>> GainSurface::at(double amplitude, double frequency) {
  const double p = of_speed_ ? 0.0 : std::log(amplitude), q = of_amplitude_ ? 0.0 : std::log(amplitude * frequency);
  for (std::int64_t halvings = 0; halvings <= most_halvings; ++halvings) {
    const double size = size_of(halvings), i = std::floor(p / size), j = std::floor(q / size);
    const Name name{halvings, static_cast<std::int64_t>(i), static_cast<std::int64_t>(j)};
    auto known = cells_.find(name);
    if (known == cells_.end()) known = cells_.emplace(name, made(name)).first;
    if (known->second.empty()) continue;
    const Complex value = interpolated(known->second, {2.0 * (p / size - i) - 1.0, 2.0 * (q / size - j) - 1.0});
    return of_speed_ ? value * frequency : value;
  }
  return std::nullopt;
}

DfPoint GainSurface::point(const Name& name, const Place& place) const {
  const double size = size_of(name[0]);
  const auto coordinate = [&](std::size_t k) {
    return std::exp(size * (static_cast<double>(name[k + 1]) + 0.5 + 0.5 * place[k]));
  };
  if (of_amplitude_) return {coordinate(0), 1.0, bias_};
  if (of_speed_) return {1.0, coordinate(1), bias_};
  return {coordinate(0), coordinate(1) / coordinate(0), bias_};
}

std::vector<DescribingFunction> GainSurface::computed(const std::vector<DfPoint>& points) {
  auto results = table_.some_of(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (results[i].method.empty()) results[i] = table_.at(points[i]);
    evaluations_ += results[i].evaluations;
  }
  return results;
}

/// The values on a cell, or nothing if a polynomial through them is not accurate.
GainSurface::Cell GainSurface::made(const Name& name) {
  const auto& x = row().x;
  std::vector<Place> places;
  for (std::size_t i = 0; i < (of_speed_ ? 1 : nodes); ++i)
    for (std::size_t j = 0; j < (of_amplitude_ ? 1 : nodes); ++j) places.push_back({x[i], x[j]});
  const std::size_t count = places.size();
  for (const double p : {-1.0, 0.0, 1.0})
    for (const double q : {-1.0, 0.0, 1.0})
      if ((!of_speed_ || p == 0.0) && (!of_amplitude_ || q == 0.0)) places.push_back({p, q});
  std::vector<DfPoint> points;
  points.reserve(places.size());
  for (const Place& place : places) points.push_back(point(name, place));
  const auto results = computed(points);
  const bool exists = std::ranges::all_of(results, [&](const DescribingFunction& one) {
    return one.answered() && std::isfinite(std::abs(one.gain)) && one.gain != 0.0 && (one.symmetric || bias_ != 0.0);
  });
  if (!exists) return {};
  Cell cell;
  cell.reserve(count);
  for (std::size_t i = 0; i < count; ++i) cell.push_back(smooth(results[i].gain, points[i].frequency));
  for (std::size_t i = count; i < places.size(); ++i) {
    const Complex expected = smooth(results[i].gain, points[i].frequency);
    if (!(std::abs(interpolated(cell, places[i]) - expected) <= polynomial_share * accuracy_ * std::abs(expected)))
      return {};
  }
  return cell;
}

std::complex<double> GainSurface::interpolated(const Cell& cell, const Place& place) const {
  const auto along = [&](const Complex* values, double at) {
    const auto share = row().shares(at);
    Complex sum = 0.0;
    for (std::size_t i = 0; i < nodes; ++i) sum += share[i] * values[i];
    return sum;
  };
  if (of_speed_) return along(cell.data(), place[1]);
  if (of_amplitude_) return along(cell.data(), place[0]);
  std::array<Complex, nodes> rows;
  const auto share = row().shares(place[1]);
  for (std::size_t i = 0; i < nodes; ++i) {
    rows[i] = 0.0;
    for (std::size_t j = 0; j < nodes; ++j) rows[i] += share[j] * cell[i * nodes + j];
  }
  return along(rows.data(), place[0]);
}

}  // namespace limcycle
