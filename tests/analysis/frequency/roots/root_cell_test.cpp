// The decision about one cell, from functions whose zeros in the cell are known.
#include "limcycle/analysis/frequency/roots/root_cell.hpp"

#include <catch2/catch.hpp>
#include <cstddef>
#include <random>

using namespace limcycle;
using Complex = std::complex<double>;

namespace {

template <typename Function>
CellKnowledge sample(Function f) {
  CellKnowledge cell;
  for (std::size_t k = 0; k < 9; ++k)
    cell.values[k] = f(static_cast<double>(k % 3) - 1.0, static_cast<double>(k / 3) - 1.0);
  cell.has_surprise = true;  // of zero: the model is taken to be good
  return cell;
}

}  // namespace

TEST_CASE("the interpolant is exact for biquadratic functions", "[root_cell]") {
  const auto f = [](double u, double v) {
    return Complex(1.0 + u - 2.0 * v * v + u * u * v, 3.0 * u * v - u * u * v * v);
  };
  const CellKnowledge cell = sample(f);
  for (const double u : {-1.0, -0.3, 0.7}) {
    for (const double v : {-0.9, 0.1, 1.0}) CHECK(std::abs(interpolate(cell.values, u, v) - f(u, v)) < 1e-14);
  }
}

TEST_CASE("a linear function has its root found or excluded", "[root_cell]") {
  const auto linear = [](double u0, double v0) {
    return assess(sample([=](double u, double v) { return Complex((u - u0) + 0.5 * (v - v0), 0.01 * (v - v0)); }));
  };
  const CellAssessment inside = linear(0.3, -0.6);
  CHECK(inside.verdict == CellVerdict::at_most_one);
  CHECK(inside.u == Approx(0.3));
  CHECK(inside.v == Approx(-0.6));
  CHECK(linear(1.0, 1.0).verdict == CellVerdict::at_most_one);
  CHECK(linear(1.01, 0.0).verdict == CellVerdict::no_root);
  CHECK(linear(0.0, -1.01).verdict == CellVerdict::no_root);
}

TEST_CASE("a fold is never decided while both roots are in the cell", "[root_cell]") {
  const auto fold = [](double u0, double eps2) {
    return assess(sample([=](double u, double v) { return Complex((u - u0) * (u - u0) - eps2, v); }));
  };
  CHECK(fold(0.1, 0.04).verdict == CellVerdict::unclear);
  CHECK(fold(0.1, 0.0).verdict == CellVerdict::unclear);
  CHECK(fold(0.1, 0.04).split_u);
  CHECK_FALSE(fold(0.1, 0.04).split_v);  // it is linear along v
  CHECK(fold(0.0, -2.1).verdict == CellVerdict::no_root);
  CHECK(fold(6.0, 36.0).verdict == CellVerdict::at_most_one);
}

TEST_CASE("noise that hides the answer is noticed", "[root_cell]") {
  CellKnowledge cell = sample([](double u, double v) { return Complex(1e-6 * u * u - 1e-7, v); });
  cell.noise = 1e-5;
  CHECK(assess(cell).verdict == CellVerdict::needs_accuracy);
  cell.noise = 1e-12;
  CHECK(assess(cell).verdict == CellVerdict::unclear);
}

TEST_CASE("a model that failed, or caution, prevents a cell from being discarded", "[root_cell]") {
  CellKnowledge cell = sample([](double u, double v) { return Complex(1.0 + 0.05 * u * u, 0.05 * v * v); });
  CHECK(assess(cell).verdict == CellVerdict::no_root);
  cell.surprise[4] = 0.6;
  CHECK(assess(cell).verdict != CellVerdict::no_root);
  cell.surprise[4] = 0.0;
  cell.caution = 64.0;
  CHECK(assess(cell).verdict != CellVerdict::no_root);
}

TEST_CASE("no cell with a root is discarded: random biquadratic functions", "[root_cell]") {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int decided = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::array<Complex, 9> c;
    for (Complex& x : c) x = {uniform(generator), uniform(generator)};
    const double u0 = uniform(generator), v0 = uniform(generator), bend = 0.2 * (uniform(generator) + 1.0);
    const auto raw = [&](double u, double v) {
      return c[0] * u + c[1] * v + bend * (c[2] * u * u + c[3] * u * v + c[4] * v * v + c[5] * u * u * v);
    };
    const CellAssessment out = assess(sample([&](double u, double v) { return raw(u, v) - raw(u0, v0); }));
    INFO("trial " << trial);
    if (out.verdict == CellVerdict::no_root) FAIL("discarded a cell that has a root");
    decided += out.verdict == CellVerdict::at_most_one ? 1 : 0;
  }
  CHECK(decided > 1000);
}

TEST_CASE("the smallest point of the interpolant is found", "[root_cell]") {
  const auto [u, v] =
      smallest_point(sample([](double x, double y) { return Complex((x - 0.4) * (x - 0.4), y + 0.2 * x); }).values);
  CHECK(u == Approx(0.4).margin(0.01));
  CHECK(v == Approx(-0.08).margin(0.01));
}
