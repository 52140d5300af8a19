#include "limcycle/analysis/study/sensitivity/global/probability_estimate.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>

#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

#include "limcycle/analysis/study/sensitivity/global/sobol.hpp"
#include "limcycle/tests/analysis/study/sensitivity/global/known_functions.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Share of samples whose interval holds the true probability.
double coverage(double probability_of_yes, unsigned samples) {
  double held = 0.0;
  for (unsigned yes = 0; yes <= samples; ++yes) {
    const Estimate share = probability_estimate(yes, samples);
    if (share.low <= probability_of_yes && probability_of_yes <= share.high)
      held += gsl_ran_binomial_pdf(yes, probability_of_yes, samples);
  }
  return held;
}

}  // namespace

TEST_CASE("share of samples: Wilson's interval as published, and at its ends") {
  // R. G. Newcombe, Statistics in Medicine 17 (1998), table I, method 3.
  const Estimate many = probability_estimate(81, 263), few = probability_estimate(15, 148),
                 none = probability_estimate(0, 20), one = probability_estimate(1, 29);
  CHECK(many.low == Approx(0.2553).margin(5e-5));
  CHECK(many.high == Approx(0.3662).margin(5e-5));
  CHECK(few.low == Approx(0.0624).margin(5e-5));
  CHECK(few.high == Approx(0.1605).margin(5e-5));
  CHECK(none.low == 0.0);
  CHECK(none.high == Approx(0.1611).margin(5e-5));
  CHECK(one.low == Approx(0.0061).margin(5e-5));
  CHECK(one.high == Approx(0.1718).margin(5e-5));
  CHECK((probability_estimate(20, 20).high == 1.0 && probability_estimate(20, 20).low == Approx(1.0 - none.high)));
  const Estimate nothing = probability_estimate(0, 0);
  CHECK((!nothing.known && nothing.low == 0.0 && nothing.high == 1.0));
  CHECK_THROWS_AS(probability_estimate(3, 2), std::invalid_argument);
}

TEST_CASE("share of samples: coverage by the exact binomial distribution is what is said of it") {
  for (const auto& [samples, least, most] : {std::tuple(20U, 0.92, 0.985), std::tuple(200U, 0.93, 0.97)}) {
    double lowest = 1.0, highest = 0.0, sum = 0.0;
    for (int k = 0; k <= 800; ++k) {
      const double held = coverage(0.1 + 0.001 * k, samples);
      lowest = std::min(lowest, held), highest = std::max(highest, held), sum += held / 801;
    }
    INFO(samples << " samples: " << lowest << " to " << highest << ", mean " << sum);
    CHECK(lowest > least);
    CHECK(highest < most);
    CHECK(sum == Approx(0.95).margin(0.01));
  }
  double worst = 1.0;
  for (int k = 1; k <= 1000; ++k) worst = std::min(worst, coverage(1e-5 * k, 200));
  CHECK(worst == Approx(0.83).margin(0.01));
}

TEST_CASE("probability: undecided samples widen it to whatever they may be") {
  const Probability p = probability(30, 50, 20);
  CHECK(p.among_decided.value == Approx(0.375));
  CHECK(p.low == probability_estimate(30, 100).low);
  CHECK(p.high == probability_estimate(50, 100).high);
  CHECK((p.low < p.among_decided.low && p.high > p.among_decided.high));
  const Probability none = probability(0, 0, 9);
  CHECK((!none.among_decided.known && none.low == 0.0 && none.high == 1.0));
}

TEST_CASE("probability: over the rows A and B of a design its interval holds the truth") {
  int held = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const SobolDesign design(2, 64, true, seed);
    const auto answers = answers_in(design, [](const auto& p) -> Answer { return p[0] * p[1] < 0.1 ? 1.0 : 0.0; });
    std::size_t yes = 0;
    for (std::size_t k = 0; k < 64; ++k)
      for (const std::size_t row : {design.row_a(k), design.row_b(k)}) yes += *answers[row] > 0.5 ? 1 : 0;
    const Probability p = probability(yes, 128 - yes, 0);
    held += p.low <= 0.1 * (1.0 + std::log(10.0)) && 0.1 * (1.0 + std::log(10.0)) <= p.high ? 1 : 0;
  }
  CHECK(held >= 95);
}

TEST_CASE("probability: which parameter decides is seen in the indices of yes and no") {
  const SobolDesign design(3, 1024, false, 4);
  const auto answers = answers_in(design, [](const auto& p) -> Answer { return p[2] < 0.3 && p[0] < 0.5 ? 1.0 : 0.0; });
  const auto indices = sobol_indices(design, answers);
  CHECK(indices.by_total() == std::vector<std::size_t>{2, 0, 1});
  // P = 0.15: Var(E[y | x]) = P^2 (1 / p - 1), where x < p is needed.
  const double v = 0.15 * 0.85;
  CHECK(indices.parameters[2].first.value == Approx(0.15 * 0.15 * (1 / 0.3 - 1) / v).margin(0.03));
  CHECK(indices.parameters[0].first.value == Approx(0.15 * 0.15 / v).margin(0.03));
  CHECK(indices.parameters[2].total.value == Approx(1 - 0.15 * 0.15 / v).margin(0.03));
  CHECK(indices.parameters[1].total.value == 0.0);
}
