#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <utility>

#include "limcycle/analysis/study/sensitivity/global/sobol.hpp"
#include "limcycle/tests/analysis/study/sensitivity/global/known_functions.hpp"

// Answers in a part of the space only: the indices are those of that part.
using namespace limcycle;
using namespace limcycle::test;

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
