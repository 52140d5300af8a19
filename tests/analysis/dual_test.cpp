#include "limcycle/models/dual.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/element/element.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"

using namespace limcycle;

namespace {

template <class E, class S>
constexpr bool usable = LawOn<E, S>;
using D3 = Dual<3>;
static_assert(usable<Coulomb<D3>, D3> && usable<Stribeck<D3>, D3> && usable<Dahl<D3>, D3> && usable<LuGre<D3>, D3>);
static_assert(usable<Relay<D3>, D3> && usable<Saturation<D3>, D3> && usable<DeadZone<D3>, D3>);
static_assert(usable<Backlash<D3>, D3> && usable<Cubic<D3>, D3>);
static_assert(HasModes<Coulomb<D3>, D3> && HasModes<Stribeck<D3>, D3> && HasModes<Relay<D3>, D3>);
static_assert(HasModes<Saturation<D3>, D3> && HasModes<DeadZone<D3>, D3> && HasModes<Backlash<D3>, D3>);

/// Derivative of f at a by an extrapolated central difference (error h^4).
template <class F>
double slope(F f, double a) {
  const double h = 1e-3 * std::max(1.0, std::abs(a));
  const auto central = [&](double step) { return (f(a + step) - f(a - step)) / (2.0 * step); };
  return (4.0 * central(0.5 * h) - central(h)) / 3.0;
}

template <class F>
void check_against_difference(F f, double a) {
  const Dual<1> result = f(Dual<1>::variable(a, 0));
  CHECK(result.value == f(a));
  CHECK(result.d[0] == Approx(slope([&](double x) { return f(x); }, a)).epsilon(1e-8).margin(1e-9));
}

}  // namespace

TEST_CASE("dual numbers differentiate every function that laws call", "[dual]") {
  for (const double a : {0.3, 1.7, 4.0}) {
    using std::abs, std::exp, std::log, std::sqrt, std::sin, std::cos, std::tanh;
    check_against_difference([](auto x) { return exp(-x * x) + 2.0 * x - x / 3.0; }, a);
    check_against_difference([](auto x) { return (1.0 - x) / (2.0 + x * x) - 5.0 / x; }, a);
    check_against_difference([](auto x) { return abs(-x) * abs(x - 1.0) + (+x); }, a);
    check_against_difference([](auto x) { return log(x) * sqrt(x); }, a);
    check_against_difference([](auto x) { return sin(x) * cos(2.0 * x) + tanh(x); }, a);
    check_against_difference([](auto x) { return power(x, decltype(x)(2.0)) + power(x, decltype(x)(1.0)); }, a);
    check_against_difference([](auto x) { return power(x, decltype(x)(1.5)) + power(decltype(x)(1.3), x); }, a);
    check_against_difference([](auto x) { return power(x, x); }, a);
    check_against_difference([](auto x) { return select(x < 1.0, x * x, 3.0 * x) * sign(x - 2.0); }, a);
    check_against_difference(
        [](auto x) {
          auto y = x;
          y += 2.0;
          y *= x;
          y -= 0.5 * x;
          y /= x + 1.0;
          return y;
        },
        a);
  }
}

TEST_CASE("dual numbers keep several partial derivatives apart", "[dual]") {
  const auto x = Dual<2>::variable(3.0, 0), y = Dual<2>::variable(0.5, 1);
  const auto f = x * x * y + power(x, y);
  CHECK(f.value == Approx(4.5 + std::sqrt(3.0)));
  CHECK(f.d[0] == Approx(2.0 * 3.0 * 0.5 + 0.5 / std::sqrt(3.0)));
  CHECK(f.d[1] == Approx(9.0 + std::sqrt(3.0) * std::log(3.0)));
}

TEST_CASE("dual numbers stay finite where a derivative does not exist", "[dual]") {
  const auto zero = Dual<1>::variable(0.0, 0);
  CHECK(abs(zero).d[0] == 0.0);
  CHECK(sqrt(zero).d[0] == 0.0);
  for (const double p : {0.0, 0.5, 1.5, 2.0, 3.0}) CHECK(power(zero, Dual<1>(p)).d[0] == 0.0);
  CHECK(power(zero, Dual<1>(1.0)).d[0] == 1.0);
  const auto with_exponent = power(Dual<1>(0.0), Dual<1>::variable(2.0, 0));
  CHECK(with_exponent.value == 0.0);
  CHECK(with_exponent.d[0] == 0.0);
}

TEST_CASE("comparisons of dual numbers look at values only", "[dual]") {
  const auto a = Dual<1>::variable(1.0, 0);
  CHECK(a == 1.0);
  CHECK(a == Dual<1>(1.0));
  CHECK_FALSE(a < 1.0);
  CHECK(0.5 < a);
  CHECK(a <= 1.0);
  CHECK(a >= Dual<1>(0.9));
  CHECK(2.0 > a);
  CHECK(value_of(a) == 1.0);
  CHECK(value_of(2.5) == 2.5);
}

TEST_CASE("LuGre on dual numbers gives the derivatives of its equations", "[dual][lugre]") {
  LuGre<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = 300.0;
  law.sigma2 = 0.4;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const double delta : {0.7, 1.0, 2.0}) {
    law.delta = delta;
    for (const int curve : {0, 1, 2}) {
      law.curve = {curve};
      const double v = 2e-3 * unit(random), z = 1.5e-5 * unit(random);
      auto dual = recast<LuGre, Dual<2>>(law);
      const Input<Dual<2>> in{0.0, Dual<2>::variable(v, 0), 0.0};
      const Dual<2> state[1] = {Dual<2>::variable(z, 1)};
      const auto output = dual.output(in, {}, state);
      const auto plain = [&](double rate, double deflection) {
        const double s[1] = {deflection};
        return law.output({0.0, rate, 0.0}, {}, s);
      };
      const double h = 1e-5 * std::abs(v), hz = 1e-9;
      CHECK(output.value == plain(v, z));
      CHECK(output.d[0] == Approx((plain(v + h, z) - plain(v - h, z)) / (2.0 * h)).epsilon(1e-6));
      CHECK(output.d[1] == Approx((plain(v, z + hz) - plain(v, z - hz)) / (2.0 * hz)).epsilon(1e-6));
    }
  }
}
