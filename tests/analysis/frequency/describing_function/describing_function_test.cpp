#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "limcycle/models/laws.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

/// Share of the unit-slope saturation, claims A6.
double f(double u) { return 2.0 / pi * (std::asin(u) + u * std::sqrt(1.0 - u * u)); }

/// `room`: relative error of `expected` itself.
void check_gain(const Element& element, const DfPoint& point, Complex expected, double room = 1e-15) {
  CAPTURE(point.amplitude, point.frequency, point.bias, expected);
  for (const double accuracy : {1e-6, 1e-9, 1e-11}) {
    const auto df = describing_function(element, point, with(DfMethod::quadrature, accuracy));
    CHECK(df.status == Status::converged);
    CHECK(df.method == "quadrature");
    CHECK(df.error <= accuracy);
    INFO(apart(df.gain, expected) << " against " << df.error);
    CHECK(apart(df.gain, expected) <= df.error + room);
  }
  const auto df = describing_function(element, point);
  CHECK(apart(df.gain, expected) <= df.error + room);
}

/// Describing function of Dahl friction with exponent i > 1 from its closed-form branches: with left = 1 - F/Fc and s
/// the way since the reversal, left^(1-i) grows by (i - 1) s/l; the loop starts at -peak and must arrive at +peak.
Complex dahl_by_branches(double i, double A, double l) {
  const auto force = [&](double peak, double way) {
    return 1.0 - std::pow(std::pow(1.0 + peak, 1.0 - i) + (i - 1.0) * way / l, 1.0 / (1.0 - i));
  };
  double low = 0.0, high = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (force(middle, 2.0 * A) > middle ? low : high) = middle;
  }
  const auto integral = [&](auto weight) {
    return 2.0 / pi *
           boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
               [&](double phase) { return weight(phase) * force(low, 2.0 * A * std::pow(std::sin(0.5 * phase), 2)); },
               0.0, pi, 15, 1e-13);
  };
  return Complex(integral([](double p) { return -std::cos(p); }), integral([](double p) { return std::sin(p); })) / A;
}

}  // namespace

TEST_CASE("describing functions with a closed form", "[df][claims]") {
  SECTION("A1 relay") {
    check_gain(relay(1.0), {2.0, 1.0, 0.0}, 2.0 / pi);
    CHECK(2.0 / pi == Approx(0.636620).epsilon(1e-6));
  }
  SECTION("A2 and A3 Coulomb, with viscous friction") {
    check_gain(coulomb(1.0, 1.0), {0.01, 1.0, 0.0}, Complex(0.0, 400.0 / pi));
    auto law = coulomb(1.0, 1.0);
    law.sigma2 = 0.4;
    check_gain(law, {0.01, 30.0, 0.0}, Complex(0.0, 400.0 / pi + 12.0));
  }
  SECTION("a relay with a bias, its mean too, where both sides, one or none switch") {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> within(0.0, 1.0);
    int both = 0, one = 0, none = 0;
    for (int i = 0; i < 60; ++i) {
      const double d = i % 2 == 0 ? 0.0 : within(random), h = d > 0.0 ? d * within(random) : within(random);
      const Relay<double> law = relay(1.0 + within(random), h, d);
      const double A = 3.0 * within(random), bias = 4.0 * within(random) - 2.0;
      const auto N = law.exact_describing_function(A, 1.0, bias);
      REQUIRE(N.has_value());
      const auto df = describing_function(law, {A, 1.0, bias}, with(DfMethod::quadrature, 1e-9));
      REQUIRE(df.status == Status::converged);
      CAPTURE(d, h, A, bias, *N, df.gain, df.mean);
      CHECK(std::abs(*N - df.gain) < 2e-9 * (1.0 + std::abs(df.gain)));
      const bool history_decides = A <= d + h - std::abs(bias) || (d > 0.0 && A <= h - std::abs(std::abs(bias) - d));
      if (!history_decides) CHECK(law.exact_mean(A, bias) == Approx(df.mean).margin(1e-8));
      ++(*N == 0.0 ? none : A > d + h + std::abs(bias) ? both : one);
    }
    CHECK(std::min({both, one, none}) > 5);
  }
  SECTION("A4 relay with dead zone, A5 with hysteresis") {
    check_gain(relay(1.0, 0.0, 0.5), {2.0, 1.0, 0.0}, 2.0 / pi * std::sqrt(1.0 - 1.0 / 16.0));
    const Complex hysteresis = 2.0 / pi * Complex(std::sqrt(1.0 - 1.0 / 16.0), -0.25);
    CHECK(apart(hysteresis, {0.616404, -0.159155}) < 1e-6);
    check_gain(relay(1.0, 0.5), {2.0, 1.0, 0.0}, hysteresis);
    const double h = 0.5, A = 0.5 * (1.0 + 1e-9);  // it only just switches
    check_gain(relay(1.0, h), {A, 1.0, 0.0}, 4.0 / (pi * A) * Complex(std::sqrt((A - h) * (A + h)) / A, -h / A),
               5e-12);  // the phase at which x reaches h is uncertain by a rounding over its slope, 4e-5
  }
  SECTION("A6 saturation and dead zone") {
    check_gain(saturation(1.0, 0.5), {2.0, 1.0, 0.0}, f(0.25));
    CHECK(f(0.25) == Approx(0.314962).epsilon(1e-5));
    check_gain(saturation(3.0, 0.5), {0.1, 1.0, 0.0}, 3.0);
    check_gain(dead_zone(1.0, 0.5), {2.0, 1.0, 0.0}, 1.0 - f(0.25));
  }
  SECTION("A7 backlash") {
    check_gain(backlash(0.5), {2.0, 1.0, 0.0}, Complex(0.5 * (1.0 + f(0.5)), -4.0 / pi * 0.25 * 0.75));
    check_gain(backlash(1.0), {2.0, 1.0, 0.0}, Complex(0.5, -1.0 / pi));
  }
  SECTION("A10 cubic, biased too") {
    check_gain(cubic(1.0), {2.0, 1.0, 0.0}, 3.0);
    check_gain(cubic(1.0), {2.0, 1.0, 0.5}, 3.75);
  }
  SECTION("A12 Dahl with exponent 1") {
    for (const double A : {1e-7, 5e-6, 1e-5, 5e-5, 1e-3, 1e-2}) {
      const double a = A * 1e5;
      // I1(a)/cosh a, by the asymptotic form where both overflow.
      const double ratio = a < 500.0 ? std::cyl_bessel_i(1.0, a) / std::cosh(a)
                                     : 2.0 / std::sqrt(2.0 * pi * a) *
                                           (1.0 - 3.0 / (8.0 * a) - 15.0 / (128.0 * a * a) -
                                            315.0 / (3072.0 * a * a * a) - 42525.0 / (98304.0 * a * a * a * a));
      check_gain(dahl(), {A, 1.0, 0.0}, Complex(2.0 / A * ratio, 4.0 / (pi * A) * (1.0 - std::tanh(a) / a)));
    }
  }
  SECTION("A14 Coulomb with a mean velocity") {
    check_gain(coulomb(1.0, 1.0), {1.0, 1.0, 0.3}, Complex(0.0, 4.0 / pi * std::sqrt(1.0 - 0.09)));
    const auto df = describing_function(coulomb(1.0, 1.0), {1.0, 1.0, 0.3}, with(DfMethod::quadrature, 1e-10));
    CHECK(df.gain.imag() == Approx(1.214593).epsilon(1e-6));
    CHECK(df.mean == Approx(2.0 / pi * std::asin(0.3)).epsilon(1e-10));
    CHECK(df.dissipation == Approx(pi * df.gain.imag() + 0.3 * df.mean * 2.0 * pi).epsilon(1e-10));
    const auto fast = describing_function(coulomb(1.0, 1.0), {1.0, 1.0, -1.5}, with(DfMethod::quadrature, 1e-10));
    CHECK(fast.gain == 0.0);
    CHECK(fast.mean == Approx(-1.0).epsilon(1e-14));
  }
}

TEST_CASE("Dahl with other exponents follows its closed-form branches", "[df][dahl]") {
  for (const double i : {1.5, 2.0, 3.0}) {
    for (const double A : {1e-6, 1e-5, 1e-4, 2e-3}) {
      CAPTURE(i, A);
      check_gain(dahl(i), {A, 1.0, 0.0}, dahl_by_branches(i, A, 1e-5), 5e-13);
    }
  }
  // Exponent 0 is the Jenkins element, claims A8: its state stops with a kink, where collocation converges slowly.
  const double A = 5e-5, h = 1e-5;
  const Complex jenkins(0.5e5 * (1.0 - f(1.0 - 2.0 * h / A)), 4.0 / (pi * A) * (1.0 - h / A));
  const auto df = describing_function(dahl(0.0), {A, 1.0, 0.0}, with(DfMethod::quadrature, 1e-6));
  CHECK(df.status == Status::converged);
  CHECK(apart(df.gain, jenkins) <= df.error);
}

TEST_CASE("slow LuGre with Fs = Fc is Dahl", "[df][lugre][claims]") {
  auto law = lugre(1.5, 1.0, 0.0);
  law.Fc = law.Fc_minus = 1.5;
  law.sigma1 = 0.0;
  const auto df = describing_function(law, {1.5e-5, 1e-4, 0.0}, with(DfMethod::quadrature, 1e-9));
  CHECK(apart(df.gain, {73250.7545, 30354.7748}) < 1e-9);
}

TEST_CASE("harmonics of the textbook", "[df][harmonics]") {
  SECTION("Coulomb: 4 Fc/(pi k) for odd k, none for even k") {
    const auto df = describing_function(coulomb(1.3, 1.3), {0.02, 2.0, 0.0}, with(DfMethod::quadrature, 1e-10, 15));
    REQUIRE(df.harmonics.size() == 15);
    for (int k = 1; k <= 15; ++k) {
      CAPTURE(k);
      // cos(k pi/2)-type signs: sgn(cos t) has cosine coefficients 4/(pi k) (1, 0, -1, 0, ...).
      const double expected = k % 2 == 0 ? 0.0 : (k % 4 == 1 ? 1.0 : -1.0) * 4.0 * 1.3 / (pi * k);
      CHECK(df.harmonics[static_cast<std::size_t>(k - 1)].imag() == Approx(expected).margin(1e-9));
      CHECK(std::abs(df.harmonics[static_cast<std::size_t>(k - 1)].real()) < 1e-9);
    }
  }
  SECTION("ideal relay: 4 M/(pi k)") {
    const auto df = describing_function(relay(2.0), {1.0, 1.0, 0.0}, with(DfMethod::automatic, 1e-9, 9));
    for (int k = 1; k <= 9; k += 2)
      CHECK(df.harmonics[static_cast<std::size_t>(k - 1)].real() == Approx(8.0 / (pi * k)).epsilon(1e-8));
    CHECK(df.method == "closed-form");
    CHECK(df.harmonics[0] == df.gain);
  }
  SECTION("cubic: A^3 (3 sin t - sin 3t)/4") {
    const auto df = describing_function(cubic(2.0), {1.5, 3.0, 0.0}, with(DfMethod::quadrature, 1e-10));
    CHECK(df.harmonics[2].real() == Approx(-0.25 * 2.0 * 3.375).epsilon(1e-9));
    CHECK(std::abs(df.harmonics[4]) < 1e-9);
  }
  SECTION("saturation: third harmonic by integration") {
    const double b = 0.25, at = std::asin(b);
    const auto output = [&](double t) { return std::min(std::sin(t), b); };
    using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
    const auto integrand = [&](double t) { return output(t) * std::sin(3.0 * t); };
    const double third =
        4.0 / pi *
        (Rule::integrate(integrand, 0.0, at, 10, 1e-13) + Rule::integrate(integrand, at, 0.5 * pi, 10, 1e-13));
    for (const DfMethod method : {DfMethod::quadrature, DfMethod::fft}) {
      const auto df = describing_function(saturation(1.0, 0.5), {2.0, 1.0, 0.0}, with(method, 1e-6));
      CHECK(df.harmonics[2].real() == Approx(2.0 * third).epsilon(1e-5));
    }
  }
}

TEST_CASE("work per period", "[df][energy]") {
  const std::vector<Element> elements{lugre(),          coulomb(1.0, 1.0), stribeck(1.5, 1.0, 1e-3), dahl(2.0),
                                      relay(1.0, 2e-4), backlash(1e-4),    relay(1.0, 1e-4, 3e-4),   cubic(1.0)};
  for (const auto& element : elements) {
    const DfPoint point{1e-3, 2.0, 0.0};
    const auto df = describing_function(element, point, with(DfMethod::quadrature, 1e-9));
    CAPTURE(std::string(element.kind()));
    CHECK(df.symmetric);
    CHECK(df.mean == 0.0);
    CHECK(df.dissipation == Approx(pi * 1e-6 * df.gain.imag()).epsilon(1e-12).margin(1e-12 * std::abs(df.gain)));
    // With a bias: the mean output works against the mean rate (friction law) or not at all (other element).
    const bool friction = element.is_friction();
    const DfPoint biased{1e-3, 2.0, friction ? 7e-4 : 1e-4};
    const auto with_bias = describing_function(element, biased, with(DfMethod::quadrature, 1e-9));
    CHECK_FALSE(with_bias.symmetric);
    const double drift = friction ? biased.bias * with_bias.mean * 2.0 * pi / biased.frequency : 0.0;
    CHECK(with_bias.dissipation == Approx(pi * 1e-6 * with_bias.gain.imag() + drift)
                                       .epsilon(1e-12)
                                       .margin(1e-12 * 1e-6 * std::abs(with_bias.gain)));
  }
}

TEST_CASE("rate-independent laws do not see the frequency", "[df]") {
  for (const Element& element : {Element(coulomb(1.0, 1.0)), Element(dahl()), Element(dahl(1.7)),
                                 Element(relay(1.0, 1e-5)), Element(backlash(1e-5))}) {
    const auto slow = describing_function(element, {3e-5, 1e-3, 0.0}, with(DfMethod::quadrature, 1e-9));
    const auto fast = describing_function(element, {3e-5, 7e3, 0.0}, with(DfMethod::quadrature, 1e-9));
    CHECK(apart(slow.gain, fast.gain) < 1e-12);
  }
}

TEST_CASE("where the periodic state is not unique", "[df][uniqueness]") {
  const auto quadrature = with(DfMethod::quadrature, 1e-9);
  SECTION("a relay within its hysteresis keeps the output it started with") {
    for (const DfMethod method : {DfMethod::quadrature, DfMethod::fft, DfMethod::automatic}) {
      const auto df = describing_function(relay(2.0, 0.5), {0.4, 1.0, 0.0}, with(method, 1e-6));
      CHECK(df.status == Status::converged);
      CHECK(df.gain == 0.0);
      CHECK(df.mean == Approx(2.0).epsilon(1e-13));
      CHECK_FALSE(df.symmetric);
    }
  }
  SECTION("backlash within its gap rests in the middle") {
    const auto df = describing_function(backlash(0.5), {0.4, 1.0, 0.0}, quadrature);
    CHECK(df.gain == 0.0);
    CHECK(df.mean == 0.0);
    CHECK(df.symmetric);
  }
  SECTION("an elastic range: the half-wave symmetric one, or with a bias of the input the virgin one") {
    const auto jenkins = dahl(0.0);
    const auto df = describing_function(jenkins, {9e-6, 1.0, 0.0}, quadrature);
    CHECK(df.symmetric);
    CHECK(apart(df.gain, 1e5) < 1e-9);
    const auto moved = describing_function(backlash(0.5), {0.4, 1.0, 3.0}, quadrature);
    CHECK(moved.status == Status::converged);
    CHECK(moved.mean == Approx(3.0).epsilon(1e-12));
  }
}

TEST_CASE("the two routes agree", "[df][fft]") {
  auto unequal = lugre();
  unequal.Fs_minus = 1.8;
  const std::vector<Element> elements{
      lugre(),        unequal,          coulomb(1.0, 1.0),      stribeck(1.5, 1.0, 1e-3), dahl(),
      dahl(2.0),      relay(1.0, 1e-4), relay(1.0, 1e-4, 3e-4), saturation(2.0, 1e-3),    dead_zone(1.0, 2e-4),
      backlash(2e-4), cubic(1.0)};
  for (const auto& element : elements) {
    for (const double bias : {0.0, 3e-4}) {
      CAPTURE(std::string(element.kind()), bias);
      const auto fft = describing_function(element, {1e-3, 1.0, bias}, with(DfMethod::fft, 1e-5));
      const auto exact = describing_function(element, {1e-3, 1.0, bias}, with(DfMethod::quadrature, 1e-10));
      CHECK(fft.status == Status::converged);
      CHECK(apart(fft.gain, exact.gain) <= fft.error);
      CHECK(fft.mean == Approx(exact.mean).epsilon(1e-4).margin(1e-6));
      CHECK(fft.dissipation == Approx(exact.dissipation).epsilon(1e-4).margin(1e-12));
      REQUIRE(fft.harmonics.size() == 7);
      for (std::size_t k = 1; k < 7; ++k)
        CHECK(std::abs(fft.harmonics[k] - exact.harmonics[k]) < 1e-3 * std::abs(exact.harmonics[0]));
    }
  }
}

TEST_CASE("a table is its points, can be watched and stopped", "[df][table]") {
  std::vector<DfPoint> points;
  for (const double A : {1e-5, 1e-4, 1e-3})
    for (const double w : {1.0, 10.0}) points.push_back({A, w, 0.0});
  std::size_t seen = 0;
  const auto table = describing_function_table(lugre(), points, {}, {}, [&](std::size_t done) { seen = done; });
  REQUIRE(table.size() == points.size());
  CHECK(seen == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) CHECK(table[i].gain == describing_function(lugre(), points[i]).gain);
  const auto stopped = describing_function_table(lugre(), points, {}, [&] { return --seen < 4; });
  CHECK(stopped.size() == 2);
}

TEST_CASE("the default LuGre set meets its accuracy over the whole box", "[df][lugre]") {
  for (const double accuracy : {1e-6, 1e-9}) {
    std::vector<DfPoint> points;
    for (int i = 0; i < 11; ++i)
      for (int j = 0; j < 9; ++j)
        points.push_back({std::pow(10.0, -6.0 + 0.5 * i), std::pow(10.0, -1.0 + 0.5 * j), 0.0});
    const auto table = describing_function_table(lugre(), points, with(DfMethod::automatic, accuracy));
    const auto tight = describing_function_table(lugre(), points, with(DfMethod::quadrature, 3e-13));
    for (std::size_t i = 0; i < points.size(); ++i) {
      CAPTURE(points[i].amplitude, points[i].frequency);
      CHECK(table[i].status == Status::converged);
      CHECK(table[i].error <= accuracy);
      CHECK(apart(table[i].gain, tight[i].gain) <= table[i].error + tight[i].error);
    }
  }
}

TEST_CASE("bad coordinates and options are refused with their value", "[df][input]") {
  using Catch::Matchers::Contains;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(describing_function(lugre(), {-0.125, 1.0, 0.0}), Contains("amplitude") && Contains("-0.125"));
  CHECK_THROWS_WITH(describing_function(lugre(), {1.0, 0.0, 0.0}), Contains("frequency") && Contains("0"));
  CHECK_THROWS_WITH(describing_function(lugre(), {1.0, 1.0, infinite}), Contains("bias") && Contains("inf"));
  CHECK_THROWS_AS(describing_function(lugre(), {nan, 1.0, 0.0}), std::invalid_argument);
  CHECK_THROWS_WITH(describing_function(lugre(), {1.0, 1.0, 0.0}, with(DfMethod::fft, 0.5)),
                    Contains("accuracy") && Contains("0.5"));
  CHECK_THROWS_WITH(describing_function(lugre(), {1.0, 1.0, 0.0}, with(DfMethod::fft, 1e-6, 0)),
                    Contains("harmonics") && Contains("0"));
}

TEST_CASE("what is not finite never leaves", "[df][input]") {
  auto broken = lugre();
  broken.sigma1 = std::numeric_limits<double>::quiet_NaN();
  auto endless = lugre();
  endless.sigma0 = 1e300;
  for (const auto& law : {broken, endless}) {
    for (const DfMethod method : {DfMethod::quadrature, DfMethod::fft}) {
      const auto df = describing_function(law, {1e12, 1e12, 0.0}, with(method, 1e-3));
      CHECK(df.status != Status::converged);
      CHECK(df.gain == 0.0);
      CHECK(df.error == 0.0);
      CHECK(df.mean == 0.0);
      CHECK(df.dissipation == 0.0);
      for (const auto& harmonic : df.harmonics) CHECK(harmonic == 0.0);
    }
  }
}
