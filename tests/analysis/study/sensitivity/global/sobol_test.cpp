#include "limcycle/analysis/study/sensitivity/global/sobol.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>

#include "limcycle/tests/analysis/study/sensitivity/global/known_functions.hpp"

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
      CHECK(first < 0.002);
      CHECK(total < 0.004);
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
      const auto coarse = errors(f, 256, second_order, 30), middle = errors(f, 1024, second_order, 30),
                 fine = errors(f, 4096, second_order, 30);
      const double first = std::log(coarse.first / fine.first) / std::log(16.0);
      const double total = std::log(coarse.total / fine.total) / std::log(16.0);
      INFO("orders " << first << ' ' << total << ", errors " << coarse.first << ' ' << coarse.total << " to "
                     << fine.first << ' ' << fine.total);
      CHECK((coarse.first > middle.first && middle.first > fine.first));
      CHECK((coarse.total > middle.total && middle.total > fine.total));
      CHECK(first > 0.7);
      CHECK(total > 0.7);
      CHECK((fine.first < 0.002 && fine.total < 0.002));
    }
}

TEST_CASE("Sobol indices: on independent points the interval holds the truth in nearly 95 of 100 samples") {
  const auto f = ishigami();
  for (const bool second_order : {false, true}) {
    constexpr std::size_t samples = 256, seeds = 200;
    const std::vector<double> truth{f.first[0], f.total[0], f.first[1], f.total[1], f.first[2], f.total[2]};
    std::vector<int> held(truth.size());
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const SobolDesign design(3, samples, second_order, 0);
      std::vector<Answer> answers;
      for (std::size_t k = 0; k < samples; ++k) {
        // A sample of a design of one is a random point.
        const auto alone = answers_in(SobolDesign(3, 1, second_order, 1000 * seed + k), f.value);
        answers.insert(answers.end(), alone.begin(), alone.end());
      }
      const auto found = sobol_indices(design, answers, {.resamples = 400, .seed = seed});
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const auto& index = found.parameters[k / 2];
        held[k] += holds(k % 2 == 0 ? index.first : index.total, truth[k]) ? 1 : 0;
      }
    }
    int sum = 0;
    for (const int one : held) {
      CHECK(one >= 172);
      CHECK(one <= 198);
      sum += one;
    }
    CHECK(sum / 6.0 / seeds == Approx(0.935).margin(0.025));
  }
}

TEST_CASE("Sobol indices: on the points of the design the interval is rather too wide") {
  const auto f = ishigami();
  for (const bool second_order : {false, true}) {
    int held = 0, asked = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const SobolDesign design(3, 256, second_order, seed);
      const auto found = sobol_indices(design, answers_in(design, f.value), {.resamples = 200});
      for (std::size_t i = 0; i < 3; ++i, asked += 2)
        held += (holds(found.parameters[i].first, f.first[i]) ? 1 : 0) +
                (holds(found.parameters[i].total, f.total[i]) ? 1 : 0);
    }
    CHECK(held >= 0.95 * asked);
  }
}

TEST_CASE("Sobol indices: one parameter makes all the variance, two share it") {
  const auto square = [](const std::vector<double>& p) -> Answer { return p[0] * p[0]; };
  const SobolDesign single(1, 256, true, 1), simple(1, 256, false, 1), pair(2, 256, true, 1);
  const auto one = sobol_indices(single, answers_in(single, square)).parameters[0];
  CHECK(one.first.value == Approx(1.0));
  CHECK(one.total.value == Approx(1.0));
  CHECK(one.first.bounded());
  const auto without = sobol_indices(simple, answers_in(simple, square)).parameters[0];
  CHECK(without.first.value == Approx(1.0).margin(0.02));
  CHECK(without.total.value == Approx(1.0));
  const auto two = sobol_indices(pair, answers_in(pair, [](const auto& p) -> Answer { return p[0] * std::exp(p[1]); }));
  CHECK(two.parameters[0].first.value + two.parameters[1].first.value + two.interactions[0].share.value == Approx(1.0));
}

TEST_CASE("Sobol indices: the parts of a study are studies of their own, and the same input gives the same result") {
  const auto f = ishigami();
  const SobolDesign design(3, 1024, true, 8);
  const auto answers = answers_in(design, f.value);
  const auto steps = sobol_convergence(design, answers, {.resamples = 200});
  REQUIRE(steps.size() == 4);
  std::size_t samples = 128;
  for (const auto& step : steps) {
    const SobolDesign shorter(3, samples, true, 8);
    const auto alone = sobol_indices(shorter, answers_in(shorter, f.value), {.resamples = 200});
    CHECK((step.samples == samples && step.rows == shorter.rows()));
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(step.parameters[i].first.value == alone.parameters[i].first.value);
      CHECK(step.parameters[i].total.low == alone.parameters[i].total.low);
      CHECK(step.interactions[i].share.high == alone.interactions[i].share.high);
    }
    samples *= 2;
  }
  const auto width = [](const SobolIndices& of) { return of.parameters[0].total.high - of.parameters[0].total.low; };
  CHECK(width(steps[3]) < 0.6 * width(steps[0]));
  CHECK(sobol_convergence(SobolDesign(3, 20, true, 8), answers_in(SobolDesign(3, 20, true, 8), f.value)).size() == 2);
  const auto other = sobol_indices(design, answers, {.resamples = 200, .seed = 1});
  CHECK(other.parameters[0].total.value == steps[3].parameters[0].total.value);
  CHECK(other.parameters[0].total.low != steps[3].parameters[0].total.low);
  CHECK(!sobol_indices(design, answers, {.resamples = 0}).parameters[0].first.bounded());
}
