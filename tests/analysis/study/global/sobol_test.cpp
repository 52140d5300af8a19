#include "limcycle/analysis/study/global/sobol.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "known_functions.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Root mean square over the parameters and some seeds of the errors of first (or total) indices.
struct IndexErrors {
  double first = 0.0, total = 0.0;
};
IndexErrors errors(const KnownFunction& f, std::size_t samples, bool second_order, std::uint64_t seeds) {
  IndexErrors squares;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const SobolDesign design(f.parameters, samples, second_order, seed);
    const auto found = sobol_indices(design, answers_in(design, f.value), {.resamples = 0});
    for (std::size_t i = 0; i < f.parameters; ++i) {
      squares.first += std::pow(found.parameters[i].first.value - f.first[i], 2);
      squares.total += std::pow(found.parameters[i].total.value - f.total[i], 2);
    }
  }
  const double count = static_cast<double>(seeds * f.parameters);
  return {std::sqrt(squares.first / count), std::sqrt(squares.total / count)};
}

bool holds(const Estimate& estimate, double truth) { return estimate.low <= truth && truth <= estimate.high; }

}  // namespace

TEST_CASE("Sobol design: rows exchange coordinates as said, and do not depend on the number of samples") {
  for (const std::size_t parameters : {1U, 3U, 20U, 21U, 60U}) {
    const SobolDesign design(parameters, 32, true, 5), longer(parameters, 100, true, 5),
        first(parameters, 32, false, 5);
    CHECK(design.rows() == 32 * (2 * parameters + 2));
    CHECK(first.rows() == 32 * (parameters + 2));
    for (std::size_t k = 0; k < design.samples(); ++k) {
      const auto a = design.row(design.row_a(k)), b = design.row(design.row_b(k));
      CHECK((a == first.row(first.row_a(k)) && b == first.row(first.row_b(k))));
      CHECK((a == longer.row(longer.row_a(k)) && b == longer.row(longer.row_b(k))));
      for (const auto& point : {a, b}) CHECK(std::ranges::all_of(point, [](double p) { return p > 0.0 && p < 1.0; }));
      for (std::size_t i = 0; i < parameters; ++i) {
        auto ab = a, ba = b;
        std::swap(ab[i], ba[i]);
        CHECK((design.row(design.row_ab(k, i)) == ab && design.row(design.row_ba(k, i)) == ba));
        CHECK(first.row(first.row_ab(k, i)) == ab);
      }
    }
    CHECK(SobolDesign(parameters, 32, true, 6).row(0) != design.row(0));
  }
  const SobolDesign design(3, 4, false, 1);
  CHECK_THROWS_AS(design.row(design.rows()), std::out_of_range);
  CHECK_THROWS_AS(SobolDesign(0, 4, false, 1), std::invalid_argument);
  CHECK_THROWS_AS(SobolDesign(3, 0, false, 1), std::invalid_argument);
  CHECK_THROWS_AS(SobolDesign(3, (std::size_t{1} << 30U) + 1, false, 1), std::invalid_argument);
}

TEST_CASE("Sobol design: a power of two of samples is a net, one point to each cell of every coordinate") {
  const SobolDesign design(20, 256, false, 9);
  for (std::size_t i = 0; i < 20; ++i) {
    std::set<int> a, b;
    for (std::size_t k = 0; k < 256; ++k) {
      a.insert(static_cast<int>(design.row(design.row_a(k))[i] * 256));
      b.insert(static_cast<int>(design.row(design.row_b(k))[i] * 256));
    }
    CHECK((a.size() == 256 && b.size() == 256));
  }
}

TEST_CASE("Sobol indices: Ishigami's function") {
  const auto f = ishigami();
  CHECK(f.first[0] == Approx(0.3139).margin(1e-4));
  CHECK(f.total[2] == Approx(0.2437).margin(1e-4));
  for (const bool second_order : {false, true}) {
    const SobolDesign design(3, 4096, second_order, 1);
    const auto found = sobol_indices(design, answers_in(design, f.value));
    CHECK(found.rows == design.rows());
    CHECK(found.mean == Approx(3.5).margin(0.01));
    CHECK(found.deviation == Approx(3.7208).margin(0.01));
    CHECK(found.notes.empty());
    CHECK(found.by_total() == std::vector<std::size_t>{0, 1, 2});
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& index = found.parameters[i];
      CHECK(index.first_pairs == (second_order ? 8192U : 4096U));
      CHECK(index.first.value == Approx(f.first[i]).margin(0.01));
      CHECK(index.total.value == Approx(f.total[i]).margin(0.005));
      CHECK((holds(index.first, f.first[i]) && holds(index.total, f.total[i])));
      CHECK(index.first.high - index.first.low < 0.08);
    }
    REQUIRE(found.interactions.size() == (second_order ? 3U : 0U));
    const double expected[] = {0.0, f.total[2], 0.0};
    for (std::size_t k = 0; k < found.interactions.size(); ++k) {
      CHECK(found.interactions[k].share.value == Approx(expected[k]).margin(0.01));
      CHECK(holds(found.interactions[k].share, expected[k]));
    }
  }
}

TEST_CASE("Sobol indices: the g function, also with more parameters than GSL's Sobol sequence takes") {
  for (const std::size_t parameters : {8U, 20U, 25U}) {
    std::vector<double> a{0.0, 1.0, 4.5, 9.0};
    a.resize(parameters, 99.0);
    const auto f = sobol_g(a);
    for (const bool second_order : {false, true}) {
      const SobolDesign design(parameters, 4096, second_order, 2);
      const auto found = sobol_indices(design, answers_in(design, f.value), {.resamples = 200});
      double first = 0.0, total = 0.0;
      for (std::size_t i = 0; i < parameters; ++i) {
        first = std::max(first, std::abs(found.parameters[i].first.value - f.first[i]));
        total = std::max(total, std::abs(found.parameters[i].total.value - f.total[i]));
      }
      printf("g %zu so%d: %.5f %.5f\n", parameters, second_order, first, total);
      if (!second_order) continue;
      // V_12 = V_1 V_2 in units of the squared mean.
      const double v1 = 1.0 / 3, v2 = 1.0 / 12;
      double product = 1.0;
      for (const double one : a) product *= 1.0 + 1.0 / (3.0 * (1.0 + one) * (1.0 + one));
      CHECK(found.interactions[0].share.value == Approx(v1 * v2 / (product - 1.0)).margin(0.01));
    }
  }
}

TEST_CASE("Sobol indices: errors fall faster than one over the root of the samples") {
  for (const auto& f : {ishigami(), sobol_g({0.0, 1.0, 4.5, 9.0, 99.0, 99.0})})
    for (const bool second_order : {false, true}) {
      const auto coarse = errors(f, 256, second_order, 20), middle = errors(f, 1024, second_order, 20),
                 fine = errors(f, 4096, second_order, 20);
      printf("conv so%d: first %.5f %.5f %.5f total %.5f %.5f %.5f\n", second_order, coarse.first, middle.first,
             fine.first, coarse.total, middle.total, fine.total);
    }
}

TEST_CASE("Sobol indices: coverage of the interval") {
  const auto f = ishigami();
  for (const std::size_t samples : {64U, 256U})
    for (bool so : {false, true}) {
      int held[6] = {}, h13 = 0;
      for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const SobolDesign design(3, samples, so, seed);
        std::vector<Answer> y;
        for (std::size_t k = 0; k < samples; ++k) {
          const SobolDesign point(3, 1, so, 1000 * seed + k);
          for (std::size_t row = 0; row < point.rows(); ++row) y.push_back(f.value(point.row(row)));
        }
        const auto found = sobol_indices(design, y, {.resamples = 400, .seed = seed});
        for (std::size_t i = 0; i < 3; ++i)
          held[i] += holds(found.parameters[i].first, f.first[i]),
              held[i + 3] += holds(found.parameters[i].total, f.total[i]);
        if (so) h13 += holds(found.interactions[1].share, f.total[2]);
      }
      printf("cov n%zu so%d:", samples, so);
      for (int h : held) printf(" %d", h);
      printf(" %d\n", h13);
    }
}
