#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/analysis/study/sensitivity/global/sobol.hpp"
#include "limcycle/tests/analysis/study/sensitivity/global/known_functions.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Removes a share of the answers, independent of their values.
void take_away(std::vector<Answer>& answers, double share, std::uint64_t seed) {
  RandomStream random(seed, "missing");
  for (auto& answer : answers)
    if (random.uniform() < share) answer.reset();
}

void check_finite(const Estimate& estimate) {
  CHECK(std::isfinite(estimate.value));
  CHECK(estimate.low <= estimate.high);
}

void check_nothing_known(const SobolIndices& found) {
  CHECK(found.notes.size() == 1);
  CHECK((std::isfinite(found.mean) && std::isfinite(found.deviation)));
  for (const auto& index : found.parameters) {
    CHECK((!index.first.known && !index.first.bounded() && index.first.value == 0.0));
    CHECK((!index.total.known && !index.total.bounded() && index.total.value == 0.0));
  }
  for (const auto& interaction : found.interactions) CHECK(!interaction.share.known);
}

}  // namespace

TEST_CASE("Sobol indices: a fifth of the answers missing at random biases none of them") {
  const auto f = ishigami();
  for (const bool second_order : {false, true}) {
    constexpr int seeds = 60;
    double sum[7] = {}, squares[7] = {};
    int held = 0;
    const double truth[7] = {f.first[0], f.first[1], f.first[2], f.total[0], f.total[1], f.total[2], f.total[2]};
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const SobolDesign design(3, 1024, second_order, seed);
      auto answers = answers_in(design, f.value);
      take_away(answers, 0.2, seed);
      const auto found = sobol_indices(design, answers, {.resamples = 200});
      CHECK(found.share_without_answer() == Approx(0.2).margin(0.03));
      REQUIRE(found.notes.size() == 1);
      const double pairs = second_order ? 2048 : 1024;
      CHECK(static_cast<double>(found.parameters[0].first_pairs) / pairs == Approx(0.64).margin(0.05));
      CHECK(static_cast<double>(found.parameters[0].total_pairs) / pairs == Approx(0.64).margin(0.05));
      const Estimate none;
      const Estimate estimates[7] = {found.parameters[0].first,
                                     found.parameters[1].first,
                                     found.parameters[2].first,
                                     found.parameters[0].total,
                                     found.parameters[1].total,
                                     found.parameters[2].total,
                                     second_order ? found.interactions[1].share : none};
      for (int k = 0; k < (second_order ? 7 : 6); ++k) {
        const double error = estimates[k].value - truth[k];
        sum[k] += error / seeds, squares[k] += error * error / seeds;
        held += estimates[k].low <= truth[k] && truth[k] <= estimates[k].high ? 1 : 0;
      }
    }
    CHECK(held >= 0.95 * seeds * (second_order ? 7 : 6));
    for (int k = 0; k < (second_order ? 7 : 6); ++k) {
      CHECK(std::sqrt(squares[k]) < 0.05);
      CHECK(std::abs(sum[k]) < 3.5 * std::sqrt(squares[k] / seeds));
    }
  }
}

TEST_CASE(
    "Sobol indices: of a number that does nothing the first index and pairs are 0 with few samples and answers "
    "missing") {
  // Chance correlations of 256 independent answers are 0.06; the part shared by A and B is subtracted.
  constexpr int seeds = 40;
  const auto y = [](const std::vector<double>& x) { return std::exp(x[0]) + 0.3 * x[1]; };
  for (const bool second_order : {false, true}) {
    double of_none = 0.0, of_both = 0.0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const SobolDesign design(4, 256, second_order, seed);
      auto answers = answers_in(design, y);
      take_away(answers, 0.05, seed);
      const auto found = sobol_indices(design, answers, {.resamples = 200});
      for (const std::size_t i : {2U, 3U}) {
        const Estimate& first = found.parameters[i].first;
        of_none += 0.5 * first.value * first.value / seeds;
        CHECK(first.high - first.low < 0.15);
      }
      if (second_order) of_both += std::pow(found.interactions.back().share.value, 2) / seeds;
    }
    CHECK(std::sqrt(of_none) < 0.03);
    CHECK(std::sqrt(of_both) < 0.01);
  }
}

TEST_CASE("Sobol indices: NaN and infinite answers are none") {
  const auto f = ishigami();
  const SobolDesign design(3, 256, true, 3);
  auto none = answers_in(design, f.value);
  auto broken = none;
  const double values[] = {nan_value, infinity, -infinity};
  for (std::size_t k = 0; k < none.size(); k += 7) none[k].reset(), broken[k] = values[k % 3];
  const auto expected = sobol_indices(design, none), found = sobol_indices(design, broken);
  CHECK(found.rows_without_answer == expected.rows_without_answer);
  CHECK((found.mean == expected.mean && found.deviation == expected.deviation));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(found.parameters[i].first.value == expected.parameters[i].first.value);
    CHECK(found.parameters[i].total.high == expected.parameters[i].total.high);
    CHECK(found.interactions[i].share.low == expected.interactions[i].share.low);
    check_finite(found.parameters[i].first);
    check_finite(found.interactions[i].share);
  }
}

TEST_CASE("Sobol indices: what answers do not tell is not known") {
  for (const bool second_order : {false, true}) {
    const SobolDesign design(3, 64, second_order, 3);
    std::vector<Answer> answers(design.rows());
    const auto nothing = sobol_indices(design, answers);
    CHECK(nothing.share_without_answer() == 1.0);
    check_nothing_known(nothing);
    for (const double constant : {0.0, 0.1, -1e300}) {
      answers.assign(design.rows(), constant);
      check_nothing_known(sobol_indices(design, answers));
    }
    // Rounding is no variance; nor is noise of known size.
    for (std::size_t k = 0; k < answers.size(); ++k) answers[k] = 0.3 + (k % 2 == 0 ? 5e-17 : 0.0);
    check_nothing_known(sobol_indices(design, answers));
    answers = answers_in(design, [](const auto& p) -> Answer { return 20.0 + 1e-7 * p[0]; });
    CHECK(sobol_indices(design, answers).parameters[0].first.value == Approx(1.0).margin(0.05));
    check_nothing_known(sobol_indices(design, answers, {.noise = 1e-7}));

    // Five complete samples have indices, but no interval; samples with an answer in row A only have neither.
    const auto complete = answers_in(design, ishigami().value);
    answers.assign(design.rows(), std::nullopt);
    std::copy_n(complete.begin(), 5 * design.rows_per_sample(), answers.begin());
    const auto few = sobol_indices(design, answers);
    CHECK(few.parameters[1].total_pairs == (second_order ? 10 : 5));
    CHECK((few.parameters[1].total.known && !few.parameters[1].total.bounded()));
    answers.assign(design.rows(), std::nullopt);
    for (std::size_t k = 0; k < 64; ++k) answers[design.row_a(k)] = complete[design.row_a(k)];
    const auto alone = sobol_indices(design, answers);
    CHECK(alone.deviation > 1.0);
    CHECK(alone.parameters[0].first_pairs == 0);
    check_nothing_known(alone);
  }
}

TEST_CASE("Sobol indices: an event seen once has no interval") {
  const SobolDesign design(2, 256, true, 3);
  std::vector<Answer> answers(design.rows(), 0.0);
  answers[design.row_a(17)] = 1.0;
  const auto found = sobol_indices(design, answers);
  CHECK(found.parameters[0].total.known);
  CHECK(!found.parameters[0].total.bounded());
}

TEST_CASE("Sobol indices: neither a large offset nor a large unit of the output changes them") {
  const auto f = ishigami();
  const SobolDesign design(3, 512, true, 3);
  const auto plain = sobol_indices(design, answers_in(design, f.value));
  const auto offset =
      sobol_indices(design, answers_in(design, [&](const auto& p) -> Answer { return 1e6 + 1e-5 * *f.value(p); }));
  const auto huge =
      sobol_indices(design, answers_in(design, [&](const auto& p) -> Answer { return 1e307 * *f.value(p); }));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(offset.parameters[i].first.value == Approx(plain.parameters[i].first.value).margin(1e-4));
    CHECK(offset.parameters[i].total.low == Approx(plain.parameters[i].total.low).margin(1e-4));
    CHECK(huge.parameters[i].total.value == Approx(plain.parameters[i].total.value).epsilon(1e-12));
    CHECK(huge.interactions[i].share.high == Approx(plain.interactions[i].share.high).epsilon(1e-9));
  }
  CHECK(huge.deviation == Approx(1e307 * plain.deviation));
}

TEST_CASE("Sobol indices: wrong questions are refused") {
  const SobolDesign design(2, 16, false, 3);
  std::vector<Answer> answers(design.rows(), 1.0);
  CHECK_THROWS_AS(sobol_indices(design, std::vector<Answer>(5)), std::invalid_argument);
  CHECK_THROWS_AS(sobol_indices(design, answers, {.samples = 17}), std::invalid_argument);
  CHECK_THROWS_AS(sobol_indices(design, answers, {.noise = -1.0}), std::invalid_argument);
  CHECK_THROWS_AS(sobol_indices(design, answers, {.noise = nan_value}), std::invalid_argument);
}
