#include "limcycle/analysis/lanes/slope.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/lanes/pack.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

using P = Pack<2, Isa::scalar>;
using D = Dual<1>;

/// The law on another scalar.
template <class S>
LuGre<S> lugre_on(int curve, double delta, double vd) {
  auto law = test::with_levels<LuGre<S>>(1.5, 1.0);
  law.Fs_minus = S(1.8);
  law.vs = S(1e-3);
  law.sigma0 = S(1e5);
  law.sigma1 = S(300.0);
  law.sigma2 = S(0.4);
  law.delta = S(delta);
  law.vd = S(vd);
  law.curve.index = curve;
  return law;
}

void check(const Slope<P>& found, int lane, const D& expected) {
  CHECK(found.value[lane] == Approx(expected.value).epsilon(1e-12).margin(1e-300));
  CHECK(found.slope[lane] == Approx(expected.d[0]).epsilon(1e-11).margin(1e-300));
}

}  // namespace

TEST_CASE("The slope of a law in lanes is that of dual numbers") {
  for (const int curve : {0, 1, 2})
    for (const double delta : {0.7, 1.0, 1.6, 2.0})
      for (const double vd : {0.0, 0.01})
        for (const double v : {-0.3, -2e-3, -1e-9, 0.0, 1e-5, 7e-4, 0.05}) {
          CAPTURE(curve, delta, vd, v);
          double both[2] = {v, -v};
          Input<Slope<P>> in;
          in.v = Slope<P>(P::load(both), P(1.0));
          const auto law = lugre_on<Slope<P>>(curve, delta, vd);
          const auto rate = law.linear_rate(in);
          const auto output = law.linear_output(in);
          for (int lane = 0; lane < 2; ++lane) {
            Input<D> at;
            at.v = D::variable(both[lane], 0);
            const auto dual = lugre_on<D>(curve, delta, vd);
            check(rate.source, lane, dual.linear_rate(at).source);
            check(rate.decay, lane, dual.linear_rate(at).decay);
            check(output.damping, lane, dual.linear_output(at).damping);
            check(output.rest, lane, dual.linear_output(at).rest);
          }
        }
}
