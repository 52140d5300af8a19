#include "limcycle/analysis/frequency/roots/root_cell.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace limcycle {
namespace {

using Complex = std::complex<double>;

Eigen::Vector2d as_vector(Complex z) { return {z.real(), z.imag()}; }

// Coefficients of u^m v^n at index 3 n + m.
CellSamples monomials(const CellSamples& f) {
  const auto along = [](const CellSamples& in, std::size_t stride, std::size_t step) {
    CellSamples out{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = k * step, b = a + stride, c = b + stride;
      out[a] = in[b];
      out[b] = 0.5 * (in[c] - in[a]);
      out[c] = 0.5 * (in[c] + in[a]) - in[b];
    }
    return out;
  };
  return along(along(f, 1, 3), 3, 1);
}

CellSamples bernstein_points(const CellSamples& f) {
  const auto along = [](CellSamples g, std::size_t stride, std::size_t step) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = k * step, b = a + stride, c = b + stride;
      g[b] = 2.0 * g[b] - 0.5 * (g[a] + g[c]);
    }
    return g;
  };
  return along(along(f, 1, 3), 3, 1);
}

// Point of the segment a b nearest to zero.
Complex nearest_to_zero(Complex a, Complex b) {
  const Complex d = b - a;
  const double length2 = std::norm(d);
  if (length2 == 0.0) return a;
  return a + std::clamp(-std::real(std::conj(d) * a) / length2, 0.0, 1.0) * d;
}

}  // namespace

Complex nearest_in_hull(const CellSamples& points) {
  std::array<double, 9> angles;
  for (std::size_t k = 0; k < 9; ++k) {
    if (points[k] == Complex(0.0)) return 0.0;
    angles[k] = std::arg(points[k]);
  }
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
  for (std::size_t k = 1; k < 9; ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
  if (gap <= std::numbers::pi) return 0.0;
  Complex best = points[0];
  for (std::size_t a = 0; a < 9; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Complex candidate = nearest_to_zero(points[a], points[b]);
      if (std::norm(candidate) < std::norm(best)) best = candidate;
    }
  }
  return best;
}

namespace {

// Sum of the second- and higher-order coefficients, projected on the direction n (|n| = 1).
double curvature_along(const CellSamples& c, Complex n) {
  double sum = 0.0;
  for (const std::size_t k : {2U, 4U, 5U, 6U, 7U, 8U}) sum += std::abs(std::real(std::conj(n) * c[k]));
  return sum;
}

// Neglected terms of the interpolant in any direction. In a resolved cell the surprise is of third order in its size,
// hence this is of fifth order; the values of an unresolved one (a narrow resonance) may bulge sideways by as much as
// they vary.
double sideways_margin(const CellKnowledge& cell, const CellSamples& c) {
  double curvature = 0.0, surprise = 0.0, variation = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    surprise = std::max(surprise, std::abs(cell.surprise[k]));
    variation = std::max(variation, std::abs(cell.values[k] - cell.values[4]));
    if (k != 0 && k != 1 && k != 3) curvature += std::abs(c[k]);
  }
  const double share = variation > 0.0 ? std::min(1.0, 4.0 * surprise / variation) : 1.0;
  return 2.0 * share * surprise + (cell.has_surprise && cell.caution == 1.0 ? 0.0 : curvature);
}

bool keeps_away(const CellKnowledge& cell, const CellSamples& coefficients) {
  const Complex nearest = nearest_in_hull(bernstein_points(cell.values));
  const double distance = std::abs(nearest);
  if (distance <= cell.noise) return false;
  const Complex n = nearest / distance;
  double margin = 0.5 * curvature_along(coefficients, n);
  for (const Complex s : cell.surprise) margin = std::max(margin, 0.5 * std::abs(std::real(std::conj(n) * s)));
  return distance > cell.caution * (margin + sideways_margin(cell, coefficients)) + cell.noise;
}

// Turns of the samples around the border; nothing if the argument changes too much between neighbours.
std::optional<int> sampled_winding(const CellSamples& f) {
  constexpr std::array<std::size_t, 9> border = {0, 1, 2, 5, 8, 7, 6, 3, 0};
  double turn = 0.0;
  for (std::size_t k = 0; k + 1 < border.size(); ++k) {
    const Complex ratio = f[border[k + 1]] * std::conj(f[border[k]]);
    const double change = std::arg(ratio);
    if (ratio == Complex(0.0) || std::abs(change) > 2.0 * std::numbers::pi / 3.0) return std::nullopt;
    turn += change;
  }
  return static_cast<int>(std::lround(turn / (2.0 * std::numbers::pi)));
}

// Bound of |J^-1 (J(u, v) - J)| over the cell in the maximum norm, the error of the model included.
double jacobian_variation(const CellKnowledge& cell, const CellSamples& c, const Eigen::Matrix2d& inverse) {
  // how often each coefficient enters the two columns of the Jacobian: d/du + d/dv of u^m v^n at most m + n
  constexpr std::array<double, 9> weight = {0, 0, 2, 0, 2, 3, 2, 3, 4};
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), surprise = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 9; ++k) {
    sum += weight[k] * (inverse * as_vector(c[k])).cwiseAbs();
    surprise = surprise.cwiseMax((inverse * as_vector(cell.surprise[k])).cwiseAbs());
  }
  return (sum + surprise).maxCoeff();
}

// Decides between at most one root and none: fills the assessment and returns true if the cell is decided.
bool nearly_linear(const CellKnowledge& cell, const CellSamples& c, CellAssessment& out) {
  Eigen::Matrix2d jacobian;
  jacobian << as_vector(c[1]), as_vector(c[3]);
  const double determinant = jacobian.determinant();
  if (determinant == 0.0 || !std::isfinite(1.0 / determinant)) return false;
  const Eigen::Matrix2d inverse = jacobian.inverse();
  const double resolved = jacobian_variation(cell, c, inverse);
  // the samples already bound the noise, so it needs no safety factor
  const double variation = resolved + cell.noise * inverse.cwiseAbs().rowwise().sum().maxCoeff();
  if (!(resolved <= 0.5 && variation <= 0.9)) return false;
  const Eigen::Vector2d root = -inverse * as_vector(c[0]);
  const double distance = root.cwiseAbs().maxCoeff();
  const bool outside = distance > 1.0 + variation;  // a root x obeys |x - root| <= variation |x|
  const bool inside = distance < 1.0 - variation;
  if (const auto winding = sampled_winding(cell.values)) {
    if (outside && *winding != 0) return false;
    if (inside && *winding != (determinant > 0.0 ? 1 : -1)) return false;
  }
  out.verdict = outside ? CellVerdict::no_root : CellVerdict::at_most_one;
  out.u = root[0];
  out.v = root[1];
  return true;
}

// Bisects along u, v or both: where the curvature is, measured so that the thin direction of the values counts in full.
void choose_directions(const CellSamples& c, const CellKnowledge& cell, const Eigen::Vector2d& thin,
                       CellAssessment& out) {
  double extent = std::numeric_limits<double>::min();
  for (const Complex f : cell.values) extent = std::max(extent, std::abs(f));
  const double thickness = std::max({out.thickness, cell.noise, std::numeric_limits<double>::min()});
  const auto size = [&](std::size_t k) {
    return std::abs(thin.dot(as_vector(c[k]))) / thickness + std::abs(c[k]) / extent;
  };
  const double mixed = 0.5 * (size(4) + size(8)), u = size(2) + size(5) + mixed, v = size(6) + size(7) + mixed;
  out.split_u = 4.0 * u >= v;
  out.split_v = 4.0 * v >= u;
}

}  // namespace

std::complex<double> interpolate(const CellSamples& values, double u, double v) {
  const CellSamples c = monomials(values);
  const auto row = [&](std::size_t n) { return c[3 * n] + u * (c[3 * n + 1] + u * c[3 * n + 2]); };
  return row(0) + v * (row(1) + v * row(2));
}

std::array<double, 2> smallest_point(const CellSamples& values) {
  std::array<double, 2> best = {0.0, 0.0};
  double reach = 1.0;
  for (int round = 0; round < 24; ++round, reach *= 0.5) {
    const auto center = best;
    for (int k = 0; k < 81; ++k) {
      const int row = k / 9, column = k % 9;
      const double u = std::clamp(center[0] + reach * (column - 4) / 4.0, -1.0, 1.0);
      const double v = std::clamp(center[1] + reach * (row - 4) / 4.0, -1.0, 1.0);
      if (std::norm(interpolate(values, u, v)) < std::norm(interpolate(values, best[0], best[1]))) best = {u, v};
    }
  }
  return best;
}

CellAssessment assess(const CellKnowledge& cell) {
  CellAssessment out;
  const CellSamples c = monomials(cell.values);
  if (keeps_away(cell, c)) {
    out.verdict = CellVerdict::no_root;
    return out;
  }
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const Complex f : cell.values) moments += as_vector(f) * as_vector(f).transpose();
  // the direction in which the values spread least about zero: across the larger principal axis
  const double axis = 0.5 * std::atan2(2.0 * moments(0, 1), moments(0, 0) - moments(1, 1));
  const Eigen::Vector2d thin(-std::sin(axis), std::cos(axis));
  for (const Complex f : cell.values) out.thickness = std::max(out.thickness, std::abs(thin.dot(as_vector(f))));
  choose_directions(c, cell, thin, out);
  if (nearly_linear(cell, c, out)) return out;
  if (cell.noise > 0.2 * curvature_along(c, {thin[0], thin[1]})) out.verdict = CellVerdict::needs_accuracy;
  return out;
}

}  // namespace limcycle
