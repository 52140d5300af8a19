#include "limcycle/analysis/lanes/twin.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "limcycle/analysis/lanes/pack.hpp"

using namespace limcycle;

namespace {

using P = Pack<2, Isa::scalar>;
using T = Twin<P>;

/// f on a twin gives in every lane the same as on a pack of that lane's numbers.
template <class F>
void check(const F& f) {
  const double x[4] = {-1.5, 0.25, 3.0, 0.0}, y[4] = {2.0, 0.25, -1.0, 1e-3};
  const T twin = f(T(P::load(x), P::load(x + 2)), T(P::load(y), P::load(y + 2)));
  for (int lane = 0; lane < T::lanes; ++lane) {
    const double expected = f(P(x[lane]), P(y[lane]))[0];
    CAPTURE(lane);
    CHECK((twin[lane] == expected || (std::isnan(twin[lane]) && std::isnan(expected))));
  }
}

}  // namespace

TEST_CASE("A twin computes in both halves what a pack computes") {
  check([](auto x, auto y) { return x + y * 3.0 - x / y; });
  check([](auto x, auto y) { return -(x -= y); });
  check([](auto x, auto y) { return (x += y) * (y *= x); });
  check([](auto x, auto y) { return min(x, y) + 10.0 * max(x, y) + 100.0 * abs(x); });
  check([](auto x, auto y) { return exp(x) + log(abs(y)); });
  check([](auto x, auto) { return power(abs(x), decltype(x)(1.7)); });
  check([](auto x, auto y) { return select((x < y) | (x > 2.0), x, y); });
  check([](auto x, auto y) { return select((x <= y) & !(x >= 0.25), x, y); });
}

TEST_CASE("A mask of a twin knows all and any over both halves") {
  const double x[4] = {1.0, 1.0, 1.0, -1.0};
  const T mixed(P::load(x), P::load(x + 2));
  CHECK((mixed > 0.0).any());
  CHECK_FALSE((mixed > 0.0).all());
  CHECK((mixed < 2.0).all());
  CHECK_FALSE((mixed > 2.0).any());
}
