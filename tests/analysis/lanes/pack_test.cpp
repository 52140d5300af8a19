// Elementary functions of packs against those of the C library, over the whole range of doubles.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "limcycle/tests/analysis/lanes/pack_functions.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(), no_number = std::numeric_limits<double>::quiet_NaN();

/// Distance in units of the last place of the exact value, which may be denormal.
double units(double got, long double exact) {
  const auto rounded = static_cast<double>(exact);
  if (got == rounded) return 0.0;
  const double spacing = std::max(std::nextafter(std::abs(rounded), inf) - std::abs(rounded), 5e-324);
  return static_cast<double>(std::abs(static_cast<long double>(got) - exact) / spacing);
}

PackFunctions functions(Isa isa) {
  return isa == Isa::avx512 ? avx512_pack_functions()
         : isa == Isa::avx2 ? avx2_pack_functions()
                            : scalar_pack_functions();
}

/// Calls check(functions) for every available set; an unavailable one must be wider than best_isa().
template <class Check>
void on_every_set(Check check) {
  for (const Isa isa : all_isas()) {
    CAPTURE(to_string(isa));
    if (is_available(isa))
      check(functions(isa));
    else
      CHECK(best_isa() < isa);
  }
}

std::vector<double> spread_over_doubles(double low, double high, int count) {
  std::mt19937_64 source(5);
  std::uniform_real_distribution<double> even(low, high);
  std::vector<double> x(static_cast<std::size_t>(count));
  for (double& value : x) value = even(source);
  return x;
}

}  // namespace

TEST_CASE("exp of packs is that of the C library to 2 units", "[lanes]") {
  std::vector<double> x = spread_over_doubles(-750.0, 712.0, 400000);
  const auto small = spread_over_doubles(-1.0, 1.0, 100000);
  x.insert(x.end(), small.begin(), small.end());
  for (int k = 0; k < 1024; ++k) x.push_back((k % 2 == 0 ? 1.0 : -1.0) * std::ldexp(1.0, -k));
  for (const double special :
       {0.0, -0.0, 709.782712893384, -708.3964185322641, -745.1332191019411, -745.2, 709.79, 1e300})
    x.push_back(special);
  x.resize(x.size() / 8 * 8);
  std::vector<double> y(x.size());
  on_every_set([&](const PackFunctions& pack) {
    pack.exp(x.data(), y.data(), static_cast<int>(x.size()));
    double worst = 0.0, at = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = std::exp(static_cast<long double>(x[i]));
      if (std::isinf(static_cast<double>(exact))) {
        CHECK(std::isinf(y[i]));
        continue;
      }
      if (units(y[i], exact) > worst) {
        worst = units(y[i], exact);
        at = x[i];
      }
    }
    CAPTURE(worst, at);
    CHECK(worst <= 2.0);
    const std::vector<double> special{inf, -inf, no_number, -1e308, 1e308, -746.0, 0.0, 1.0};
    std::vector<double> e(8);
    pack.exp(special.data(), e.data(), 8);
    CHECK(e[0] == inf);
    CHECK(e[1] == 0.0);
    CHECK(std::isnan(e[2]));
    CHECK(e[3] == 0.0);
    CHECK(e[4] == inf);
    CHECK(e[5] == 0.0);
    CHECK(e[6] == 1.0);
  });
}

TEST_CASE("log, power and sqrt of packs are those of the C library", "[lanes]") {
  std::vector<double> x = spread_over_doubles(-745.0, 709.0, 200000);
  for (double& value : x) value = std::exp(value);
  const auto near = spread_over_doubles(0.5, 2.0, 100000);
  x.insert(x.end(), near.begin(), near.end());
  std::vector<double> y(x.size());
  on_every_set([&](const PackFunctions& pack) {
    const int count = static_cast<int>(x.size());
    double worst = 0.0;
    pack.log(x.data(), y.data(), count);
    for (std::size_t i = 0; i < x.size(); ++i)
      worst = std::max(worst, units(y[i], std::log(static_cast<long double>(x[i]))));
    CHECK(worst <= 2.0);
    pack.sqrt(x.data(), y.data(), count);
    worst = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, std::abs(y[i] - std::sqrt(x[i])));
    CHECK(worst == 0.0);
    for (const double exponent : {0.5, 1.0, 2.0, 3.7}) {
      CAPTURE(exponent);
      pack.power(x.data(), exponent, y.data(), count);
      worst = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const long double exact = std::pow(static_cast<long double>(x[i]), static_cast<long double>(exponent));
        if (exact > 1e300L || exact < 1e-300L) continue;
        const double roundings = 4.0 + std::abs(exponent * std::log(x[i]));
        worst = std::max(worst, units(y[i], exact) / roundings);
      }
      CHECK(worst <= 2.0);
    }
    const std::vector<double> special{0.0, inf, -1.0, no_number, 5e-324, 1.0, 2.0, -inf};
    std::vector<double> e(8);
    pack.log(special.data(), e.data(), 8);
    CHECK(e[0] == -inf);
    CHECK(e[1] == inf);
    CHECK(std::isnan(e[2]));
    CHECK(std::isnan(e[3]));
    CHECK(e[4] == Approx(std::log(5e-324)).epsilon(1e-15));
    CHECK(e[5] == 0.0);
    CHECK(std::isnan(e[7]));
    pack.power(special.data(), 0.5, e.data(), 8);
    CHECK(e[0] == 0.0);
  });
}

TEST_CASE("packs choose lane by lane", "[lanes]") {
  const std::vector<double> a{-1.0, 2.0, -0.0, 4.0, no_number, 6.0, -inf, 8.0},
      b{1.0, 1.0, 1.0, 9.0, 1.0, 5.0, 0.0, 8.0};
  on_every_set([&](const PackFunctions& pack) {
    std::vector<double> absolute(8), least(8), most(8), chosen(8);
    pack.choose(a.data(), b.data(), absolute.data(), least.data(), most.data(), chosen.data(), 8);
    for (std::size_t i = 0; i < 8; ++i) {
      CAPTURE(i);
      CHECK(std::bit_cast<std::uint64_t>(absolute[i]) == std::bit_cast<std::uint64_t>(std::abs(a[i])));
      CHECK(least[i] == (a[i] < b[i] ? a[i] : b[i]));
      CHECK(most[i] == (a[i] > b[i] ? a[i] : b[i]));
      CHECK(chosen[i] == (a[i] < b[i] ? a[i] : -b[i]));
    }
  });
}
