#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "known_functions.hpp"
#include "limcycle/analysis/study/global/random_stream.hpp"
#include "limcycle/analysis/study/global/sobol.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Takes a share of the answers away, whatever they are.
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
    for (int k = 0; k < 7; ++k) {
      printf("%.4f ", std::sqrt(squares[k]));
      if (k == 6) puts("");
    }
    CHECK(held >= 0.95 * seeds * (second_order ? 7 : 6));
    for (int k = 0; k < (second_order ? 7 : 6); ++k) {
      CHECK(std::sqrt(squares[k]) < 0.05);
      CHECK(std::abs(sum[k]) < 3.5 * std::sqrt(squares[k] / seeds));
    }
  }
}

TEST_CASE("Sobol indices: answers in a box alone give the indices of that box") {
  const auto f = ishigami();
  const auto inside = [&](const std::vector<double>& p) { return f.value({0.6 * p[0], 0.25 + 0.75 * p[1], p[2]}); };
  for (const bool second_order : {false, true}) {
    const SobolDesign design(3, 16384, second_order, 3);
    const auto box = sobol_indices(design, answers_in(design, inside));
    const auto part = sobol_indices(design, answers_in(design, [&](const auto& p) {
                                      return p[0] < 0.6 && p[1] > 0.25 ? f.value(p) : std::nullopt;
                                    }));
    CHECK(part.share_without_answer() == Approx(0.55).margin(0.005));
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(part.parameters[i].first.value == Approx(box.parameters[i].first.value).margin(0.01));
      CHECK(part.parameters[i].total.value == Approx(box.parameters[i].total.value).margin(0.01));
    }
  }
}

namespace {

/// Brute force on a grid: indices of y(x, z) in the part of the square where it answers.
class PartOfSquare {
 public:
  using Function = std::function<Answer(double, double)>;
  explicit PartOfSquare(Function y) : y_(std::move(y)) {
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j)
        if (const auto v = y_(at(i), at(j))) sum_ += *v, squares_ += *v * *v, count_ += 1.0;
  }
  double mean() const { return sum_ / count_; }
  double variance() const { return squares_ / count_ - mean() * mean(); }

  /// Var(E[y | x]) with x alone or z alone, by its definition.
  double first_variance(bool of_x) const {
    double found = 0.0;
    for (int i = 0; i < cells; ++i) {
      double sum = 0.0, count = 0.0;
      for (int j = 0; j < cells; ++j)
        if (const auto v = along(of_x, i, j)) sum += *v, count += 1.0;
      if (count > 0.0) found += count * std::pow(sum / count - mean(), 2) / count_;
    }
    return found;
  }

 private:
  static constexpr int cells = 500;
  static double at(int k) { return (k + 0.5) / cells; }
  Answer along(bool x_first, int i, int j) const { return x_first ? y_(at(i), at(j)) : y_(at(j), at(i)); }

  Function y_;
  double sum_ = 0.0, squares_ = 0.0, count_ = 0.0;
};

}  // namespace

TEST_CASE("Sobol indices: where answers lie in an oblique part of the space, they are those of that part") {
  const PartOfSquare::Function functions[] = {
      [](double x, double z) -> Answer { return x + z < 1.2 ? Answer(x + 2 * z) : std::nullopt; },
      [](double x, double z) -> Answer { return x + z > 0.6 ? Answer(x * z + std::sin(5 * x)) : std::nullopt; },
      [](double x, double z) -> Answer {
        return std::hypot(x - 0.5, z - 0.5) < 0.5 ? Answer(std::exp(x) + 3 * x * z * z) : std::nullopt;
      }};
  for (const auto& y : functions) {
    const PartOfSquare part(y);
    for (const bool second_order : {false, true}) {
      const SobolDesign design(2, 16384, second_order, 3);
      const auto found = sobol_indices(design, answers_in(design, [&](const auto& p) { return y(p[0], p[1]); }));
      REQUIRE(found.notes.size() == 1);
      CHECK(found.mean == Approx(part.mean()).epsilon(0.002));
      CHECK(found.deviation == Approx(std::sqrt(part.variance())).epsilon(0.003));
      for (std::size_t i = 0; i < 2; ++i) {
        const double first = part.first_variance(i == 0) / part.variance();
        const double total = 1.0 - part.first_variance(i != 0) / part.variance();
        CHECK(found.parameters[i].first.value == Approx(first).margin(0.006));
        CHECK(found.parameters[i].total.value == Approx(total).margin(0.01));
      }
    }
  }
}

namespace {

/// E[Var(y | all but x_i)] / Var(y) by its definition, on a grid in the part of the cube where y answers.
double total_in_cube(const std::function<Answer(const std::vector<double>&)>& y, std::size_t i) {
  constexpr int cells = 80;
  const auto at = [](int k) { return (k + 0.5) / cells; };
  double sum = 0.0, squares = 0.0, count = 0.0, within = 0.0;
  for (int j = 0; j < cells; ++j)
    for (int k = 0; k < cells; ++k) {
      double line_sum = 0.0, line_squares = 0.0, line = 0.0;
      std::vector<double> p(3);
      p[(i + 1) % 3] = at(j), p[(i + 2) % 3] = at(k);
      for (int l = 0; l < cells; ++l) {
        p[i] = at(l);
        if (const auto v = y(p)) line_sum += *v, line_squares += *v * *v, line += 1.0;
      }
      sum += line_sum, squares += line_squares, count += line;
      if (line > 0.0) within += line_squares - line_sum * line_sum / line;
    }
  return within / (squares - sum * sum / count);
}

}  // namespace

TEST_CASE("Sobol indices: total ones where answers depend on three parameters are as near as is said") {
  const std::function<Answer(const std::vector<double>&)> functions[] = {
      [](const auto& p) { return p[0] + p[1] + p[2] < 1.3 ? Answer(p[0] + 2 * p[1] + p[0] * p[2]) : std::nullopt; },
      [](const auto& p) { return p[0] * p[1] * p[2] > 0.1 ? Answer(p[0] + std::sin(6 * p[1]) * p[2]) : std::nullopt; }};
  double furthest = 0.0;
  for (const auto& y : functions)
    for (const bool second_order : {false, true}) {
      const SobolDesign design(3, 16384, second_order, 2);
      const auto found = sobol_indices(design, answers_in(design, y), {.resamples = 0});
      for (std::size_t i = 0; i < 3; ++i)
        furthest = std::max(furthest, std::abs(found.parameters[i].total.value - total_in_cube(y, i)));
    }
  INFO(furthest);
  CHECK(furthest < 0.015);
}

TEST_CASE("Sobol indices: interactions where answers lie in an oblique part of the space") {
  // x z + w / 2 where x + z < 1.2: w is independent of the others there.
  const PartOfSquare part([](double x, double z) -> Answer { return x + z < 1.2 ? Answer(x * z) : std::nullopt; });
  const double of_w = 0.25 / 12.0, variance = part.variance() + of_w;
  const SobolDesign design(3, 16384, true, 5);
  const auto found = sobol_indices(design, answers_in(design, [](const auto& p) {
                                     return p[0] + p[1] < 1.2 ? Answer(p[0] * p[1] + 0.5 * p[2]) : std::nullopt;
                                   }));
  const double first = part.first_variance(true) / variance;
  CHECK(found.parameters[0].first.value == Approx(first).margin(0.006));
  CHECK(found.parameters[1].first.value == Approx(first).margin(0.006));
  CHECK(found.parameters[2].first.value == Approx(of_w / variance).margin(0.006));
  CHECK(found.interactions[0].share.value == Approx(part.variance() / variance - 2 * first).margin(0.015));
  CHECK(found.interactions[1].share.value == Approx(0.0).margin(0.015));
  CHECK(found.interactions[2].share.value == Approx(0.0).margin(0.015));
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
    // Rounding is no variance; noise that is known of is none either.
    for (std::size_t k = 0; k < answers.size(); ++k) answers[k] = 0.3 + (k % 2 == 0 ? 5e-17 : 0.0);
    check_nothing_known(sobol_indices(design, answers));
    answers = answers_in(design, [](const auto& p) -> Answer { return 20.0 + 1e-7 * p[0]; });
    CHECK(sobol_indices(design, answers).parameters[0].first.value == Approx(1.0).margin(0.05));
    check_nothing_known(sobol_indices(design, answers, {.noise = 1e-7}));

    // Five complete samples have indices, but no interval; where only row A answered there is nothing.
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
