#include "limcycle/analysis/frequency/march/radau_iia.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/march/barycentric.hpp"

namespace limcycle {

namespace {

using Long = long double;

/// Legendre polynomials of degree n and n - 1 at x.
std::array<Long, 2> legendre(int n, Long x) {
  Long before = 1.0L, now = x;
  for (int k = 2; k <= n; ++k) {
    const Long next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
    before = now;
    now = next;
  }
  return {n == 0 ? 1.0L : now, before};
}

/// All zeros of f in (-1, 1), which has `count` simple ones: signs on a fine grid of the angle, then bisection.
template <class F>
std::vector<Long> zeros(F f, int count) {
  std::vector<Long> found;
  const int grid = 400 * (count + 1);
  Long left = -1.0L, f_left = f(left);
  for (int k = 1; k < grid; ++k) {
    const Long right = -std::cos(std::numbers::pi_v<Long> * k / grid);
    const Long f_right = f(right);
    if ((f_left < 0.0L) != (f_right < 0.0L)) {
      Long low = left, high = right;
      for (int step = 0; step < 80; ++step) {
        const Long middle = 0.5L * (low + high);
        ((f(middle) < 0.0L) == (f_left < 0.0L) ? low : high) = middle;
      }
      found.push_back(0.5L * (low + high));
    }
    left = right;
    f_left = f_right;
  }
  return found;
}

/// The inverse of `a` and its row sums, by Gauss-Jordan with row exchange.
void invert(RadauIIA& table) {
  const auto s = static_cast<std::size_t>(table.stages);
  std::vector<std::vector<Long>> rows(s, std::vector<Long>(2 * s, 0.0L));
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) rows[i][j] = table.a[i * s + j];
    rows[i][s + i] = 1.0L;
  }
  for (std::size_t k = 0; k < s; ++k) {
    const auto largest =
        std::max_element(rows.begin() + static_cast<std::ptrdiff_t>(k), rows.end(),
                         [&](const auto& a, const auto& b) { return std::abs(a[k]) < std::abs(b[k]); });
    std::swap(rows[k], *largest);
    const Long pivot = rows[k][k];
    for (Long& value : rows[k]) value /= pivot;
    for (std::size_t i = 0; i < s; ++i) {
      if (i == k) continue;
      const Long factor = rows[i][k];
      for (std::size_t j = 0; j < 2 * s; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  for (std::size_t i = 0; i < s; ++i) {
    Long sum = 0.0L;
    for (std::size_t j = 0; j < s; ++j) {
      table.inverse[i * s + j] = static_cast<double>(rows[i][s + j]);
      sum += rows[i][s + j];
    }
    table.row_sum[i] = static_cast<double>(sum);
  }
}

RadauIIA make_table(int s) {
  // c: zeros of P_s - P_{s-1} on [-1, 1], the last one being 1.
  std::vector<Long> c;
  for (const Long x : zeros(
           [s](Long at) {
             const auto p = legendre(s, at);
             return p[0] - p[1];
           },
           s - 1))
    c.push_back(0.5L * (x + 1.0L));
  c.push_back(1.0L);
  const auto gauss = zeros([s](Long at) { return legendre(s, at)[0]; }, s);

  RadauIIA table;
  table.stages = s;
  for (int i = 0; i < s; ++i) {
    for (int j = 0; j < s; ++j) {
      // a_ij: integral of the j-th Lagrange polynomial over [0, c_i], by the Gauss rule that is exact for it.
      Long sum = 0.0L;
      for (const Long x : gauss) {
        const auto p = legendre(s, x);
        const Long slope = s * (x * p[0] - p[1]) / (x * x - 1.0L);
        const Long weight = 1.0L / ((1.0L - x * x) * slope * slope);
        Long lagrange = 1.0L;
        const Long at = c[static_cast<std::size_t>(i)] * 0.5L * (x + 1.0L);
        for (int m = 0; m < s; ++m) {
          const auto cj = c[static_cast<std::size_t>(j)], cm = c[static_cast<std::size_t>(m)];
          if (m != j) lagrange *= (at - cm) / (cj - cm);
        }
        sum += weight * lagrange;
      }
      table.a[table.position(i, j)] = static_cast<double>(c[static_cast<std::size_t>(i)] * sum);
    }
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(s); ++j) {
    table.c[j] = static_cast<double>(c[j]);
    table.b[j] = table.a[table.position(s - 1, static_cast<int>(j))];
  }
  for (std::size_t j = 0; j <= static_cast<std::size_t>(s); ++j) {
    const Long own = j == 0 ? 0.0L : c[j - 1];
    Long product = 1.0L;
    for (std::size_t m = 0; m <= static_cast<std::size_t>(s); ++m)
      if (m != j) product *= own - (m == 0 ? 0.0L : c[m - 1]);
    table.barycentric[j] = static_cast<double>(1.0L / product);
  }
  invert(table);
  return table;
}

}  // namespace

void RadauIIA::interpolation(double t, std::array<double, most_stages + 1>& weights) const {
  const auto count = static_cast<std::size_t>(stages) + 1;
  std::array<double, most_stages + 1> nodes{};
  std::copy_n(c.begin(), count - 1, nodes.begin() + 1);
  weights.fill(0.0);
  barycentric_shares(std::span(nodes).first(count), std::span(barycentric).first(count), t,
                     std::span(weights).first(count));
}

const RadauIIA& radau_iia(int stages) {
  if (stages < 2 || stages > RadauIIA::most_stages)
    throw std::invalid_argument("Radau IIA: the number of stages must lie in 2..12, got " + std::to_string(stages));
  static const auto tables = [] {
    std::array<RadauIIA, RadauIIA::most_stages + 1> all;
    for (int s = 2; s <= RadauIIA::most_stages; ++s) all[static_cast<std::size_t>(s)] = make_table(s);
    return all;
  }();
  return tables[static_cast<std::size_t>(stages)];
}

}  // namespace limcycle
