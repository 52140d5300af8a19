/// The period of a law that is linear in its state, in one pass, against the march that knows nothing of that.
#include "limcycle/analysis/frequency/kernels/linear_period.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/friction/own_law.hpp"
#include "limcycle/tests/analysis/frequency/random_points.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// LuGre with other levels backwards, and with damping that fades, by chance.
LuGre<double> some_lugre(Random& random) {
  const double Fc = random.spread(0.1, 10.0);
  LuGre<double> law = lugre(Fc * random.uniform(1.0, 3.0), Fc, random.uniform(0.0, 1.0));
  law.sigma0 = random.spread(1e3, 1e7);
  law.sigma1 = random.coin() ? 0.0 : random.spread(1.0, 1e3);
  law.vs = random.spread(1e-4, 0.1);
  if (random.coin()) {
    law.Fs_minus *= 1.3;
    law.Fc_minus *= 1.2;
  }
  if (random.coin()) law.vd = random.spread(1e-3, 0.1);
  return law;
}

DescribingFunction computed(const Element& law, const DfPoint& point, DfMethod method, double accuracy) {
  const PrescribedMotion motion(point.amplitude, point.frequency, point.bias, true);
  const bool symmetric = law.odd() && point.bias == 0.0;
  return QuadratureRoute(law, motion, symmetric, with(method, accuracy)).refine();
}

}  // namespace

TEST_CASE("period of a linear law: the harmonics of the march by Newton, biased or not") {
  Random random(271828);
  for (int k = 0; k < samples(60); ++k) {
    const Element law = k % 5 == 0 ? Element(dahl()) : Element(some_lugre(random));
    const double A = random.spread(1e-7, 1.0), w = random.spread(0.1, 1e3);
    const DfPoint point{A, w, k % 3 == 0 ? 0.0 : random.spread(0.01, 100.0) * A * w * (random.coin() ? 1.0 : -1.0)};
    INFO(law.kind() << ", A " << A << ", w " << w << ", bias " << point.bias);
    const auto pass = computed(law, point, DfMethod::automatic, 1e-8);
    const auto march = computed(law, point, DfMethod::quadrature, 1e-8);
    REQUIRE(pass.answered());
    REQUIRE(march.answered());
    for (std::size_t order = 0; order < march.harmonics.size(); ++order)
      CHECK(std::abs(pass.harmonics[order] - march.harmonics[order]) <=
            (pass.error + march.error + 1e-9) * std::abs(march.harmonics[0]) + 1e-12 * std::abs(march.mean));
    CHECK(pass.symmetric == march.symmetric);
    CHECK(pass.evaluations < march.evaluations);
  }
}

TEST_CASE("period of a linear law: the error that it states is true") {
  Random random(314159);
  for (int k = 0; k < samples(40); ++k) {
    const Element law = some_lugre(random);
    const double A = random.spread(1e-6, 0.1), w = random.spread(0.1, 1e3);
    const DfPoint point{A, w, random.uniform(-2.0, 2.0) * A * w};
    const auto rough = computed(law, point, DfMethod::automatic, 1e-4);
    const auto best = computed(law, point, DfMethod::quadrature, 1e-11);
    INFO("A " << A << ", w " << w << ", bias " << point.bias);
    CHECK(rough.error <= 1e-4);
    CHECK(apart(rough.gain, best.gain) <= rough.error + best.error);
  }
}

namespace {

/// A bristle that yields at a level of its own shape; `bent`: a rate that is not linear in the state.
struct OwnBristle {
  static constexpr std::string_view kind = "own-bristle";
  double Fs = 1.5, Fc = 1.0, vs = 0.001, s = 1e5, d = 300.0, bent = 0.0;

  double slip(double v, double z) const {
    const double share = s * z / (Fc + (Fs - Fc) / (1.0 + v * v / (vs * vs)));
    return v - std::abs(v) * share * (1.0 + bent * share * share);
  }
  int states() const { return 1; }
  void rate(const Input<double>& in, Mode, std::span<const double> z, std::span<double> dz) const {
    dz[0] = slip(in.v, z[0]);
  }
  double output(const Input<double>& in, Mode, std::span<const double> z) const {
    return s * z[0] + d * slip(in.v, z[0]);
  }
  Scales scales() const { return {.displacement = Fs / s, .velocity = vs, .output = Fs}; }
  bool odd() const { return true; }
};

}  // namespace

TEST_CASE("period of a linear law: that of a user, found to be linear, and one that is not") {
  Random random(161803);
  for (const double bent : {0.0, 1e-6, 0.5}) {
    OwnBristle bristle;
    bristle.bent = bent;
    const Element law = own_law(bristle);
    for (int k = 0; k < samples(20); ++k) {
      const double A = random.spread(1e-6, 0.1), w = random.spread(0.1, 1e3);
      const DfPoint point{A, w, k % 2 == 0 ? 0.0 : random.uniform(-2.0, 2.0) * A * w};
      INFO("bent " << bent << ", A " << A << ", w " << w << ", bias " << point.bias);
      const auto pass = computed(law, point, DfMethod::automatic, 1e-6);
      const auto march = computed(law, point, DfMethod::quadrature, 1e-6);
      REQUIRE(pass.answered());
      CHECK(apart(pass.gain, march.gain) <= pass.error + march.error);
      if (bent == 0.0)
        CHECK(pass.evaluations < march.evaluations);
      else
        CHECK(pass.gain == march.gain);
    }
  }
}

TEST_CASE("period of a linear law: none for a law that is not, nor for a state that does not decay") {
  CHECK_FALSE(LinearPeriod::of(dahl(0.5)));
  CHECK_FALSE(LinearPeriod::of(coulomb(1.0, 1.0)));
  const Element law = dahl();
  auto period = LinearPeriod::of(law);
  REQUIRE(period);
  HarmonicSums sums(1);
  const PrescribedMotion hardly(1e-20, 1.0, 0.0, true);
  const MeshSettings mesh{4, 1.0, 0.1};
  CHECK_FALSE(period->find(hardly, graded_mesh(hardly, law.scales(), mesh), mesh.stages, false, sums));
}
