// Winding numbers of functions with known zeros, over whole boxes and over parts of them.
#include "limcycle/analysis/frequency/roots/root_winding.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace limcycle;
using Complex = std::complex<double>;

namespace {

const SearchBox box{std::exp(-1.0), std::exp(1.0), std::exp(-1.0), std::exp(1.0)};

// With 8 x 8 blocks of 0.25: over the cells for which `take(column, row)`.
template <typename Function, typename Choice>
std::optional<int> winding(Function f, Choice take) {
  const LoopEquation equation = [=](double A, double w, double) -> Complex {
    return f(Complex(std::log(A), std::log(w)));
  };
  RootSearchOptions options;
  options.initial_cells_amplitude = options.initial_cells_frequency = 16;
  options.max_depth = options.max_border_depth = 8;
  RootLattice lattice(equation, box, options);
  const std::int64_t unit = lattice.unit();
  std::vector<LatticeCell> cells;
  for (std::int64_t column = 0; column < lattice.columns(); ++column) {
    for (std::int64_t row = 0; row < lattice.rows(); ++row) {
      if (take(column, row)) cells.push_back({column * unit, row * unit, unit, unit});
    }
  }
  return border_winding(lattice, cells);
}

bool everywhere(std::int64_t, std::int64_t) { return true; }

}  // namespace

TEST_CASE("winding numbers of powers and their conjugates", "[root_winding]") {
  const Complex z0(0.2, -0.3);
  CHECK(winding([=](Complex z) { return z - z0; }, everywhere) == 1);
  CHECK(winding([=](Complex z) { return std::conj(z - z0); }, everywhere) == -1);
  CHECK(winding([=](Complex z) { return std::pow(z - z0, 5); }, everywhere) == 5);
  CHECK(winding([=](Complex z) { return (z - z0) * std::conj(z + z0); }, everywhere) == 0);
  CHECK(winding([=](Complex z) { return z - 3.0; }, everywhere) == 0);
}

TEST_CASE("only zeros inside the chosen cells count, also with holes and separate parts", "[root_winding]") {
  const auto f = [](Complex z) {
    return (z - Complex(-0.6, -0.6)) * (z - Complex(0.1, 0.1)) * std::conj(z - Complex(0.6, 0.6));
  };
  CHECK(winding(f, everywhere) == 1);
  CHECK(winding(f, [](auto column, auto) { return column < 4; }) == 1);
  CHECK(winding(f, [](auto column, auto row) { return !(column == 4 && row == 4); }) == 0);
  CHECK(winding(f, [](auto column, auto row) { return column == row && column != 4; }) == 0);
  CHECK(winding(f, [](auto column, auto row) { return column >= 5 && row >= 5; }) == -1);
  CHECK(winding(f, [](auto, auto) { return false; }) == 0);
}

TEST_CASE("a zero very close to the border is on the right side of it, one on the border is not counted",
          "[root_winding]") {
  const auto zero_at = [](double p) { return [=](Complex z) { return z - Complex(p, 0.05); }; };
  const auto left = [](auto column, auto) { return column < 4; };
  CHECK(winding(zero_at(-1e-8), left) == 1);
  CHECK(winding(zero_at(1e-8), left) == 0);
  CHECK(winding(zero_at(1.0), everywhere) == 1);  // the edge of the box belongs to it
  CHECK_FALSE(winding([](Complex z) { return Complex(z.real() * 0.0, z.imag()); }, everywhere).has_value());
}

TEST_CASE("no winding number where the function does not exist", "[root_winding]") {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const auto f = [=](Complex z) { return z.real() < -0.5 ? Complex(missing, missing) : z; };
  CHECK_FALSE(winding(f, everywhere).has_value());
  CHECK(winding(f, [](auto column, auto) { return column > 2; }) == 1);
}
