#include "limcycle/analysis/energy/passivity/reference_march.hpp"

#include <catch2/catch.hpp>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/friction_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

template <class Law>
Element element_of(const Settings& settings) {
  return Element(made<Law>(settings));
}

}  // namespace

TEST_CASE("work of a fast step on preloaded lugre is that of the closed form (claim D2)") {
  const auto law = element_of<LuGre<double>>(with(bristle, {{"sigma1", root}}));
  const double Fs = 1.5, Fc = 1.0, sigma0 = 1e5, V = 1.0, X = 1e-5, settling = Fc / sigma0;
  const ReferenceMarch run = reference_march(law, {{0.0, X / V}, {V, V}}, {Fs / sigma0}, Mode{}, 1);
  const double faded = settling * (1.0 - std::exp(-X / settling));
  const double work = Fc * X + (Fs - Fc) * faded - root * V * ((Fs - Fc) / Fc) * faded;
  REQUIRE(run.status == Status::converged);
  CHECK(work == Approx(-9.86e-4).epsilon(1e-3));
  CHECK(run.supplied == Approx(work).epsilon(1e-10));
  CHECK(run.taken.at(0) == Approx(-work).epsilon(1e-10));
  CHECK(run.z.at(0) == Approx(Fc / sigma0 + (Fs - Fc) / sigma0 * std::exp(-X / settling)).epsilon(1e-10));
}

TEST_CASE("a slider loses its level times the way slipped, cycle by cycle") {
  const double k = 1000.0, Fc = 1.5, A = 0.004, V = 0.1;
  const auto law = element_of<Jenkins<double>>({{"k", k}, {"Fc", Fc}});
  const double T = 2.0 * A / V;
  const VelocityCycle input{{0.0, T, T, 2.0 * T}, {V, V, -V, -V}};
  const ReferenceMarch run = reference_march_virgin(law, input, 5);
  REQUIRE(run.status == Status::converged);
  REQUIRE(run.taken.size() == 5);
  const double stretched = Fc / k;
  // First stroke from no stretch, the others from the other limit.
  const double first = 0.5 * Fc * stretched + Fc * (2.0 * A - stretched), later = Fc * (2.0 * A - 2.0 * stretched);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(-run.taken[i] == Approx(first + later * (2.0 * static_cast<double>(i) + 1.0)).epsilon(1e-9));
}

TEST_CASE("ramps of the velocity are split where it changes its sign") {
  const double Fc = 1.0, sigma2 = 0.3, V = 0.2, T = 3.0;
  const auto law = element_of<Coulomb<double>>({{"Fc", Fc}, {"Fs", 1.5}, {"sigma2", sigma2}});
  const ReferenceMarch run = reference_march_virgin(law, {{0.0, T}, {-V, V}}, 3);
  REQUIRE(run.status == Status::converged);
  CHECK(run.supplied == Approx(3.0 * (Fc * V * T / 2.0 + sigma2 * V * V * T / 3.0)).epsilon(1e-10));
}

TEST_CASE("a short stroke within a long period keeps its digits") {
  const auto law = element_of<LuGre<double>>(bristle);
  const double fast = 1e-9, slow = 1e4;
  const VelocityCycle input{{0.0, fast, fast, fast + slow}, {1e3, 1e3, -1e-9, -1e-9}};
  const ReferenceMarch run = reference_march(law, input, {0.0}, Mode{}, 1);
  REQUIRE(run.status == Status::converged);
  // z and F = sigma0 z at constant v have closed forms; the levels are Fc and Fs.
  const double X1 = 1e3 * fast, l1 = 1e-5, z1 = l1 * (1.0 - std::exp(-X1 / l1));
  const double X2 = 1e-9 * slow, l2 = 1.5e-5, z2 = -l2 + (z1 + l2) * std::exp(-X2 / l2);
  const double work1 = X1 - l1 * (1.0 - std::exp(-X1 / l1));
  const double work2 = 1.5 * X2 - 1e5 * (z1 + l2) * l2 * (1.0 - std::exp(-X2 / l2));
  CHECK(run.z.at(0) == Approx(z2).epsilon(1e-8));
  CHECK(run.supplied == Approx(work1 + work2).epsilon(1e-8));
}

TEST_CASE("a simulation that cannot go on says so") {
  const auto law = element_of<LuGre<double>>(with(bristle, {{"sigma1", root}}));
  const VelocityCycle input{{0.0, 1.0, 1.0, 2.0}, {0.1, 0.1, -0.1, -0.1}};
  ReferenceMarchOptions few;
  few.max_steps = 5;
  CHECK(reference_march_virgin(law, input, 1, few).status == Status::max_iterations);
  ReferenceMarchOptions stopped;
  stopped.stop = [] { return true; };
  CHECK(reference_march_virgin(law, input, 10, stopped).status == Status::interrupted);
  CHECK_THROWS_AS(reference_march_virgin(law, {{0.0, 0.0}, {1.0, 1.0}}, 1), std::invalid_argument);
  CHECK_THROWS_AS(reference_march_virgin(law, {{0.0, 2.0, 1.0}, {1.0, 1.0, 1.0}}, 1), std::invalid_argument);
  CHECK_THROWS_AS(reference_march(law, input, {0.0, 0.0}, Mode{}, 1), std::invalid_argument);
}
