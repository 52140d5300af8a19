/// Loops with plants that are known by data, against the same loops with the known plant.
#include <catch2/catch.hpp>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/balance/roots/root_spread.hpp"
#include "limcycle/analysis/study/balance/roots/within_data.hpp"
#include "limcycle/analysis/study/composite/composite_predictions.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/measured.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;
using Complex = std::complex<double>;

namespace {

constexpr SearchBox box{1e-3, 10.0, 0.05, 50.0};

LoopParts relay_on(Plant plant) {
  LoopParts parts;
  parts.plant = std::move(plant);
  parts.element = relay(1.0);
  return parts;
}

Complex three_lags(Complex s) { return 1.0 / ((s + 1.0) * (s + 1.0) * (s + 1.0)); }

/// A servo with the LuGre set on a mass with some damping, or on the data of it.
LoopParts servo(Plant plant) {
  LoopParts parts;
  parts.plant = std::move(plant);
  parts.controller = pid(3.0, 4.0, 6.0);
  parts.friction = lugre();
  return parts;
}

PredictReport predicted(const LoopParts& parts, const SearchBox& within) {
  PredictOptions options;
  options.search = within;
  options.starts = 1;
  options.load_step = false;
  options.methods.harmonic_balance = false;
  return predict(build_loop(parts), options);
}

const Prediction* of_method(const PredictReport& report, std::string_view method) {
  const auto found = std::ranges::find(report.predictions, method, &Prediction::method);
  return found == report.predictions.end() ? nullptr : &*found;
}

double standard_deviation(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

Root only_root(const Loop& loop) {
  const auto found = find_df_roots(loop, FirstHarmonicBalance(loop), box, {});
  REQUIRE(found.roots.size() == 1);
  return found.roots.front();
}

}  // namespace

TEST_CASE(
    "measured plant: 200 points of three lags give the textbook root, and the exact cycle to the error of the fit") {
  const MeasuredPlant plant = measured_plant(sampled_response(three_lags, 0.01, 100.0, 200));
  const PredictReport report = predicted(relay_on(plant), box);
  const Prediction* root = of_method(report, "describing-function");
  REQUIRE(root != nullptr);
  CHECK(root->frequency == Approx(std::sqrt(3.0)).epsilon(1e-6));
  CHECK(root->amplitude == Approx(0.5 / 3.14159265358979).epsilon(1e-6));
  CHECK_FALSE(root->spread);
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(2.0 * 1.83987534).epsilon(1e-8));  // half period: exact condition
  CHECK(plant.measured()->fit().error.largest < 1e-8);
  CHECK(std::ranges::any_of(report.notes, [](const std::string& note) {
    return note.starts_with("loop.plant is measured (200 points") && note.find("order 3") != std::string::npos;
  }));
}

TEST_CASE("measured plant: a rough fit leaves the roots of describing functions where the data have them") {
  MeasuredPlant plant = measured_plant(sampled_response(three_lags, 0.6, 2.2, 200));
  plant.order = 2.0;
  plant.relative_degree.index = 2;
  REQUIRE(plant.measured()->fit().error.rms > 0.02);
  const Loop loop = build_loop(relay_on(plant));
  const Root root = only_root(loop);
  CHECK(root.frequency == Approx(std::sqrt(3.0)).epsilon(1e-4));
  CHECK(root.amplitude == Approx(0.5 / 3.14159265358979).epsilon(1e-4));
  // The fit alone has none: two poles never turn by half a turn.
  CHECK(find_df_roots(with_fits(loop), FirstHarmonicBalance(with_fits(loop)), box, {}).roots.empty());
}

TEST_CASE("measured plant: a servo hunts as on the known mass, by the composite root and in time") {
  const ResponseOf mass = [](Complex s) { return 1.0 / (s * (s + 0.2)); };
  const SearchBox within{1e-4, 1.0, 0.05, 50.0};
  const PredictReport known = predicted(servo(Mass{1.0, 0.2, 0.0}), within);
  const PredictReport found = predicted(servo(measured_plant(sampled_response(mass, 0.02, 100.0, 200))), within);
  const Prediction *a = of_method(found, "composite-describing-function"),
                   *b = of_method(known, "composite-describing-function");
  REQUIRE(a != nullptr);
  REQUIRE(b != nullptr);
  CHECK(a->frequency == Approx(b->frequency).epsilon(1e-4));
  CHECK(a->amplitude == Approx(b->amplitude).epsilon(1e-4));
  REQUIRE(known.cycles.size() == 1);
  REQUIRE(found.cycles.size() == 1);
  CHECK(found.cycles[0].period == Approx(known.cycles[0].period).epsilon(1e-6));
  CHECK(found.cycles[0].amplitude == Approx(known.cycles[0].amplitude).epsilon(1e-6));
}

TEST_CASE("measured plant: a composite root has the deviation that roots of many noisy data have") {
  constexpr double deviation = 1e-3;
  std::vector<double> frequency;
  std::optional<RootSpread> stated;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    MeasuredPlant plant = measured_plant(
        sampled_response([](Complex s) { return 1.0 / (s * (s + 0.2)); }, 0.02, 20.0, 20, deviation, seed));
    plant.order = 2.0;
    LoopParts parts = servo(plant);
    parts.friction = coulomb(1.1, 1.0, 0.4);  // no jump at its root
    const Loop loop = build_loop(parts);
    CompositeBalance balance(loop);
    const auto found = composite_predictions(balance, {1e-4, 1.0, 0.1, 2.0}, 2'000'000, {});
    REQUIRE(found.predictions.size() == 1);
    frequency.push_back(std::log(found.predictions[0].frequency));
    if (!stated) stated = found.predictions[0].spread;
  }
  REQUIRE(stated);
  // Of twelve the standard deviation is known to a fifth; between two points it is 0.7 to 1 of theirs.
  CHECK(standard_deviation(frequency) > 0.35 * stated->frequency);
  CHECK(standard_deviation(frequency) < 1.6 * stated->frequency);
}

TEST_CASE("measured plant: roots beyond the data, or in their gaps, are not reported, and the search says so") {
  const auto roots_between = [](double from, double to) {
    const Loop loop = build_loop(relay_on(measured_plant(sampled_response(three_lags, from, to, 60))));
    return find_df_roots(loop, FirstHarmonicBalance(loop), box, {}).roots.size();
  };
  CHECK(roots_between(0.01, 100.0) == 1);
  CHECK(roots_between(0.01, 1.7) == 0);
  CHECK(roots_between(1.8, 100.0) == 0);
  FrequencyData data = sampled_response(three_lags, 0.01, 100.0, 200);
  const auto first = std::ranges::lower_bound(data.frequency, 1.4) - data.frequency.begin();
  data.frequency.erase(data.frequency.begin() + first, data.frequency.begin() + first + 10);
  data.response.erase(data.response.begin() + first, data.response.begin() + first + 10);
  const Loop loop = build_loop(relay_on(measured_plant(data)));
  CHECK(within_data(loop, box).size() == 2);
  CHECK(find_df_roots(loop, FirstHarmonicBalance(loop), box, {}).roots.empty());
  REQUIRE(data_limits(loop, box).size() == 1);
  CHECK_THAT(data_limits(loop, box)[0], Contains("was not measured") && Contains("predict nothing there"));
  CHECK(data_limits(build_loop(relay_on(FirstOrder{1.0, 1.0})), box).empty());
}

TEST_CASE("measured plant: the deviation of a root is that of roots of many noisy data") {
  constexpr double deviation = 2e-3;
  const ResponseOf lags = [](Complex s) { return three_lags(s) * std::exp(-0.1 * s); };
  std::vector<double> amplitude, frequency;
  std::optional<RootSpread> stated;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    // Few points: a root then hangs on the two beside it.
    MeasuredPlant plant = measured_plant(sampled_response(lags, 0.05, 20.0, 25, deviation, seed));
    plant.order = 4.0;
    const Loop loop = build_loop(relay_on(plant));
    const Root root = only_root(loop);
    amplitude.push_back(std::log(root.amplitude));
    frequency.push_back(std::log(root.frequency));
    if (stated) continue;
    stated = root_spread(
        loop,
        {[](const Loop& of, double A, double w) { return FirstHarmonicBalance(of)(A, w, 1e-10); },
         [](const Loop& of, double A, double w) { return FirstHarmonicBalance(of).output_amplitude(A, w); }},
        root.amplitude, root.frequency);
    REQUIRE(stated);
  }
  // Between two points of equal deviation the interpolated one has 0.7 to 1 of it.
  CHECK(standard_deviation(amplitude) > 0.5 * stated->amplitude);
  CHECK(standard_deviation(amplitude) < 1.2 * stated->amplitude);
  CHECK(standard_deviation(frequency) > 0.5 * stated->frequency);
  CHECK(standard_deviation(frequency) < 1.2 * stated->frequency);
}
