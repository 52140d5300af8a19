// The response of single elements to several harmonics: closed forms, an independent integration, the describing
// function as its case of one harmonic, and its derivative against differences.
#include "limcycle/analysis/frequency/harmonic_balance/harmonic_response.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;
using Eigen::VectorXcd;
using std::numbers::pi;

namespace {

VectorXcd series(std::initializer_list<Complex> coefficients) {
  VectorXcd result(static_cast<Eigen::Index>(coefficients.size()));
  std::copy(coefficients.begin(), coefficients.end(), result.begin());
  return result;
}

HarmonicResponse respond(const Element& element, const VectorXcd& input, double w, int harmonics, bool half,
                         double mean_rate = 0.0, double accuracy = 1e-11) {
  return harmonic_response(element, input, w, {harmonics, accuracy, half, mean_rate});
}

LuGre<double> soft_lugre() {
  auto law = lugre();
  law.vs = 0.3;
  law.sigma0 = 20.0;
  law.sigma1 = 1.0;
  return law;
}

}  // namespace

TEST_CASE("cubic of two harmonics: the identities of trigonometry", "[hb][response]") {
  const double a = 1.3, b = 0.4;
  for (const bool half : {true, false}) {
    const auto W = respond(cubic(2.0), series({0.0, a, 0.0, b}), 3.0, 9, half);
    REQUIRE(W.status == Status::converged);
    CHECK(W.symmetric == half);
    const double exact[] = {0.75 * a * a * a - 0.75 * a * a * b + 1.5 * a * b * b,
                            -0.25 * a * a * a + 1.5 * a * a * b + 0.75 * b * b * b,
                            -0.75 * a * a * b + 0.75 * a * b * b, -0.75 * a * b * b, -0.25 * b * b * b};
    for (int i = 0; i < 5; ++i) CHECK(std::abs(W.harmonics(2 * i + 1) - 2.0 * exact[i]) < 1e-13);
    for (int n = 0; n <= 8; n += 2) CHECK(std::abs(W.harmonics(n)) < 1e-13);
  }
  // With a mean: (m + a sin)^3 has mean m^3 + 3 m a^2/2 and second harmonic -(3/2) m a^2 cos.
  const double m = 0.7;
  const auto W = respond(cubic(1.0), series({Complex(0.0, m), a}), 3.0, 3, false);
  CHECK(std::abs(W.harmonics(0) - Complex(0.0, m * m * m + 1.5 * m * a * a)) < 1e-13);
  CHECK(std::abs(W.harmonics(2) - Complex(0.0, -1.5 * m * a * a)) < 1e-13);
}

TEST_CASE("relay and Coulomb friction through six switches a period: the exact square waves", "[hb][response]") {
  // sin t + 2 sin 3t changes sign at 0, alpha, pi - alpha with sin^2 alpha = 7/8; its derivative cos t + 6 cos 3t at
  // beta, pi/2, pi - beta with cos^2 beta = 17/24.
  const double alpha = std::asin(std::sqrt(7.0 / 8.0)), beta = std::acos(std::sqrt(17.0 / 24.0));
  for (const bool half : {true, false}) {
    const auto switched = respond(relay(1.5), series({0.0, 1.0, 0.0, 2.0}), 2.0, 31, half);
    const auto rubbed = respond(coulomb(1.5, 1.5), series({0.0, 1.0, 0.0, 2.0}), 2.0, 31, half);
    REQUIRE(switched.status == Status::converged);
    REQUIRE(rubbed.status == Status::converged);
    for (int n = 1; n <= 31; n += 2) {
      const double scale = 1.5 * 4.0 / (pi * n);
      CHECK(std::abs(switched.harmonics(n) - scale * (1.0 - 2.0 * std::cos(n * alpha))) < 1e-12);
      CHECK(std::abs(rubbed.harmonics(n) - Complex(0.0, scale * (2.0 * std::sin(n * beta) - std::sin(n * pi / 2)))) <
            1e-12);
    }
  }
}

TEST_CASE("a phase of the input turns the harmonics of the output", "[hb][response]") {
  const VectorXcd input = series({0.0, 1.0, 0.0, Complex(0.3, -0.2), 0.0, Complex(-0.05, 0.1)});
  for (const Element& element : {Element(soft_lugre()), Element(backlash(0.2)), Element(relay(1.0, 0.3, 0.5)),
                                 Element(dahl(1.0)), Element(saturation(2.0, 0.7))}) {
    const auto straight = respond(element, input, 1.7, 9, true);
    REQUIRE(straight.status == Status::converged);
    for (const double phase : {0.3, 2.0, 3.1, -1.0}) {
      VectorXcd turned = input;
      for (Eigen::Index n = 1; n < turned.size(); ++n) turned(n) *= std::polar(1.0, phase * static_cast<double>(n));
      const auto W = respond(element, turned, 1.7, 9, true);
      REQUIRE(W.status == Status::converged);
      for (Eigen::Index n = 1; n <= 9; n += 2)
        CHECK(std::abs(W.harmonics(n) - straight.harmonics(n) * std::polar(1.0, phase * static_cast<double>(n))) <
              1e-10 * straight.harmonics.norm());
    }
  }
}

TEST_CASE("one harmonic is the describing function", "[hb][response][df]") {
  const struct {
    Element element;
    double A, w, bias;
    bool rubs;
  } cases[] = {{lugre(), 1e-3, 2.0, 0.0, true},
               {lugre(), 1e-4, 2.0, 1e-4, true},
               {stribeck(1.5, 1.0, 1e-3), 1e-3, 2.0, 0.0, true},
               {stribeck(1.5, 1.0, 1e-3), 1e-3, 2.0, 1.3e-3, true},
               {coulomb(1.0, 1.0), 1.0, 2.0, 0.7, true},
               {dahl(), 3e-5, 1.0, 0.0, true},
               {relay(2.0, 0.1), 1.0, 3.0, 0.0, false},
               {relay(2.0, 0.1), 1.0, 3.0, 0.2, false},
               {saturation(2.0, 0.5), 1.0, 3.0, 0.0, false},
               {dead_zone(1.0, 0.3), 1.0, 3.0, 0.1, false},
               {backlash(0.3), 1.0, 3.0, 0.0, false},
               {cubic(2.0), 1.0, 3.0, 0.4, false}};
  for (const auto& c : cases) {
    const auto df = describing_function(c.element, {c.A, c.w, c.bias}, with(DfMethod::quadrature, 1e-11));
    const auto W = respond(c.element, series({Complex(0.0, c.rubs ? 0.0 : c.bias), c.A}), c.w, 7, c.bias == 0.0,
                           c.rubs ? c.bias : 0.0);
    CAPTURE(c.A, c.bias, df.gain, W.harmonics(1) / c.A);
    REQUIRE(W.status == Status::converged);
    CHECK(std::abs(W.harmonics(0).imag() - df.mean) < 1e-11);
    for (int n = 1; n <= 7; ++n) {
      const auto i = static_cast<std::size_t>(n - 1);
      CHECK(std::abs(W.harmonics(n) - df.harmonics[i]) < 2e-11 * std::abs(df.harmonics[0]));
    }
  }
}

TEST_CASE("LuGre under three harmonics: a plain Runge-Kutta run over twenty periods says the same", "[hb][response]") {
  const auto law = soft_lugre();
  const double w = 1.3, V = 0.2;
  const VectorXcd input = series({0.0, 0.4, Complex(0.1, -0.05), Complex(0.02, 0.08)});
  const auto W = respond(law, input, w, 4, false, V);
  REQUIRE(W.status == Status::converged);
  const auto velocity = [&](double t) {
    double v = V;
    for (Eigen::Index n = 1; n < input.size(); ++n) {
      const auto order = static_cast<double>(n);
      v += order * w * (input(n) * std::polar(1.0, order * w * t)).real();
    }
    return v;
  };
  const int steps = 20000;
  const double h = 2.0 * pi / w / steps;
  double z[1] = {0.0}, k[4][1];
  const auto rate = [&](double t, double at, double* out) {
    const double state[1] = {at};
    law.rate(Input<double>{0.0, velocity(t), 0.0}, {}, state, std::span<double>(out, 1));
  };
  VectorXcd sums = VectorXcd::Zero(5);
  for (int period = 0; period < 20; ++period) {
    for (int i = 0; i < steps; ++i) {
      const double t = i * h;
      if (period == 19)
        for (int n = 0; n <= 4; ++n)
          sums(n) += law.output(Input<double>{0.0, velocity(t), 0.0}, {}, z) * (n == 0 ? 1.0 : 2.0) / steps *
                     Complex(std::sin(n * w * t), std::cos(n * w * t));
      rate(t, z[0], k[0]);
      rate(t + 0.5 * h, z[0] + 0.5 * h * k[0][0], k[1]);
      rate(t + 0.5 * h, z[0] + 0.5 * h * k[1][0], k[2]);
      rate(t + h, z[0] + h * k[2][0], k[3]);
      z[0] += h / 6.0 * (k[0][0] + 2.0 * k[1][0] + 2.0 * k[2][0] + k[3][0]);
    }
  }
  for (int n = 0; n <= 4; ++n) CHECK(std::abs(W.harmonics(n) - sums(n)) < 1e-7);
}

TEST_CASE("the error estimate of the response bounds its error", "[hb][response][error]") {
  const VectorXcd input = series({0.0, 1e-3, 0.0, Complex(2e-4, -3e-4)});
  for (const Element& element : {Element(lugre()), Element(stribeck(1.5, 1.0, 1e-3)), Element(dahl())}) {
    const auto exact = respond(element, input, 2.0, 9, true, 0.0, 1e-12);
    for (const double accuracy : {1e-3, 1e-5, 1e-7, 1e-9}) {
      const auto W = respond(element, input, 2.0, 9, true, 0.0, accuracy);
      REQUIRE(W.status == Status::converged);
      CHECK((W.harmonics - exact.harmonics).cwiseAbs().maxCoeff() <= W.error + exact.error);
      CHECK(W.error <= accuracy * exact.harmonics.cwiseAbs().maxCoeff() * 1.01);
    }
  }
}

TEST_CASE("the rate near each of many reversals is exact relative to itself", "[hb][motion]") {
  VectorXcd input = VectorXcd::Zero(22);
  for (int n = 1; n <= 21; n += 2) input(n) = std::polar(1.0 / (n * std::sqrt(n)), 0.7 * n * n);
  const double w = 3.0;
  for (const double V : {0.0, 0.4}) {
    const PrescribedHarmonics motion(input, w, V, V == 0.0);
    int reversals = 0;
    for (int i = 1; i <= motion.stops(); ++i) {
      if (motion.rate(i) != 0.0) continue;
      ++reversals;
      // v by its Taylor series in the distance from the reversal.
      for (const double d : {1e-12, -1e-9, 1e-6, -1e-4}) {
        double taylor = 0.0, factor = 1.0;
        for (int p = 1; p <= 6; ++p) {
          factor *= d / p;
          Complex sum = 0.0;
          for (int n = 1; n <= 21; n += 2)
            sum += n * w * std::pow(Complex(0.0, n), p) * input(n) * std::polar(1.0, n * motion.phase(i));
          taylor += factor * sum.real();
        }
        CHECK(motion.at(i, d).in.v == Approx(taylor).epsilon(1e-10));
      }
    }
    CHECK(reversals >= 2);
    // Every sign change on a fine grid is one of the reversals.
    int changes = 0;
    double before = 0.0;
    for (int i = 0; i <= 200000; ++i) {
      const double v = motion.at(0, 2.0 * pi * i / 200000.0).in.v;
      if (i > 0 && v * before < 0.0) ++changes;
      before = v;
    }
    CHECK(changes == reversals);
    // Values from any anchor are the same motion.
    for (int i = 0; i <= motion.stops() + 1; ++i) {
      const MotionNode node = motion.at(i, 0.37);
      const double phase = motion.phase(i) + 0.37;
      CHECK(node.in.x == Approx(series_value(input, phase) + V * phase / w).epsilon(1e-12).margin(1e-13));
      CHECK(node.sine == Approx(std::sin(phase)).margin(1e-14));
      CHECK(motion.position(i, 0.37) == Approx(phase - motion.origin()).margin(1e-13));
    }
  }
}

TEST_CASE("the derivative of the response agrees with differences", "[hb][response][derivative]") {
  const VectorXcd odd = series({0.0, 1.0, 0.0, Complex(0.3, -0.2)});
  const VectorXcd all = series({Complex(0.0, 0.1), 1.0, Complex(0.15, 0.1), Complex(0.3, -0.2)});
  auto gentle = stribeck(1.5, 1.0, 1e-3);
  gentle.vs = 0.4;
  const Element elements[] = {soft_lugre(),         coulomb(1.0, 1.0),   gentle,
                              relay(1.0, 0.3, 0.5), relay(1.0),          backlash(0.2),
                              saturation(2.0, 0.7), dead_zone(1.0, 0.3), cubic(2.0)};
  const int level = 4;
  for (const Element& element : elements) {
    for (const bool half : {true, false}) {
      const double w = 1.7, V = half || !element.is_friction() ? 0.0 : 0.25;
      const VectorXcd input = half ? odd : all;
      ElementHarmonics response(element);
      Eigen::MatrixXd derivative;
      REQUIRE(response.with_derivative(PrescribedHarmonics(input, w, V, half), 3, level, 1e-14, derivative).status ==
              Status::converged);
      const int orders = half ? 2 : 3, stride = half ? 2 : 1;
      REQUIRE(derivative.cols() == 2 * orders + 3);
      REQUIRE(derivative.rows() == 2 * (orders + (half ? 0 : 1)));
      const auto outputs = [&](const VectorXcd& x, double frequency, double rate) {
        const auto W = response(PrescribedHarmonics(x, frequency, rate, half), 3, level, 1e-14).harmonics;
        Eigen::VectorXd rows(derivative.rows());
        Eigen::Index row = 0;
        for (Eigen::Index n = half ? 1 : 0; n <= 3; n += stride) {
          rows(row++) = W(n).real();
          rows(row++) = W(n).imag();
        }
        return rows;
      };
      for (Eigen::Index column = 0; column < derivative.cols(); ++column) {
        if (half && column > 2 * orders) continue;  // means have no part in a symmetric motion
        if (!element.is_friction() && column == 2 * orders + 2) continue;
        const double h = 1e-5;
        const auto moved = [&](double by) {
          VectorXcd x = input;
          double frequency = w, rate = V;
          const Eigen::Index order = 1 + stride * (column / 2);
          if (column < 2 * orders) x(order) += column % 2 == 0 ? Complex(by, 0.0) : Complex(0.0, by);
          if (column == 2 * orders) frequency += by;
          if (column == 2 * orders + 1) x(0) += Complex(0.0, by);
          if (column == 2 * orders + 2) rate += by;
          return outputs(x, frequency, rate);
        };
        const Eigen::VectorXd difference = (moved(h) - moved(-h)) / (2.0 * h);
        CAPTURE(std::string(element.kind()), half, column, difference.transpose(), derivative.col(column).transpose());
        CHECK((difference - derivative.col(column)).cwiseAbs().maxCoeff() < 1e-6);
      }
    }
  }
}

TEST_CASE("bad input of a response is refused with its value", "[hb][response][input]") {
  const VectorXcd good = series({0.0, 1.0});
  CHECK_THROWS_WITH(harmonic_response(relay(1.0), good, -2.0), Catch::Contains("-2"));
  CHECK_THROWS_WITH(harmonic_response(relay(1.0), series({0.0, 0.0}), 1.0), Catch::Contains("largest harmonic"));
  CHECK_THROWS_WITH(harmonic_response(relay(1.0), series({0.0, NAN}), 1.0), Catch::Contains("not finite"));
  CHECK_THROWS_WITH(harmonic_response(relay(1.0), good, 1.0, {.harmonics = 0}), Catch::Contains("harmonics = 0"));
  CHECK_THROWS_WITH(harmonic_response(relay(1.0), good, 1.0, {.accuracy = 1e-20}), Catch::Contains("accuracy"));
}

TEST_CASE("a relay that does not switch has no half-wave symmetric answer", "[hb][response]") {
  const auto W = respond(relay(1.0, 0.0, 0.0), series({Complex(0.0, 3.0), 1.0}), 1.0, 3, false);
  CHECK(W.status == Status::converged);
  CHECK(W.harmonics(0).imag() == Approx(1.0));
  CHECK(std::abs(W.harmonics(1)) < 1e-12);
  CHECK(respond(relay(1.0, 3.0), series({0.0, 1.0}), 1.0, 3, true).status == Status::no_cycle);
}
