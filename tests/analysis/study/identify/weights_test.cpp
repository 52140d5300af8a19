#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/identify/huber_loss.hpp"
#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/analysis/study/identify/record/synthesize.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

constexpr double true_level = 2.0, true_slope = 3.0;

double standard_normal(RandomStream& random) {
  const double radius = std::sqrt(-2.0 * std::log(random.uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * random.uniform());
}

/// F = 2 + 3 v over steady velocities, with these deviations.
FrictionRecord noisy_line(std::uint64_t seed, int rows, const std::function<double(int)>& deviation) {
  FrictionRecord record;
  record.name = "line";
  RandomStream random(seed, "line");
  for (int i = 1; i <= rows; ++i) {
    const double v = 0.3 * i / rows;
    record.v.push_back(v);
    record.F.push_back(true_level + true_slope * v + deviation(i) * standard_normal(random));
  }
  return record;
}

/// One row in eight reads far too high, as when a sensor catches on something.
FrictionRecord with_outliers(FrictionRecord record) {
  for (std::size_t i = 3; i < record.F.size(); i += 8) record.F[i] += 1.0 + 0.1 * static_cast<double>(i % 5);
  return record;
}

/// Coulomb friction with sigma2; Fs, which no row shows, is held.
IdentifiedLaw fitted_line(const FrictionRecord& record) {
  return identify({{kind_named("coulomb")}, {record}, {{}, {{"Fs", 10.0}}, 4}}).laws.front();
}

}  // namespace

TEST_CASE("identify weights: the fit is that of weighted linear regression, for weights in any unit") {
  const auto quiet = [](int i) { return i % 2 == 0; };
  FrictionRecord record = noisy_line(11, 40, [&](int i) { return quiet(i) ? 0.01 : 0.2; });
  double w0 = 0.0, wv = 0.0, wvv = 0.0, wF = 0.0, wvF = 0.0;
  for (int i = 1; i <= 40; ++i) {
    const auto k = static_cast<std::size_t>(i - 1);
    const double w = quiet(i) ? 400.0 : 1.0, v = record.v[k], F = record.F[k];
    record.weight.push_back(w);
    w0 += w, wv += w * v, wvv += w * v * v, wF += w * F, wvF += w * v * F;
  }
  const double slope = (w0 * wvF - wv * wF) / (w0 * wvv - wv * wv), level = (wF - slope * wv) / w0;
  const IdentifiedLaw law = fitted_line(record);
  CHECK(number_named(law, "Fc").value == Approx(level).epsilon(1e-6));
  CHECK(number_named(law, "sigma2").value == Approx(slope).epsilon(1e-5));
  const double width = *number_named(law, "Fc").high - *number_named(law, "Fc").low;
  for (double& w : record.weight) w *= 1e-3;
  const IdentifiedLaw again = fitted_line(record);
  CHECK(number_named(again, "Fc").value == Approx(number_named(law, "Fc").value).epsilon(1e-9));
  record.weight.clear();
  CHECK(*number_named(fitted_line(record), "Fc").high - *number_named(fitted_line(record), "Fc").low > 4.0 * width);
}

TEST_CASE("identify weights: a row of weight 0 is as if it were not there") {
  FrictionRecord record = with_outliers(noisy_line(5, 40, [](int) { return 0.02; })), without = record;
  record.weight.assign(record.F.size(), 1.0);
  for (std::size_t i = record.F.size(); i-- > 0;) {
    if (i < 3 || (i - 3) % 8 != 0) continue;
    record.weight[i] = 0.0;
    without.v.erase(without.v.begin() + static_cast<std::ptrdiff_t>(i));
    without.F.erase(without.F.begin() + static_cast<std::ptrdiff_t>(i));
  }
  CHECK(number_named(fitted_line(record), "Fc").value ==
        Approx(number_named(fitted_line(without), "Fc").value).epsilon(1e-12));
  record.weight[0] = -1.0;
  CHECK_THROWS_WITH(fitted_line(record), Contains("has a weight that is no finite number >= 0 in row 1"));
  record.weight.pop_back();
  CHECK_THROWS_WITH(fitted_line(record), Contains("columns of different length"));
}

TEST_CASE("identify weights: a free motion keeps to the rows that count") {
  // A mass between springs on dry friction, half of whose rows are read a hundredth of the swing too high.
  const FreeRig rig{model_of(Mass{1.0, 0.0, 400.0}), 0.0};
  const Element truth = law_with("coulomb", {{"Fc", 1.0}});
  FrictionRecord record{RecordKind::free_decay, "decay", {}, {}, {}, {}};
  const double w = 20.0, stop = 1.0 / 400.0;
  for (int i = 0; i < 360; ++i) {
    const double t = 0.004 * i, half = std::numbers::pi / w;
    const auto swing = static_cast<int>(t / half);
    const double size = 0.05 - stop - 2.0 * stop * swing, side = swing % 2 == 0 ? 1.0 : -1.0;
    const double x = side * (stop + std::max(size, 0.0) * std::cos(w * (t - swing * half)));
    record.t.push_back(t);
    record.x.push_back(x + (i % 2 == 1 ? 5e-4 : 0.0));
    record.weight.push_back(i % 2 == 1 ? 1e-6 : 1.0);
  }
  IdentifyRequest request{{kind_named("coulomb")}, {record}, {{}, {{"Fs", 1.0}}, 4}, rig};
  const auto weighted = identify(request);
  CHECK(number_named(weighted.laws.front(), "Fc").value == Approx(1.0).epsilon(2e-3));
  request.records.front().weight.clear();
  const auto plain = identify(request);
  CHECK(plain.laws.front().records.front().error > 10.0 * weighted.laws.front().records.front().error);
}

TEST_CASE("Huber's loss: continuous with its slope, and its entry has one difference") {
  for (const double r : {0.0, 0.3, 1.344, 1.346, 5.0, -80.0}) {
    const double step = 1e-6, slope = (huber_entry(r + step).entry - huber_entry(r - step).entry) / (2.0 * step);
    CHECK(huber_entry(r).slope == Approx(slope).epsilon(1e-5));
    CHECK(huber_difference(huber_entry(r).entry) == Approx(r).epsilon(1e-12).margin(1e-15));
  }
  CHECK(huber_entry(huber_limit * (1.0 + 1e-12)).entry == Approx(huber_limit).epsilon(1e-9));
  // Twice the loss: 2 k r - k^2.
  CHECK(std::pow(huber_entry(3.0).entry, 2) == Approx(2.0 * huber_limit * 3.0 - huber_limit * huber_limit));
}

TEST_CASE("Huber's loss: outliers move least squares far beyond its interval, and not it") {
  int inside = 0, all = 0, inside_without = 0;
  double widths = 0.0, widths_of_squares = 0.0;
  for (int seed = 1; seed <= samples(60); ++seed) {
    const FrictionRecord clean = noisy_line(static_cast<std::uint64_t>(seed), 120, [](int) { return 0.03; });
    FrictionRecord record = with_outliers(clean), robust_clean = clean;
    const auto squares = fitted_line(record);
    CHECK(number_named(squares, "Fc").value + 0.15 * number_named(squares, "sigma2").value > 2.5);
    record.huber = robust_clean.huber = true;
    const IdentifiedLaw law = fitted_line(record);
    CHECK(law.status == Status::converged);
    CHECK(std::abs(number_named(law, "Fc").value - true_level) < 0.04);
    CHECK_THAT(law.notes.back(), Contains("15 of 120 rows of line lie more than four deviations off"));
    CHECK(law.records.front().error == Approx(0.04).epsilon(0.4));
    // Without outliers it is as good as squares, to 95 %.
    const IdentifiedLaw own = fitted_line(robust_clean), by_squares = fitted_line(clean);
    const auto &Fc = number_named(own, "Fc"), &of_squares = number_named(by_squares, "Fc");
    widths += *Fc.high - *Fc.low;
    widths_of_squares += *of_squares.high - *of_squares.low;
    inside_without += *Fc.low <= true_level && true_level <= *Fc.high ? 1 : 0;
    inside += std::abs(number_named(law, "sigma2").value - true_slope) < 0.2 ? 1 : 0;
    ++all;
  }
  CHECK(widths == Approx(widths_of_squares).epsilon(0.12));
  CHECK(inside_without >= 0.95 * all - 3.0 * std::sqrt(0.95 * 0.05 * all));
  CHECK(inside >= 0.9 * all);
}

TEST_CASE(
    "Huber's loss: the law that the rows have is chosen, and its BIC is the least, however far the outliers are") {
  FrictionRecord record;
  record.name = "curve";
  RandomStream random(4, "curve");
  for (int i = 0; i < 160; ++i) {
    const double sign = i < 80 ? -1.0 : 1.0, v = sign * std::pow(10.0, -4.0 + 3.0 * (i % 80) / 80.0);
    const double level = 2.0 + 1.2 * std::exp(-std::pow(v / 3e-3, 2)) + (i % 11 == 5 ? 1.5 : 0.0);
    record.v.push_back(v);
    record.F.push_back(sign * level + 4.0 * v + 0.03 * standard_normal(random));
  }
  record.huber = true;
  const IdentifyReport report = identify({{kind_named("coulomb"), kind_named("stribeck")}, {record}, {}});
  CHECK(report.chosen == 1U);
  CHECK(report.laws[1].bic < report.laws[0].bic - 100.0);
  for (const auto& [name, truth] : {std::pair("Fc", 2.0), std::pair("Fs", 3.2), std::pair("vs", 3e-3)})
    CHECK(number_named(report.laws[1], name).value == Approx(truth).epsilon(0.05));
}

TEST_CASE("Huber's loss: the same law in other units of force, and refused for free motions") {
  FrictionRecord record = with_outliers(noisy_line(3, 80, [](int) { return 0.03; }));
  record.huber = true;
  const double here = number_named(fitted_line(record), "Fc").value;
  for (double& F : record.F) F *= 1e3;
  const auto law = identify({{kind_named("coulomb")}, {record}, {{}, {{"Fs", 1e4}}, 4}}).laws.front();
  CHECK(number_named(law, "Fc").value == Approx(1e3 * here).epsilon(1e-5));
  record.kind = RecordKind::free;
  CHECK_THROWS_WITH(fitted_line(record), Contains("Huber's loss is for a friction force that was measured"));
}
