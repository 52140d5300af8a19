#include "limcycle/analysis/frequency/describing_function/error_band.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/tests/analysis/predictions.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

const std::vector<double> three_lags{1.0, 3.0, 3.0, 1.0};

DeadZone<double> dead_zone(double half_width) {
  DeadZone<double> element;
  element.half_width = half_width;
  return element;
}

/// Claims, section C: G = -s/(s^2 + 0.8 s + 8).
Loop khalil() { return forward(saturation(1.0), {-1.0, 0.0}, {1.0, 0.8, 8.0}); }

/// Amplitude at which the unit saturation has this gain, by bisection on the closed form of claim A6.
double amplitude_of_gain(double wanted) {
  double low = 1.0, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high), u = 1.0 / middle;
    (2.0 / M_PI * (std::asin(u) + u * std::sqrt(1.0 - u * u)) > wanted ? low : high) = middle;
  }
  return low;
}

double rho_by_brute_force(const Loop& loop, double centre, double w) {
  double least = infinite;
  for (int k = 3; k < 4001; k += 2) {
    const std::complex<double> G = -loop.element_response(k * w)(0, 0);
    least = std::min(least, std::abs(centre + 1.0 / G));
  }
  return least;
}

std::vector<Loop> various() {
  LoopParts servo;
  servo.plant = Mass{2.0, 0.3, 0.0};
  servo.controller = pid(3.0, 1.0, 0.5);
  servo.element = saturation(1.0);
  return {khalil(), forward(saturation(1.0), {10.0}, three_lags),
          forward(dead_zone(0.1), {1e-3, 10.0}, {1e-6, 1e-2, 1.0, 0.0}),
          forward(saturation(0.1), {1.0, 0.1, 4.0}, {1.0, 0.2, 9.0, 0.5, 1.0}), build_loop(servo)};
}

}  // namespace

TEST_CASE("1/G over an interval of frequency: the enclosures hold, and shrink with the interval") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const Loop& loop : various()) {
    const auto G = RationalResponse::of(loop);
    REQUIRE(G);
    for (int i = 0; i < 200; ++i) {
      const double low = G->scale() * std::pow(10.0, 6.0 * part(random) - 3.0);
      const Interval w{low, low * (1.0 + std::pow(10.0, -4.0 * part(random)))};
      const auto disc = G->inverse(w);
      const double c = 2.0 * part(random) - 1.0, gamma = part(random);
      const bool farther = G->farther_than(gamma, c, w);
      for (int n = 0; n < 10; ++n) {
        const double at = w.low + (w.high - w.low) * part(random);
        const auto truth = -1.0 / loop.element_response(at)(0, 0);
        CHECK(std::abs(G->inverse(at) - truth) <= 1e-9 * std::abs(truth));
        CHECK(std::abs(truth - disc.centre) <= disc.radius + 1e-9 * std::abs(truth));
        CHECK(std::abs(c + truth) >= G->distance(c, w) - 1e-9 * std::abs(truth));
        if (farther) CHECK(std::abs(c + truth) > gamma - 1e-9 * std::abs(truth));
        CHECK(std::abs(-1.0 / loop.element_response(at * (1.0 + 9.0 * part(random)))(0, 0)) >=
              G->growth(w.low) * (1.0 - 1e-9));
      }
    }
    const auto radius = [&](double width) {
      return G->inverse(Interval{G->scale(), G->scale() * (1.0 + width)}).radius;
    };
    CHECK(radius(1e-4) < 0.11 * radius(1e-3));
    CHECK(radius(1e-3) > 0.0);
    CHECK(G->growth(1e6 * G->scale()) > 100.0 * G->growth(1e3 * G->scale()));
  }
}

TEST_CASE("rho and sigma: against brute force over 2000 harmonics") {
  for (const Loop& loop : various()) {
    const ErrorBand band(loop);
    CHECK(band.alpha() == 0.0);
    CHECK(band.beta() == 1.0);
    for (const double w : {0.02, 0.05, 0.3, 1.0, 2.7, 30.0}) {
      const double truth = rho_by_brute_force(loop, 0.5, w);
      CHECK(band.filtered(w) == (truth > 0.5));
      if (!band.filtered(w)) {
        CHECK(std::isinf(band.sigma(w)));
        continue;
      }
      CHECK(band.rho(w) == Approx(truth).epsilon(1e-9));
      CHECK(band.sigma(w) == Approx(0.25 / (truth - 0.5)).epsilon(1e-9));
    }
  }
}

TEST_CASE("a harmonic on a pole of the loop is never filtered") {
  // Undamped resonance at 3 rad/s, where 1/G = 0: the third harmonic of 1 rad/s.
  const ErrorBand band(forward(saturation(1.0), {1.0}, {1.0, 1.0, 9.0, 9.0}));
  CHECK_FALSE(band.filtered(1.0));
  CHECK_FALSE(band.filtered(0.6));
  CHECK(band.existence(1.0, 1.5).verdict == BandVerdict::undecided);
}

TEST_CASE("the worked example of section C of the claims") {
  const ErrorBand band(khalil());
  const double w = std::sqrt(8.0), a = amplitude_of_gain(0.8);
  CHECK(a == Approx(1.455501).epsilon(1e-6));
  CHECK(band.rho(w) == Approx(7.548).epsilon(1e-4));
  CHECK(band.sigma(w) == Approx(0.035469).epsilon(1e-5));
  const Existence found = band.existence(w, a);
  CHECK(found.verdict == BandVerdict::proved);
  CHECK(found.frequency.low == Approx(2.81060).epsilon(2e-6));
  CHECK(found.frequency.high == Approx(2.84606).epsilon(4e-6));
  CHECK(found.amplitude.low == Approx(1.37658).epsilon(4e-6));
  CHECK(found.amplitude.high == Approx(1.53943).epsilon(4e-6));
  // The true solution of the claims.
  CHECK(found.frequency.low < 2.825810);
  CHECK(2.825810 < found.frequency.high);
  CHECK(found.amplitude.low < 1.455914);
  CHECK(1.455914 < found.amplitude.high);
}

TEST_CASE("on the border of the proved rectangle no disc meets -Psi") {
  for (const Loop& loop : {khalil(), forward(saturation(1.0), {10.0}, three_lags)}) {
    const ErrorBand band(loop);
    const double w0 = loop.states() == 2 ? std::sqrt(8.0) : std::sqrt(3.0);
    const Existence found = band.existence(w0, amplitude_of_gain(0.8));
    REQUIRE(found.verdict == BandVerdict::proved);
    const auto excess = [&](double w, double a) {
      return std::abs(band.inverse_response(w) + band.gain(a)) - band.sigma(w);
    };
    const auto between = [](Interval range, int i) { return range.low + (range.high - range.low) * i / 50.0; };
    double nearest = infinite;
    for (int i = 0; i <= 50; ++i) {
      const double w = between(found.frequency, i), a = between(found.amplitude, i);
      for (const double out : {excess(found.frequency.low, a), excess(found.frequency.high, a),
                               excess(w, found.amplitude.low), excess(w, found.amplitude.high)}) {
        CHECK(out > 0.0);
        nearest = std::min(nearest, out);
      }
    }
    CHECK(nearest < 1e-3);  // and it is not unnecessarily large
  }
}

TEST_CASE("cycles found by shooting lie in the proved band") {
  std::vector<Loop> loops{khalil(), forward(saturation(1.0), {10.0}, three_lags),
                          forward(saturation(0.2), {6.0}, {1.0, 4.0, 6.0, 4.0, 1.0}),
                          forward(saturation(1.0), {3.0}, {1.0, 2.0, 1.0, 0.0}),
                          forward(dead_zone(0.1), {10.0}, three_lags)};
  for (const Loop& loop : loops) {
    const auto report = predict(loop, df_only());
    REQUIRE(report.predictions.size() == 1);
    REQUIRE(report.cycles.size() == 1);
    const Cycle& cycle = report.cycles[0];
    const auto found =
        ErrorBand(loop).existence(report.predictions[0].frequency, report.predictions[0].input_amplitude);
    REQUIRE(found.verdict == BandVerdict::proved);
    CHECK(found.frequency.low < cycle.frequency());
    CHECK(cycle.frequency() < found.frequency.high);
    CHECK(found.amplitude.low < cycle.first_harmonic);  // x = -y in these loops
    CHECK(cycle.first_harmonic < found.amplitude.high);
    const double sigma = ErrorBand(loop).sigma(cycle.frequency());
    CHECK(std::abs(ErrorBand(loop).inverse_response(cycle.frequency()) + ErrorBand(loop).gain(cycle.first_harmonic)) <
          sigma);
  }
}

TEST_CASE("what cannot be proved is undecided, with the reason") {
  const auto why = [](const Loop& loop, double w, double a) {
    const Existence answer = ErrorBand(loop).existence(w, a);
    CHECK(answer.verdict == BandVerdict::undecided);
    return answer.why;
  };
  using Catch::Matchers::Contains;
  const double w = std::sqrt(3.0);
  CHECK_THAT(why(forward(saturation(1.0), {1000.0}, three_lags), w, amplitude_of_gain(0.008)),
             Contains("does not filter enough"));
  CHECK_THAT(why(forward(saturation(1.0), {8.1}, three_lags), w, amplitude_of_gain(8.0 / 8.1)),
             Contains("towards small amplitudes"));
  CHECK_THAT(why(forward(dead_zone(0.1), {8.1}, three_lags), w, 0.1 * 80.0), Contains("towards large amplitudes"));
  CHECK_THAT(why(khalil(), 2.0, 1.4), Contains("no root"));
}

TEST_CASE("absence: proved by the circle criterion or by the discs, never where a cycle is") {
  const SearchBox box{1e-3, 100.0, 0.01, 100.0};
  const auto answer = [](const Loop& loop, const SearchBox& where) { return ErrorBand(loop).absence(where); };
  for (const double K : {0.1, 1.0, 3.9})  // Re G > -1 for K < 4
    CHECK(answer(forward(saturation(1.0), {K}, three_lags), box).verdict == BandVerdict::proved);
  // An integrator: the margin of the criterion is w^4 at low frequency.
  CHECK(answer(forward(saturation(1.0), {1.0}, {1.0, 1.0, 0.0}), box).verdict == BandVerdict::proved);
  // Between the circle criterion and the first root of the describing function (K = 8): low frequencies stay open.
  const Loop middle = forward(saturation(1.0), {6.0}, three_lags);
  const Absence open = answer(middle, box);
  CHECK(open.verdict == BandVerdict::undecided);
  REQUIRE_FALSE(open.undecided.empty());
  CHECK(open.undecided.front().low == Approx(0.01));
  CHECK(open.undecided.back().high < 1.0);
  for (std::size_t i = 0; i + 1 < open.undecided.size(); ++i) CHECK(open.undecided[i].high < open.undecided[i + 1].low);
  // Where it is not undecided, absence is proved: the box above the last open frequency. There the discs are needed.
  const SearchBox above{1e-3, 100.0, open.undecided.back().high * 1.001, 100.0};
  CHECK(answer(middle, above).verdict == BandVerdict::proved);

  const Loop cycling = forward(saturation(1.0), {10.0}, three_lags);  // true cycle: w = 1.72816, a = 1.46752
  const Absence around = answer(cycling, box);
  CHECK(around.verdict == BandVerdict::undecided);
  CHECK(std::ranges::any_of(around.undecided, [](const Interval& w) { return w.low < 1.72816 && 1.72816 < w.high; }));
  CHECK(answer(cycling, {1.4, 1.5, 1.72, 1.74}).verdict == BandVerdict::undecided);
  CHECK(answer(cycling, {1e-3, 100.0, 1.77, 100.0}).verdict == BandVerdict::proved);
  CHECK(answer(cycling, {1e-3, 100.0, 1.2, 1.69}).verdict == BandVerdict::proved);
  // Amplitudes away from the cycle: Psi(2) = 0.61 and Psi(1.2) = 0.94 are outside the discs about 0.8.
  CHECK(answer(cycling, {2.0, 100.0, 1.2, 100.0}).verdict == BandVerdict::proved);
  CHECK(answer(cycling, {0.1, 1.2, 1.2, 100.0}).verdict == BandVerdict::proved);
}

TEST_CASE("the theorem is refused where a condition fails") {
  using Catch::Matchers::Contains;
  const auto why = [](const Loop& loop) {
    const auto sentence = ErrorBand::not_applicable(loop);
    REQUIRE(sentence);
    CHECK_THROWS_AS(ErrorBand(loop), std::invalid_argument);
    return *sentence;
  };
  CHECK_THAT(why(forward(relay(1.0), {1.0}, three_lags)), Contains("bounded slopes"));
  Cubic<double> cubic;
  cubic.coefficient = 1.0;
  CHECK_THAT(why(forward(cubic, {1.0}, three_lags)), Contains("bounded slopes"));
  Backlash<double> backlash;
  backlash.half_gap = 1.0;
  CHECK_THAT(why(forward(backlash, {1.0}, three_lags)), Contains("bounded slopes"));
  CHECK_THAT(why(servo(coulomb(1.0, 1.0))), Contains("bounded slopes"));
  LoopParts parts;
  parts.plant = TransferFunction{{10.0}, three_lags, 0.0};
  parts.element = saturation(1.0);
  CHECK_FALSE(ErrorBand::not_applicable(build_loop(parts)));
  parts.reference = 0.3;
  CHECK_THAT(why(build_loop(parts)), Contains("bias"));
  parts.reference = 0.0;
  parts.plant = TransferFunction{{10.0}, three_lags, 0.1};
  CHECK_THAT(why(build_loop(parts)), Contains("delay"));
  auto limited = servo_parts(coulomb(1.0, 1.0));
  auto controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 2.0;
  limited.controller = controller;
  CHECK_THAT(why(build_loop(limited)), Contains("one nonlinear element"));
}
