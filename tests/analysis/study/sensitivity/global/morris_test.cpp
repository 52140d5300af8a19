#include "limcycle/analysis/study/sensitivity/global/morris.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"
#include "limcycle/tests/analysis/study/sensitivity/global/known_functions.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Answer additive(const std::vector<double>& p) { return 1000.0 + 3.0 * p[0] - 5.0 * p[1] + 0.0 * p[2]; }

}  // namespace

TEST_CASE("Morris design: every trajectory moves each parameter once, by half the range, on the middles of cells") {
  const MorrisDesign design(5, 40, 6, 7);
  std::set<double> levels;
  for (std::size_t t = 0; t < design.trajectories(); ++t) {
    std::set<std::size_t> moved;
    for (std::size_t move = 0; move < design.parameters(); ++move) {
      const auto before = design.row(design.row_of(t, move)), after = design.row(design.row_of(t, move + 1));
      moved.insert(design.moved(t, move));
      for (std::size_t i = 0; i < before.size(); ++i) {
        levels.insert(std::round(before[i] * 12));
        const double up = design.upwards(t, i) ? 1.0 : -1.0;
        CHECK(after[i] - before[i] == Approx(i == design.moved(t, move) ? 0.5 * up : 0.0).margin(1e-15));
      }
    }
    CHECK(moved.size() == design.parameters());
  }
  CHECK(levels == std::set<double>{1, 3, 5, 7, 9, 11});
  const MorrisDesign longer(5, 80, 6, 7), other(5, 40, 6, 8);
  bool same = true;
  for (std::size_t k = 0; k < design.rows(); ++k) {
    CHECK(design.row(k) == longer.row(k));
    same = same && design.row(k) == other.row(k);
  }
  CHECK(!same);
  CHECK_THROWS_AS(design.row(design.rows()), std::out_of_range);
  CHECK_THROWS_AS(MorrisDesign(2, 4, 5, 1), std::invalid_argument);
  CHECK_THROWS_AS(MorrisDesign(0, 4, 4, 1), std::invalid_argument);
  CHECK_THROWS_AS(MorrisDesign(2, 0, 4, 1), std::invalid_argument);
}

TEST_CASE("Morris: all levels and all orders are equally likely") {
  const MorrisDesign design(3, 6000, 4, 1);
  std::vector<int> start(4), first(3);
  for (std::size_t t = 0; t < design.trajectories(); ++t) {
    ++start[static_cast<std::size_t>(design.row(design.row_of(t, 0))[1] * 4)];
    ++first[design.moved(t, 0)];
  }
  for (const int one : start) CHECK(one == Approx(1500).margin(4 * 34));
  for (const int one : first) CHECK(one == Approx(2000).margin(4 * 37));
}

TEST_CASE("Morris: the effects of a sum are its coefficients, without deviation") {
  const MorrisDesign design(3, 10, 4, 2);
  const auto result = morris_effects(design, answers_in(design, additive));
  const double expected[] = {3.0, -5.0, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& effects = result.parameters[i];
    CHECK(effects.mu.value == Approx(expected[i]).margin(1e-12));
    CHECK(effects.mu_star.value == Approx(std::abs(expected[i])).margin(1e-12));
    CHECK(effects.sigma.value == Approx(0.0).margin(1e-12));
    CHECK((effects.effects == 10 && effects.without_answer == 0 && effects.mu_star.bounded()));
    CHECK(effects.mu_star.high - effects.mu_star.low < 1e-12);
  }
  CHECK(result.by_mu_star() == std::vector<std::size_t>{1, 0, 2});
  CHECK(result.notes.empty());
}

TEST_CASE("Morris: effects through an unbounded distribution are finite") {
  const SpreadParameter bell{"x",
                             0.0,
                             Distribution::normal,
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity(),
                             10.0,
                             2.0};
  const MorrisDesign design(1, 16, 8, 2);
  const auto result =
      morris_effects(design, answers_in(design, [&](const auto& p) -> Answer { return bell.quantile(p[0]); }));
  // Four steps, from quantile (k + 1/2)/8 to that and 1/2.
  double mean = 0.0, largest = 0.0, smallest = 1e9;
  for (int k = 0; k < 4; ++k) {
    const double effect = 2.0 * (bell.quantile((k + 4.5) / 8) - bell.quantile((k + 0.5) / 8));
    mean += effect / 4, largest = std::max(largest, effect), smallest = std::min(smallest, effect);
  }
  CHECK(result.parameters[0].mu_star.value > smallest);
  CHECK(result.parameters[0].mu_star.value < largest);
  CHECK(result.parameters[0].mu_star.value == Approx(mean).epsilon(0.05));
}

TEST_CASE("Morris: mean and deviation of a product, and the coverage of the interval") {
  // y = p0 p1: the effect of p0 is p1, on four levels: mean 1/2, variance 5/64. That of p1 is p0.
  const auto product = [](const std::vector<double>& p) -> Answer { return p[0] * p[1]; };
  const MorrisDesign fine(2, 20000, 4, 3);
  const auto exact = morris_effects(fine, answers_in(fine, product), 0);
  CHECK(exact.parameters[0].mu_star.value == Approx(0.5).margin(0.008));
  CHECK(exact.parameters[0].sigma.value == Approx(std::sqrt(5.0 / 64)).margin(0.008));
  CHECK(!exact.parameters[0].mu_star.bounded());
  for (const std::size_t trajectories : {10U, 30U}) {
    int held = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      const MorrisDesign design(2, trajectories, 4, seed);
      const auto result = morris_effects(design, answers_in(design, product), 400, seed);
      const Estimate& size = result.parameters[0].mu_star;
      held += size.low <= 0.5 && 0.5 <= size.high ? 1 : 0;
    }
    INFO(trajectories << " trajectories: " << held << " of 400");
    CHECK(held >= 364);
    CHECK(held <= 396);
  }
}

TEST_CASE("Morris: effects of opposite sign cancel in mu alone") {
  const MorrisDesign design(2, 200, 4, 5);
  const auto result =
      morris_effects(design, answers_in(design, [](const auto& p) -> Answer { return p[1] < 0.5 ? p[0] : -p[0]; }));
  CHECK(result.parameters[0].mu_star.value == Approx(1.0));
  CHECK(std::abs(result.parameters[0].mu.value) < 0.3);
  CHECK(result.parameters[0].sigma.value == Approx(1.0).epsilon(0.05));
}

TEST_CASE("Morris: missing answers cost their effects and nothing else") {
  const MorrisDesign design(3, 50, 4, 6);
  auto answers = answers_in(design, additive);
  RandomStream random(1, "missing");
  for (auto& answer : answers)
    if (random.uniform() < 0.2)
      answer = random.uniform() < 0.5 ? Answer() : Answer(std::numeric_limits<double>::infinity());
  answers[0] = std::numeric_limits<double>::quiet_NaN();
  const auto result = morris_effects(design, answers);
  CHECK(result.share_without_answer() == Approx(0.2).margin(0.08));
  CHECK(result.notes.size() == 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& effects = result.parameters[i];
    CHECK(effects.effects + effects.without_answer == 50);
    CHECK(effects.share_without_answer() == Approx(0.36).margin(0.2));
    CHECK(effects.sigma.value == Approx(0.0).margin(1e-12));
  }
  CHECK(result.parameters[1].mu.value == Approx(-5.0));

  std::fill(answers.begin(), answers.end(), std::nullopt);
  const auto nothing = morris_effects(design, answers);
  CHECK(nothing.share_without_answer() == 1.0);
  for (const auto& effects : nothing.parameters)
    CHECK(
        (!effects.mu.known && !effects.mu_star.known && !effects.sigma.known && effects.share_without_answer() == 1.0));

  // One effect: it has a mean, but no deviation.
  answers[design.row_of(0, 0)] = 1.0, answers[design.row_of(0, 1)] = 4.0;
  const auto one = morris_effects(design, answers).parameters[design.moved(0, 0)];
  CHECK((one.mu_star.known && one.mu_star.value == 6.0 && !one.mu_star.bounded() && !one.sigma.known));
  // Two of them, 1 and 4: deviation 3 / sqrt(2).
  std::fill(answers.begin(), answers.end(), std::nullopt);
  const std::size_t i = design.moved(0, 0);
  for (std::size_t t = 0, taken = 0; taken < 2; ++t)
    if (design.moved(t, 0) == i) {
      answers[design.row_of(t, 0)] = 0.0;
      answers[design.row_of(t, 1)] = (design.upwards(t, i) ? 0.5 : -0.5) * (taken == 0 ? 1.0 : 4.0);
      ++taken;
    }
  const auto two = morris_effects(design, answers).parameters[i];
  CHECK((two.effects == 2 && two.mu.value == Approx(2.5) && two.sigma.value == Approx(3.0 / std::sqrt(2.0))));
  CHECK_THROWS_AS(morris_effects(design, std::vector<Answer>(3)), std::invalid_argument);
}

TEST_CASE("Morris: huge answers do not overflow") {
  const MorrisDesign design(2, 20, 4, 6);
  const auto result =
      morris_effects(design, answers_in(design, [](const auto& p) -> Answer { return 1e300 * p[0] * p[1]; }));
  CHECK(result.parameters[0].mu_star.value == Approx(0.5e300).epsilon(0.5));
  CHECK(result.parameters[0].sigma.value == Approx(0.28e300).epsilon(0.5));
  CHECK(result.parameters[0].sigma.bounded());
}
