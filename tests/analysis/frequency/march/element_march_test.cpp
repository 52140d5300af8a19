// The march through modes on a law with several states, as later laws have: parallel Jenkins elements whose slip is a
// mode and whose switches depend on the state.
#include "limcycle/analysis/frequency/march/element_march.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/models/element/element_face.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

/// Two springs k_i in series with sliders W_i; z_i is the stretch of a spring. Mode: digit i to base 3 is 0 for stick,
/// 1 for slip forwards, 2 for slip backwards.
template <class S>
struct TwoJenkins {
  S k1{}, k2{}, W1{}, W2{};

  static constexpr std::string_view kind = "two-jenkins";
  static std::vector<Parameter<TwoJenkins, S>> parameters() {
    return {{"k1", "N/m", "", &TwoJenkins::k1},
            {"k2", "N/m", "", &TwoJenkins::k2},
            {"W1", "N", "", &TwoJenkins::W1},
            {"W2", "N", "", &TwoJenkins::W2}};
  }
  S k(int i) const { return i == 0 ? k1 : k2; }
  S W(int i) const { return i == 0 ? W1 : W2; }
  static int digit(Mode mode, int i) { return static_cast<int>(i == 0 ? mode.value % 3 : mode.value / 3); }

  int states() const { return 2; }
  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> dz) const {
    for (int i = 0; i < 2; ++i) dz[static_cast<std::size_t>(i)] = digit(mode, i) == 0 ? in.v : S(0.0);
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return k1 * z[0] + k2 * z[1]; }
  int guards(Mode) const { return 4; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    for (int i = 0; i < 2; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const S force = k(i) * z[at];
      const int digit_i = digit(mode, i);
      g[2 * at] = digit_i == 0 ? W(i) - force : digit_i == 1 ? in.v : -in.v;
      g[2 * at + 1] = digit_i == 0 ? W(i) + force : S(1.0);
    }
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    const int i = fired / 2, slip = fired % 2 == 0 ? 1 : 2, now = digit(mode, i);
    const int then = now == 0 ? slip : 0;
    return {mode.value + (then - now) * (i == 0 ? 1 : 3)};
  }
  Mode start(const Input<double>&, std::span<double>) const { return {}; }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const {
    const auto turned = [](int d) { return d == 0 ? 0 : 3 - d; };
    return {turned(digit(mode, 0)) + 3 * turned(digit(mode, 1))};
  }
  Scales scales() const { return {.displacement = value_of(W1 / k1), .output = value_of(W1 + W2)}; }
  double state_scale(int i) const { return value_of(W(i) / k(i)); }
};
static_assert(HasModes<TwoJenkins<double>, double> && HasModes<TwoJenkins<Dual<1>>, Dual<1>>);

/// Claim A8.
std::complex<double> jenkins(double k, double W, double A) {
  const double h = W / k;
  if (A <= h) return k;
  const double u = 1.0 - 2.0 * h / A, f = 2.0 / pi * (std::asin(u) + u * std::sqrt(1.0 - u * u));
  return {0.5 * k * (1.0 - f), 4.0 * W / (pi * A) * (1.0 - h / A)};
}

}  // namespace

TEST_CASE("parallel Jenkins elements with modes give their closed form", "[df][march][claims]") {
  const TwoJenkins<double> law{1000.0, 400.0, 1.5, 2.0};
  CHECK(std::abs(jenkins(1000.0, 1.5, 0.004) - std::complex<double>(342.518821, 298.415518)) < 1e-6);
  for (const double A : {1e-4, 1.4e-3, 1.51e-3, 4e-3, 5.001e-3, 2e-2}) {
    for (const double accuracy : {1e-6, 1e-10}) {
      CAPTURE(A, accuracy);
      const PrescribedMotion motion(A, 2.0, 0.0, true);
      QuadratureRoute route(law, motion, true, with(DfMethod::quadrature, accuracy));
      const auto df = route.refine();
      CHECK(df.status == Status::converged);
      CHECK(df.symmetric);
      CHECK(apart(df.gain, jenkins(1000.0, 1.5, A) + jenkins(400.0, 2.0, A)) <= df.error + 1e-14);
    }
  }
}

TEST_CASE("a mean velocity drags every slider", "[df][march]") {
  // Without reversals all sliders slip and the force is their sum; with few, the two routes over the same elements
  // agree with a sum of single ones.
  const TwoJenkins<double> law{1000.0, 400.0, 1.5, 2.0};
  const PrescribedMotion fast(1e-3, 2.0, 1.0, true);
  QuadratureRoute steady(law, fast, false, with(DfMethod::quadrature, 1e-8));
  const auto sliding = steady.refine();
  CHECK(sliding.status == Status::converged);
  CHECK(sliding.mean == Approx(3.5).epsilon(1e-12));
  CHECK(sliding.gain == 0.0);

  const PrescribedMotion slow(4e-3, 2.0, 1e-3, true);
  QuadratureRoute both(law, slow, false, with(DfMethod::quadrature, 1e-8));
  const auto together = both.refine();
  std::complex<double> sum;
  double mean = 0.0;
  for (const auto& [k, W] : {std::pair{1000.0, 1.5}, {400.0, 2.0}}) {
    Dahl<double> single;  // with exponent 0 a Jenkins element, without modes
    single.Fc = W;
    single.sigma0 = k;
    single.exponent = 0.0;
    const auto df = describing_function(single, {4e-3, 2.0, 1e-3}, with(DfMethod::quadrature, 1e-8));
    sum += df.gain;
    mean += df.mean;
  }
  CHECK(apart(together.gain, sum) < 1e-6);
  CHECK(together.mean == Approx(mean).epsilon(1e-6));
}
