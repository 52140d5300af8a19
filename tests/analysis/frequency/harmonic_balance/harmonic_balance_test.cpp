// Harmonic balance against exact cycles, its order of convergence, the describing function as its case of one harmonic,
// and its answers where harmonics converge too slowly.
#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_response.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;
using Eigen::VectorXcd;
using std::numbers::pi;

namespace {

HarmonicGuess guess_of(double frequency, std::vector<Complex> first, std::vector<double> mean = {}) {
  HarmonicGuess guess;
  guess.frequency = frequency;
  guess.first = Eigen::Map<VectorXcd>(first.data(), std::ssize(first));
  guess.mean = Eigen::Map<Eigen::VectorXd>(mean.data(), std::ssize(mean));
  return guess;
}

HarmonicBalanceOptions symmetric(int most = 75, double tail = 1e-6, double accuracy = 1e-9) {
  HarmonicBalanceOptions options;
  options.max_harmonics = most;
  options.tail = tail;
  options.accuracy = accuracy;
  options.half_wave_symmetric = true;
  return options;
}

HarmonicBalanceOptions general(int most = 75, double tail = 1e-6, double accuracy = 1e-9) {
  auto options = symmetric(most, tail, accuracy);
  options.half_wave_symmetric = false;
  return options;
}

Loop third_order_relay() { return forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0}); }

double period(const HarmonicBalance& balance) { return 2.0 * pi / balance.frequency; }

/// The equations of the balance, formed here from the result alone with the refined response of each element.
double defect(const Loop& loop, const HarmonicBalance& b, bool half) {
  const auto ne = std::ssize(loop.elements);
  double worst = 0.0;
  std::vector<VectorXcd> W;
  for (Eigen::Index k = 0; k < ne; ++k) {
    const auto at = static_cast<std::size_t>(k);
    W.push_back(
        harmonic_response(loop.elements[at], b.inputs[at], b.frequency, {b.harmonics, 1e-11, half, b.mean_rates(k)})
            .harmonics);
  }
  for (int n = 1; n <= b.harmonics; n += half ? 2 : 1) {
    const Eigen::MatrixXcd H = loop.element_response(n * b.frequency);
    for (Eigen::Index k = 0; k < ne; ++k) {
      Complex x = 0.0;
      for (Eigen::Index l = 0; l < ne; ++l) x += H(k, l) * W[static_cast<std::size_t>(l)](n);
      const VectorXcd& own = b.inputs[static_cast<std::size_t>(k)];
      worst = std::max(worst, std::abs(own(n) - x) / own.tail(b.harmonics).norm());
    }
  }
  return worst;
}

Cycle cycle_of(const Loop& loop, double displacement = 1.0) {
  SettleOptions options;
  options.amplitude_floor = 1e-7;
  const auto settled = settle(loop, displaced(loop, displacement), options);
  INFO(settled.why);
  REQUIRE(settled.outcome == Outcome::cycle);
  return settled.shot->cycle;
}

/// Harmonics of one period of a trace, linear between its points.
VectorXcd harmonics_of(const std::vector<double>& t, const std::vector<double>& x, double T, int H) {
  VectorXcd c = VectorXcd::Zero(H + 1);
  const int parts = 8;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double h = (t[i] - t[i - 1]) / parts;
    for (int p = 0; p < parts; ++p) {
      const double share = (p + 0.5) / parts, at = t[i - 1] + (p + 0.5) * h;
      const double value = x[i - 1] + share * (x[i] - x[i - 1]);
      for (int n = 0; n <= H; ++n) {
        const double phase = 2.0 * pi * n * at / T;
        c(n) += (n == 0 ? 1.0 : 2.0) / T * h * value * Complex(std::sin(phase), std::cos(phase));
      }
    }
  }
  return c;
}

HarmonicGuess guess_of(const Cycle& cycle, int H) {
  HarmonicGuess guess;
  guess.frequency = cycle.frequency();
  guess.inputs = {harmonics_of(cycle.trace.t, cycle.trace.input, cycle.period, H)};
  return guess;
}

}  // namespace

TEST_CASE("relay with three lags: converges to the exact period with order 3 in the harmonics", "[hb][order][claims]") {
  const Loop loop = third_order_relay();
  const double exact = 2.0 * 1.83987534;
  const auto error = [&](int H) {
    const auto balance = harmonic_balance(loop, guess_of(1.7, {0.16}), symmetric(H, 1e-12));
    CHECK(balance.status == Status::incomplete);  // the wanted tail is out of reach
    CHECK(balance.harmonics == H);
    CHECK(defect(loop, balance, true) < 1e-9);
    return std::abs(period(balance) / exact - 1.0);
  };
  const double at25 = error(25), at75 = error(75), at125 = error(125);
  const double order = std::log(at25 / at75) / std::log(3.0);
  CAPTURE(at25, at75, at125, order);
  CHECK(order > 2.8);
  CHECK(order < 3.2);
  CHECK(at125 < 1.1e-7);

  const auto balance = harmonic_balance(loop, guess_of(1.7, {0.16}), symmetric());
  CHECK(balance.status == Status::converged);
  CHECK(balance.why.empty());
  CHECK(balance.tail < 1e-6);
  CHECK(balance.residual < 1e-9);
  CHECK(period(balance) == Approx(exact).epsilon(1e-6));
  CHECK(std::abs(balance.offset) < 1e-12);
}

TEST_CASE("the same without the use of symmetry: no even harmonics, no mean", "[hb]") {
  const Loop loop = third_order_relay();
  const auto half = harmonic_balance(loop, guess_of(1.7, {0.16}), symmetric(25, 1e-4));
  const auto full = harmonic_balance(loop, guess_of(1.7, {0.16}), general(25, 1e-4));
  CHECK(half.status == Status::converged);
  CHECK(full.status == Status::converged);
  CHECK(full.frequency == Approx(half.frequency).epsilon(1e-9));
  CHECK((full.y - half.y).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(full.amplitude == Approx(half.amplitude).epsilon(1e-8));
}

TEST_CASE("van der Pol: period and amplitude of the smooth cycle", "[hb][claims]") {
  const struct {
    double mu, period, amplitude;
    int most;
  } rows[] = {{0.1, 6.2871112723, 2.0001040, 75},
              {1.0, 6.66328685932, 2.00861986087, 75},
              {5.0, 11.6122306677, 2.0215080, 201}};
  for (const auto& row : rows) {
    CAPTURE(row.mu);
    const Loop loop = van_der_pol(row.mu);
    const auto balance = harmonic_balance(loop, guess_of(1.0, {2.0}), symmetric(row.most));
    INFO(balance.why);
    CHECK(balance.status == Status::converged);
    CHECK(period(balance) == Approx(row.period).epsilon(2e-9));
    CHECK(balance.amplitude == Approx(row.amplitude).epsilon(1e-7));
    CHECK(defect(loop, balance, true) < 1e-8);
  }
}

TEST_CASE("relay with a delay: the exact response of the delay enters, order 2 for the corner in the input",
          "[hb][order][delay]") {
  LoopParts parts;
  const double L = 0.5, exact = 2.0 * std::log(2.0 * std::exp(L) - 1.0);
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0}, L};
  parts.element = relay(1.0);
  const Loop loop = build_loop(parts);
  const auto error = [&](int H) {
    const auto balance = harmonic_balance(loop, guess_of(3.5, {0.35}), symmetric(H));
    CHECK(balance.status == Status::incomplete);
    CHECK(balance.why.find("not below the wanted 1e-06") != std::string::npos);
    return std::abs(period(balance) / exact - 1.0);
  };
  const double at25 = error(25), at75 = error(75), at225 = error(225);
  CAPTURE(at25, at75, at225);
  // The effect of the first omitted harmonic depends on its phase at the switch, which differs from one H to the next.
  const double order = std::log(at25 / at225) / std::log(9.0);
  CAPTURE(order);
  CHECK(order > 1.7);
  CHECK(order < 2.6);
  CHECK(at25 * 25 * 25 < 0.4);
  CHECK(at75 * 75 * 75 < 0.4);
  CHECK(at225 * 225 * 225 < 0.4);
}

TEST_CASE("saturation: the cycle that shooting finds", "[hb]") {
  const Loop loop = forward(saturation(1.0), {20.0}, {1.0, 3.0, 3.0, 1.0});
  const Cycle cycle = cycle_of(loop);
  const auto balance = harmonic_balance(loop, guess_of(1.7, {1.7}), symmetric(125, 1e-8));
  CHECK(balance.status == Status::converged);
  CHECK(period(balance) == Approx(cycle.period).epsilon(1e-8));
  CHECK(balance.amplitude == Approx(cycle.amplitude).epsilon(1e-7));
  CHECK(balance.first_harmonic == Approx(cycle.first_harmonic).epsilon(1e-7));
}

TEST_CASE("a biased loop: means and even harmonics as in the cycle that shooting finds", "[hb][bias]") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0};
  parts.element = relay(1.0, 0.02);
  parts.reference = 0.2;
  const Loop loop = build_loop(parts);
  const Cycle cycle = cycle_of(loop, 0.5);
  const auto balance = harmonic_balance(loop, guess_of(1.7, {0.16}, {0.0}), general(125, 1e-6));
  INFO(balance.why);
  CHECK(balance.status == Status::converged);
  CHECK(period(balance) == Approx(cycle.period).epsilon(3e-6));
  CHECK(balance.offset == Approx(cycle.offset).epsilon(1e-5));
  CHECK(balance.amplitude == Approx(cycle.amplitude).epsilon(1e-5));
  CHECK(defect(loop, balance, false) < 1e-8);
  // Static balance: mean input = r - mean y, mean y = mean output of the relay.
  CHECK(balance.inputs[0](0).imag() == Approx(0.2 - balance.offset).epsilon(1e-9));
  CHECK(balance.outputs[0](0).imag() == Approx(balance.offset).epsilon(1e-9));
  CHECK(std::abs(balance.y(2)) > 1e-3 * balance.first_harmonic);
}

TEST_CASE("a loop that integrates: the mean output follows from the balance, the mean input is free", "[hb][bias]") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 2.0, 1.0, 0.0}, 0.0};
  parts.element = relay(1.0);
  const auto still = harmonic_balance(build_loop(parts), guess_of(1.0, {0.6}, {0.05}), general(45, 1e-5));
  INFO(still.why);
  CHECK(still.status == Status::converged);
  CHECK(std::abs(still.outputs[0](0)) < 1e-9);
  CHECK(std::abs(still.offset) < 1e-7);
  const auto half = harmonic_balance(build_loop(parts), guess_of(1.0, {0.6}), symmetric(45, 1e-5));
  CHECK(still.frequency == Approx(half.frequency).epsilon(1e-8));

  // A load is carried by a mean output of the relay that balances it.
  parts.load = 0.3;
  const Loop loop = build_loop(parts);
  const auto loaded = harmonic_balance(loop, guess_of(1.0, {0.6}, {0.05}), general(75, 1e-5));
  INFO(loaded.why);
  CHECK(loaded.status == Status::converged);
  CHECK(loaded.outputs[0](0).imag() == Approx(-0.3).epsilon(1e-8));
  CHECK(defect(loop, loaded, false) < 1e-8);
  const Cycle cycle = cycle_of(loop, 0.5);
  CHECK(period(loaded) == Approx(cycle.period).epsilon(1e-5));
  CHECK(loaded.offset == Approx(cycle.offset).epsilon(1e-4));
}

TEST_CASE("two elements: a saturated command before backlash", "[hb][several]") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0, 0.0}, 0.0};
  Pid controller = pid(3.0, 0.0, 0.0);
  controller.saturation = 0.8;
  controller.lag = 0.5;
  parts.controller = controller;
  Backlash<double> gap;
  gap.half_gap = 0.1;
  parts.element = gap;
  const Loop loop = build_loop(parts);
  REQUIRE(loop.elements.size() == 2);
  const Cycle cycle = cycle_of(loop);
  const auto balance = harmonic_balance(loop, guess_of(cycle.frequency(), {0.0, 0.5}), symmetric(75, 1e-6));
  INFO(balance.why);
  CHECK(balance.harmonics >= 25);
  CHECK(period(balance) == Approx(cycle.period).epsilon(1e-5));
  CHECK(balance.amplitude == Approx(cycle.amplitude).epsilon(1e-5));
  CHECK(defect(loop, balance, true) < 1e-8);
  const auto full = harmonic_balance(loop, guess_of(cycle.frequency(), {0.0, 0.5}), general(25, 1e-3));
  const auto half = harmonic_balance(loop, guess_of(cycle.frequency(), {0.0, 0.5}), symmetric(25, 1e-3));
  CHECK(full.frequency == Approx(half.frequency).epsilon(1e-7));
}

TEST_CASE("one harmonic is the root of the describing function", "[hb][df]") {
  auto friction = lugre();
  friction.vs = 0.05;
  const struct {
    Loop loop;
    SearchBox box;
    bool half;  // half-wave symmetric, as in FirstHarmonicBalance
  } rows[] = {{third_order_relay(), {1e-3, 1e2, 0.1, 10.0}, true},
              {forward(saturation(1.0), {20.0}, {1.0, 3.0, 3.0, 1.0}), {1e-1, 1e2, 0.1, 10.0}, true},
              {van_der_pol(1.0), {1e-1, 1e2, 0.1, 10.0}, true},
              {belt(friction), {0.06, 0.08, 1.45, 1.5}, false}};
  int compared = 0;
  for (const auto& row : rows) {
    const FirstHarmonicBalance equation(row.loop);
    const auto found =
        find_roots([&](double A, double w, double accuracy) { return equation(A, w, accuracy); }, row.box);
    REQUIRE_FALSE(found.roots.empty());
    for (const Root& root : found.roots) {
      const auto balance = harmonic_balance(
          row.loop, guess_of(1.001 * root.frequency, {Complex(0.6, 0.8) * 0.999 * root.amplitude}, {0.0}),
          row.half ? symmetric(1, 1e-6, 1e-12) : general(1, 1e-6, 1e-12));
      CAPTURE(root.amplitude, root.frequency, balance.why, balance.residual);
      CHECK(balance.harmonics == 1);
      CHECK(balance.status == Status::incomplete);  // one harmonic does not determine its tail
      CHECK(balance.tail == 1.0);
      CHECK(balance.frequency == Approx(root.frequency).epsilon(1e-11));
      CHECK(std::abs(balance.inputs[0](1)) == Approx(root.amplitude).epsilon(1e-11));
      CHECK(balance.first_harmonic == Approx(equation.output_amplitude(root.amplitude, root.frequency)).epsilon(1e-9));
      ++compared;
    }
  }
  CHECK(compared == 4);
}

TEST_CASE("stick-slip on a belt with soft bristles: mean velocity, even harmonics, the cycle that shooting finds",
          "[hb][bias]") {
  auto friction = lugre();
  friction.sigma0 = 50.0;
  friction.sigma1 = 2.0;
  friction.vs = 0.05;
  const Loop loop = belt(friction);
  const Cycle cycle = cycle_of(loop, 0.0);
  const auto balance = harmonic_balance(loop, guess_of(cycle, 3), general());
  INFO(balance.why);
  CHECK(balance.status == Status::converged);
  CHECK(balance.mean_rates(0) == Approx(-0.1));
  CHECK(period(balance) == Approx(cycle.period).epsilon(3e-6));
  CHECK(balance.amplitude == Approx(cycle.amplitude).epsilon(1e-5));
  CHECK(balance.offset == Approx(cycle.offset).epsilon(1e-5));
  CHECK(defect(loop, balance, false) < 1e-8);
  const auto coarse = harmonic_balance(loop, guess_of(cycle, 15), general(15));
  CHECK(coarse.status == Status::incomplete);
  CHECK(coarse.tail > 1e-6);
}

TEST_CASE("stick-slip with soft bristles: harmonics follow slowly, and it says so", "[hb][honest]") {
  auto friction = lugre();
  friction.sigma0 = 1e3;
  friction.sigma1 = 30.0;
  friction.vs = 0.02;
  const Loop loop = servo(friction);
  const Cycle cycle = cycle_of(loop);
  auto options = symmetric(75);
  options.max_evaluations = 20'000'000;
  const auto balance = harmonic_balance(loop, guess_of(cycle, 75), options);
  INFO(balance.why);
  CHECK(balance.status == Status::incomplete);
  CHECK(balance.harmonics == 75);
  CHECK(balance.tail > 1e-6);
  CHECK_FALSE(balance.why.empty());
  CHECK(balance.residual < 1e-8);
  CHECK(defect(loop, balance, true) < 1e-7);
  CAPTURE(period(balance), cycle.period, balance.tail);
  CHECK(period(balance) == Approx(cycle.period).epsilon(0.05));
}

TEST_CASE("sticking on stiff bristles is out of reach of 75 harmonics: no answer, a sentence, a bounded cost",
          "[hb][honest]") {
  const Loop loop = servo(lugre());
  for (const long most : {200'000L, 2'000'000L}) {
    auto options = symmetric();
    options.max_evaluations = most;
    const auto balance = harmonic_balance(loop, guess_of(0.26, {0.08}), options);
    CHECK(balance.status != Status::converged);
    CHECK(balance.harmonics == 0);
    CHECK(balance.frequency == 0.0);
    CHECK_FALSE(balance.why.empty());
    CHECK(balance.evaluations < 2 * most);
  }
}

TEST_CASE("the trivial solution is no cycle", "[hb][honest]") {
  // Gain 5 < 8: the linear loop is stable and the saturation cannot oscillate.
  const Loop loop = forward(saturation(1.0), {5.0}, {1.0, 3.0, 3.0, 1.0});
  const auto balance = harmonic_balance(loop, guess_of(1.7, {1.5}), symmetric());
  CHECK(balance.status != Status::converged);
  CHECK(balance.harmonics == 0);
}

TEST_CASE("a balance can be stopped", "[hb]") {
  auto options = symmetric();
  int asked = 0;
  options.stop = [&] { return ++asked > 3; };
  const auto balance = harmonic_balance(third_order_relay(), guess_of(1.6, {0.2}), options);
  CHECK(balance.status == Status::interrupted);
  CHECK(asked == 4);
}

TEST_CASE("bad input of a balance is refused with its value", "[hb][input]") {
  const Loop loop = third_order_relay();
  const auto refused = [&](const HarmonicGuess& guess, const HarmonicBalanceOptions& options, const char* text) {
    CHECK_THROWS_AS(harmonic_balance(loop, guess, options), std::invalid_argument);
    CHECK_THROWS_WITH(harmonic_balance(loop, guess, options), Catch::Contains(text));
  };
  refused(guess_of(-1.0, {1.0}), symmetric(), "frequency of the guess = -1");
  refused(guess_of(1.0, {0.0}), symmetric(), "first harmonic of the guess = 0");
  refused(guess_of(1.0, {1.0, 1.0}), symmetric(), "number of inputs of the guess = 2");
  refused(guess_of(1.0, {1.0}, {1.0, 2.0}), symmetric(), "number of means of the guess = 2");
  refused(guess_of(1.0, {Complex(1.0, NAN)}), symmetric(), "not finite");
  refused(guess_of(1.0, {1.0}, {NAN}), symmetric(), "not finite");
  refused(guess_of(1.0, {1.0}), symmetric(0), "max_harmonics = 0");
  refused(guess_of(1.0, {1.0}), symmetric(5, -1.0), "tail = -1");
  refused(guess_of(1.0, {1.0}), symmetric(5, 1e-6, 1e-20), "accuracy");
  auto directed = lugre();
  directed.Fs_minus = 2.0;
  CHECK_THROWS_WITH(harmonic_balance(servo(directed), guess_of(1.0, {1.0}), symmetric()), Catch::Contains("odd"));
}
