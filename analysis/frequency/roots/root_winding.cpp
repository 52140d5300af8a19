#include "limcycle/analysis/frequency/roots/root_winding.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <utility>

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Total = std::optional<double>;

constexpr double largest_change = std::numbers::pi / 3.0;

struct Point {
  double p, q;
  Complex f;
};

Total operator+(const Total& a, const Total& b) { return a && b ? Total(*a + *b) : std::nullopt; }

// Argument change between neighbours: nothing if it cannot be determined.
Total direct_change(Complex from, Complex to) {
  const Complex ratio = to * std::conj(from);
  return ratio == Complex(0.0) || std::isnan(ratio.real()) ? Total() : Total(std::arg(ratio));
}

class Border {
 public:
  explicit Border(RootLattice& lattice)
      : lattice_(lattice), coarse_(lattice.accuracies().front()), fine_(lattice.accuracies().back()) {}

  // Argument change along a horizontal (or vertical) piece of a lattice line.
  Total along(bool horizontal, std::int64_t line, std::int64_t from, std::int64_t to) {
    const std::int64_t step = lattice_.unit() / 4;
    Total total = 0.0;
    while (from < to && total) {
      const std::int64_t next = std::min(to, (from / step + 1) * step);
      total = total + (horizontal ? change(from, line, next, line) : change(line, from, line, next));
      from = next;
    }
    return total;
  }

 private:
  Complex node(std::int64_t i, std::int64_t j) {
    const Complex f = lattice_.sample(i, j, coarse_);
    return std::abs(f) < 100.0 * coarse_ ? lattice_.sample(i, j, fine_) : f;
  }

  Total change(std::int64_t i0, std::int64_t j0, std::int64_t i1, std::int64_t j1) {
    const Complex f0 = node(i0, j0), f1 = node(i1, j1);
    const Total direct = direct_change(f0, f1);
    if (!direct || std::abs(*direct) < largest_change) return direct;
    const std::int64_t i = (i0 + i1) / 2, j = (j0 + j1) / 2;
    if (i1 - i0 + j1 - j0 > 1) return change(i0, j0, i, j) + change(i, j, i1, j1);
    return between({lattice_.p(i0), lattice_.q(j0), f0}, {lattice_.p(i1), lattice_.q(j1), f1});
  }

  // The same between points closer than the spacing of the lattice.
  Total between(const Point& a, const Point& b) {
    const Total direct = direct_change(a.f, b.f);
    if (!direct || std::abs(*direct) < largest_change) return direct;
    if (std::abs(a.p - b.p) + std::abs(a.q - b.q) < 1e-12) return std::nullopt;
    Point middle{0.5 * (a.p + b.p), 0.5 * (a.q + b.q), {}};
    middle.f = lattice_.at(middle.p, middle.q, fine_);
    return between(a, middle) + between(middle, b);
  }

  RootLattice& lattice_;
  double coarse_, fine_;
};

// For each line: where the number of border pieces changes, and by how much (sign: direction of travel).
using LineChanges = std::map<std::int64_t, std::map<std::int64_t, int>>;

Total turn(Border& border, bool horizontal, const LineChanges& lines) {
  Total total = 0.0;
  for (const auto& [line, changes] : lines) {
    int direction = 0;
    std::int64_t from = 0;
    for (const auto& [position, change] : changes) {
      if (direction != 0) {
        const Total piece = border.along(horizontal, line, from, position);
        if (!piece) return std::nullopt;
        *total += direction * *piece;
      }
      direction += change;
      from = position;
    }
  }
  return total;
}

}  // namespace

std::optional<int> border_winding(RootLattice& lattice, const std::vector<LatticeCell>& cells) {
  LineChanges horizontal, vertical;
  const auto add = [](LineChanges& lines, std::int64_t line, std::int64_t from, std::int64_t to, int direction) {
    lines[line][from] += direction;  // edges shared by two cells cancel
    lines[line][to] -= direction;
  };
  for (const LatticeCell& c : cells) {
    add(horizontal, c.j, c.i, c.i + c.width, 1);
    add(horizontal, c.j + c.height, c.i, c.i + c.width, -1);
    add(vertical, c.i + c.width, c.j, c.j + c.height, 1);
    add(vertical, c.i, c.j, c.j + c.height, -1);
  }
  Border border(lattice);
  const Total total = turn(border, true, horizontal) + turn(border, false, vertical);
  if (!total) return std::nullopt;
  return static_cast<int>(std::lround(*total / (2.0 * std::numbers::pi)));
}

}  // namespace limcycle
