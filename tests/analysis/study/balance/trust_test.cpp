#include "limcycle/analysis/study/balance/trust.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/tests/analysis/predictions.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

const std::vector<double> three_lags{1.0, 3.0, 3.0, 1.0};

bool holds(const Interval& range, double value) { return range.low <= value && value <= range.high; }

Trust trust_of(const Loop& loop, double amplitude, double frequency) {
  return trust(loop, FirstHarmonicBalance(loop), amplitude, frequency);
}

/// Every prediction with a cycle has it in its band, which is not excessively wide.
void check_bands(const Loop& loop, std::size_t expected, std::optional<SearchBox> box = {}) {
  const auto report = predict(loop, df_only(box));
  std::size_t checked = 0;
  for (const auto& p : report.predictions) {
    REQUIRE(p.trust);
    if (!p.cycle) continue;
    const Cycle& cycle = report.cycles[*p.cycle];
    const Band& band = p.trust->band;
    CHECK(band.kind == BandKind::heuristic);
    CHECK(band.verdict == BandVerdict::undecided);
    CHECK(holds(band.frequency, cycle.frequency()));
    CHECK(holds(band.amplitude, cycle.first_harmonic));
    CHECK(holds(band.frequency, p.frequency));
    CHECK(holds(band.amplitude, p.amplitude));
    CHECK(band.frequency.high < 2.0 * band.frequency.low);
    CHECK(band.amplitude.high < 2.2 * band.amplitude.low);
    ++checked;
  }
  CHECK(checked == expected);
}

}  // namespace

TEST_CASE("relay with three lags: the indicators in closed form") {
  // Harmonics of the square wave are 1/n of the first, G(jnw) = (1 + jnw)^-3.
  const double w = std::sqrt(3.0), A = 0.5 / std::numbers::pi;
  const auto back = [&](int n) { return std::pow(4.0 / (1.0 + 3.0 * n * n), 1.5) / n; };
  const Trust t = trust_of(forward(relay(1.0), {1.0}, three_lags), A, w);
  CHECK(t.filter_ratio == Approx(back(3)).epsilon(1e-6));
  CHECK(t.worst_harmonic == 3);
  CHECK(t.harmonic_residual == Approx(std::hypot(back(3), back(5), back(7))).epsilon(1e-6));
  CHECK(t.sticking_fraction == 0.0);
  CHECK(t.band.kind == BandKind::heuristic);
  CHECK_THAT(t.band.why, Contains("heuristic") && Contains("bounded slopes"));
  CHECK_THAT(t.sentence, Contains("third harmonic fairly well") && Contains("up to about 7.7 %"));
  // f = 1 - (A0/A)(w-part): df/dlnA = 1, d ln G/d ln w = -3jw/(1 + jw); the half-widths follow from the definition.
  const double radius = 2.0 * t.harmonic_residual / (1.0 - t.harmonic_residual);
  const std::complex<double> dw = std::complex<double>(0.0, 3.0 * w) / std::complex<double>(1.0, w);
  CHECK(t.band.frequency.high == Approx(w * std::exp(radius / std::abs(dw.imag()))).epsilon(1e-5));
  CHECK(t.band.input_amplitude.low == Approx(A * std::exp(-radius * std::abs(dw / dw.imag()))).epsilon(1e-5));
  // The disc: centre 1/G, radius relative to it as large, mapped by z -> 1/z. Its ends on the ray through G are known.
  REQUIRE(t.band.discs.size() == 1);
  const auto& disc = t.band.discs[0];
  CHECK(disc.centre.real() - disc.radius == Approx(-0.125 / (1.0 - radius)).epsilon(1e-5));
  CHECK(disc.centre.real() + disc.radius == Approx(-0.125 / (1.0 + radius)).epsilon(1e-5));
  CHECK(std::abs(disc.centre.imag()) < 1e-9);
}

TEST_CASE("relay loops: the true cycle lies in the heuristic band") {
  check_bands(forward(relay(1.0), {1.0}, three_lags), 1);
  check_bands(forward(relay(1.0), {1.0}, {1.0, 2.0, 1.0, 0.0}), 1);
  check_bands(forward(relay(1.0, 0.1), {1.0}, {1.0, 1.0, 0.0}), 1);
  check_bands(forward(relay(1.0, 0.02), {1.0}, three_lags), 1);
  check_bands(forward(relay(1.0, 0.2), {1.0}, {1.0, 2.0, 1.0}), 1);
  check_bands(forward(relay(1.0, 0.0, 0.05), {1.0}, three_lags), 2);
  check_bands(forward(relay(1.0), {1.0}, {1.0, 4.0, 6.0, 4.0, 1.0}), 1);
  check_bands(forward(relay(1.0), {1.0}, {1.0, 0.4, 1.2, 0.2}), 1);
  check_bands(forward(relay(1.0), {-1.0, 1.0}, {1.0, 2.0, 1.0}), 1);
}

TEST_CASE("van der Pol and a PI loop with a relay: the true cycle lies in the heuristic band") {
  Cubic<double> cubic;
  cubic.coefficient = 1.0;
  for (const double mu : {0.1, 0.5, 1.0})
    check_bands(forward(cubic, {mu / 3.0, 0.0}, {1.0, -mu, 1.0}), 1, SearchBox{0.1, 10.0, 0.1, 10.0});
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, three_lags, 0.0};
  parts.controller = pid(12.0, 1.0, 0.0);
  parts.element = relay(1.0);
  check_bands(build_loop(parts), 1, SearchBox{0.1, 100.0, 0.05, 100.0});
}

TEST_CASE("saturation behind a PI controller: proved, and the band is that of y as well as of the input") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, three_lags, 0.0};
  parts.controller = pid(12.0, 1.0, 0.0);
  parts.element = saturation(1.0);
  const auto report = predict(build_loop(parts), df_only(SearchBox{0.1, 100.0, 0.05, 100.0}));
  REQUIRE(report.predictions.size() == 1);
  REQUIRE(report.cycles.size() == 1);
  const Prediction& p = report.predictions[0];
  const Band& band = p.trust->band;
  CHECK(band.kind == BandKind::rigorous);
  CHECK(band.verdict == BandVerdict::proved);
  CHECK(holds(band.frequency, report.cycles[0].frequency()));
  CHECK(holds(band.amplitude, report.cycles[0].first_harmonic));
  CHECK(holds(band.amplitude, p.amplitude));
  CHECK(holds(band.input_amplitude, p.input_amplitude));
  CHECK(band.amplitude.high < 0.2);  // |C| is about 12
  CHECK(band.discs.size() == 9);
  CHECK_THAT(p.trust->sentence, Contains("is proved"));
  CHECK_FALSE(report.absence);
}

TEST_CASE("the discs drawn are the images of the error discs about 1/G") {
  const Loop loop = forward(saturation(1.0), {10.0}, three_lags);
  const ErrorBand rigorous(loop);
  const Trust t = trust_of(loop, 1.4555, std::sqrt(3.0));
  REQUIRE(t.band.kind == BandKind::rigorous);
  CHECK(t.filter_ratio < 0.01);
  for (const auto& disc : t.band.discs)
    for (int i = 0; i < 12; ++i) {
      const auto z = disc.centre + std::polar(disc.radius, std::numbers::pi * i / 6.0);
      CHECK(std::abs(1.0 / z - rigorous.inverse_response(disc.frequency)) ==
            Approx(rigorous.sigma(disc.frequency)).epsilon(1e-9));
    }
}

TEST_CASE("where the theorem does not decide, the band is heuristic and says why") {
  const Trust open = trust_of(forward(saturation(1.0), {8.1}, three_lags), 1.049894, std::sqrt(3.0));
  CHECK(open.band.kind == BandKind::heuristic);
  CHECK(open.band.verdict == BandVerdict::undecided);
  CHECK_THAT(open.band.why, Contains("heuristic") && Contains("towards small amplitudes"));
  LoopParts delayed;
  delayed.plant = TransferFunction{{20.0}, {1.0, 1.0}, 0.5};
  delayed.element = saturation(1.0);
  const auto report = predict(build_loop(delayed), roots_only());
  REQUIRE_FALSE(report.predictions.empty());
  for (const auto& p : report.predictions) {
    REQUIRE(p.trust);
    CHECK(p.trust->band.kind == BandKind::heuristic);
    CHECK_THAT(p.trust->band.why, Contains("delay"));
  }
}

TEST_CASE("belt with LuGre: even harmonics count, sticking is that of the sinusoid, and the sentence warns") {
  const Loop loop = belt(lugre(1.5, 1.0, 0.0));
  const auto report = predict(loop, roots_only(SearchBox{1e-3, 10.0, 0.1, 10.0}));
  REQUIRE(report.predictions.size() == 1);
  const Prediction& p = report.predictions[0];
  CHECK(p.trust->worst_harmonic == 2);
  CHECK(p.trust->harmonic_residual > p.trust->filter_ratio);
  // |0.1 - A w cos| < 1e-5: counted on a fine grid.
  long slow = 0;
  constexpr long n = 2000000;
  for (long i = 0; i < n; ++i) {
    const double phase = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / n;
    if (std::abs(p.input_amplitude * p.frequency * std::cos(phase) - 0.1) < 1e-5) ++slow;
  }
  CHECK(p.trust->sticking_fraction == Approx(static_cast<double>(slow) / n).epsilon(0.01));
  CHECK_THAT(p.trust->sentence, Contains("sensitive") && Contains("far off") && Contains("sticks for"));
}

TEST_CASE(
    "sticking: of a symmetric sinusoid (2/pi) asin(vs/(100 A w)), and 0 by construction for set-valued friction") {
  const double A = 1e-5, w = 2.0;
  const Trust t = trust_of(servo(lugre()), A, w);
  CHECK(t.sticking_fraction == Approx(2.0 / std::numbers::pi * std::asin(1e-5 / (A * w))).epsilon(1e-12));
  CHECK(trust_of(servo(lugre()), 1e-6, w).sticking_fraction == Approx(1.0));
  const Trust set_valued = trust_of(servo(coulomb(1.5, 1.0)), 0.1, w);
  CHECK(set_valued.sticking_fraction == 0.0);
  CHECK_THAT(set_valued.sentence, Contains("a sinusoid never rests"));
}

TEST_CASE("a harmonic on an undamped resonance is infinite, and nothing is NaN") {
  // Poles at +-3j: the third harmonic of w = 1.
  const Trust t = trust_of(forward(relay(1.0), {1.0}, {1.0, 1.0, 9.0, 9.0}), 1.0, 1.0);
  CHECK(t.filter_ratio > 1e6);
  CHECK_THAT(t.band.why, Contains("no bounded band"));
  CHECK(t.band.frequency.low == 0.0);
  CHECK(std::isinf(t.band.frequency.high));
  CHECK(std::isinf(t.band.amplitude.high));
  CHECK(t.band.discs.empty());
  CHECK_THAT(t.sentence, Contains("far off"));
}

TEST_CASE("a saturated command that is never reached changes no indicator") {
  auto parts = servo_parts(coulomb(1.5, 1.0));
  auto limited = pid(3.0, 4.0, 6.0);
  limited.saturation = 1e6;
  parts.controller = limited;
  const Trust with = trust_of(build_loop(parts), 0.1, 2.0), without = trust_of(servo(coulomb(1.5, 1.0)), 0.1, 2.0);
  CHECK(with.filter_ratio == Approx(without.filter_ratio).epsilon(1e-8));
  CHECK(with.harmonic_residual == Approx(without.harmonic_residual).epsilon(1e-8));
}

TEST_CASE("a loop without roots: absence is proved, undecided or not a question") {
  const auto of = [](const Loop& loop) {
    PredictOptions options;
    options.starts = 0;
    return predict(loop, options).absence;
  };
  const auto proved = of(forward(saturation(1.0), {2.0}, three_lags));
  REQUIRE(proved);
  CHECK(proved->verdict == BandVerdict::proved);
  const auto open = of(forward(saturation(1.0), {7.0}, three_lags));
  REQUIRE(open);
  CHECK(open->verdict == BandVerdict::undecided);
  CHECK_FALSE(open->undecided.empty());
  CHECK_FALSE(of(servo(coulomb(1.0, 1.0))));
}
