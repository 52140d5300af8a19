#include "limcycle/reports/figures/drawing/decimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace limcycle {
namespace {

/// 1/(greatest - least) of the finite samples, 0 for a constant column.
double scale_of(std::span<const double> values) {
  double least = INFINITY, greatest = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  return greatest > least ? 1.0 / (greatest - least) : 0.0;
}

/// Length of the scaled curve from the first sample to each.
std::vector<double> lengths(const Trace& trace) {
  const std::size_t n = trace.t.size();
  std::vector<double> squares(n, 0.0);
  for (const auto* column : {&trace.t, &trace.y, &trace.rate, &trace.output}) {
    if (column->size() != n) continue;
    const double scale = scale_of(*column);
    for (std::size_t i = 1; i < n; ++i) {
      const double step = ((*column)[i] - (*column)[i - 1]) * scale;
      if (std::isfinite(step)) squares[i] += step * step;
    }
  }
  for (std::size_t i = 1; i < n; ++i) squares[i] = squares[i - 1] + std::sqrt(squares[i]);
  return squares;
}

}  // namespace

bool drawable(const Trace& trace) {
  const std::size_t n = trace.t.size();
  return n >= 2 && trace.y.size() == n && trace.rate.size() == n;
}

bool has_element(const Trace& trace) {
  const std::size_t n = trace.t.size();
  return drawable(trace) && trace.input.size() == n && trace.velocity.size() == n && trace.output.size() == n;
}

Decimated decimate(const Trace& trace, std::size_t most, const std::vector<bool>& keep_changes, double coarsest) {
  Decimated out;
  const auto length = lengths(trace);
  const std::size_t n = length.size();
  if (n == 0) return out;
  const double parts = static_cast<double>(std::max<std::size_t>(most, 2) - 1);
  const double step = std::min(length.back() / parts, coarsest);
  const double until = step * parts;
  out.whole = length.back() <= until * (1.0 + 1e-12);
  double next = 0.0;
  for (std::size_t i = 0; i < n && (out.whole || length[i] <= until); ++i) {
    const bool changes =
        i < keep_changes.size() && ((i > 0 && keep_changes[i] != keep_changes[i - 1]) ||
                                    (i + 1 < keep_changes.size() && keep_changes[i] != keep_changes[i + 1]));
    if (length[i] < next && !changes && i + 1 < n) continue;
    out.index.push_back(i);
    next = std::max(next, length[i] + step * (1.0 - 1e-9));
  }
  return out;
}

std::vector<bool> stuck_samples(const Trace& trace, double fraction) {
  const std::size_t n = std::min(trace.t.size(), trace.velocity.size());
  std::vector<bool> stuck(n, false);
  if (n < 2 || !(fraction > 0.0)) return stuck;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(trace.velocity[a]) < std::abs(trace.velocity[b]);
  });
  const double wanted = fraction * (trace.t[n - 1] - trace.t[0]);
  double time = 0.0;
  for (const std::size_t i : order) {
    // A sample stands for the half intervals on both its sides.
    const double own = 0.5 * (trace.t[std::min(i + 1, n - 1)] - trace.t[i > 0 ? i - 1 : 0]);
    if (time + 0.5 * own > wanted) break;
    time += own;
    stuck[i] = true;
  }
  return stuck;
}

std::string name_of_y(const Trace& trace) {
  if (trace.y_origin == 0.0) return "y";
  return fmt::format("y {} {:.6g}", trace.y_origin > 0.0 ? "-" : "+", std::abs(trace.y_origin));
}

}  // namespace limcycle
