// Kernels of laws that are not linear in their state or that switch, against closed forms, quadrature, finer meshes and
// each other.
#include <catch2/catch.hpp>
#include <numbers>
#include <sstream>

#include "limcycle/analysis/frequency/kernels/df_kernel.hpp"
#include "limcycle/models/friction/bristle/bouc_wen.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"
#include "limcycle/tests/analysis/frequency/random_points.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

template <class Law>
void random_level(Random& random, Law& law) {
  law.Fc = law.Fc_minus = random.spread(0.1, 10.0);
  law.Fs = law.Fs_minus = law.Fc * random.uniform(1.0, 3.0);
  law.vs = random.spread(1e-5, 1e-2);
  law.delta = random.coin() ? 2.0 : random.uniform(0.5, 2.5);
  law.curve.index = random.coin() ? 0 : static_cast<int>(random.uniform(0.0, 3.0));
}

Element random_elasto_plastic(Random& random) {
  ElastoPlastic<double> law;
  random_level(random, law);
  law.sigma0 = random.spread(1e4, 1e7);
  law.sigma1 = random.coin() ? 0.0 : random.spread(1.0, 1e3);
  law.sigma2 = random.coin() ? 0.0 : random.spread(1e-3, 10.0);
  law.zba_ratio = random.uniform(0.3, 0.95);
  law.zba_of.index = random.coin() ? 1 : 0;
  return law;
}

/// Shares that add up to 1.
std::vector<double> random_shares(Random& random, std::size_t count) {
  std::vector<double> shares;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += shares.emplace_back(random.uniform(0.1, 1.0));
  for (double& share : shares) share /= sum;
  return shares;
}

Element random_xiong(Random& random) {
  Xiong<double> law;
  random_level(random, law);
  law.lambda = random_shares(random, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    law.K.push_back(random.spread(1e3, 1e6));
    law.sigma.push_back(random.spread(1.0, 1e3));
  }
  law.tau = random.spread(1e-4, 1.0);
  return law;
}

Element random_dahl(Random& random) {
  Dahl<double> law;
  law.Fc = random.spread(0.1, 10.0);
  law.sigma0 = random.spread(1e3, 1e6);
  law.exponent = random.coin() ? 2.0 : random.uniform(1.1, 3.0);
  return law;
}

Element random_bouc_wen(Random& random) {
  BoucWen<double> law;
  law.alpha = random.coin() ? 0.1 : 0.0;
  law.k = random.spread(1e3, 1e6);
  law.D = random.spread(1e-6, 1e-4);
  law.beta = random.uniform(0.0, 1.0);
  law.gamma = random.uniform(-0.5 * law.beta, 1.0);
  law.n = random.coin() ? 1.0 : random.coin() ? 2.0 : random.uniform(2.0, 4.0);
  return law;
}

/// Random laws at random points, against a mesh that is far finer or, where that has no answer and at one point of each
/// law, against the quadrature.
Tally tally(Element (*any_law)(Random&), int laws, unsigned seed) {
  Random random(seed);
  Tally t;
  for (int i = 0; i < laws; ++i) {
    const Element element = any_law(random);
    std::vector<DfPoint> points;
    points.reserve(40);
    for (int k = 0; k < 40; ++k) points.push_back({random.spread(1e-7, 1e-2), random.spread(0.1, 1000.0), 0.0});
    const double accuracy = random.spread(1e-8, 1e-3);
    std::vector<DescribingFunction> results(points.size());
    if (const auto kernel = DfKernel::of(element, asking(accuracy, best_isa(), 1))) kernel->compute(points, results);
    std::vector<DescribingFunction> fine(points.size());
    if (const auto kernel = DfKernel::of(element, asking(std::max(1e-4 * accuracy, 1e-10), best_isa(), 1)))
      kernel->compute(points, fine);
    for (std::size_t k = 0; k < points.size(); ++k) {
      ++t.points;
      if (results[k].method.empty()) {
        ++t.unanswered;
        continue;
      }
      CHECK(results[k].error <= accuracy);
      Complex gain = fine[k].gain;
      double room = fine[k].error;
      if (fine[k].method.empty() || k == 0) {
        const auto other = describing_function(element, points[k], with(DfMethod::quadrature, 1e-10, 1));
        if (!other.answered()) continue;
        gain = other.gain;
        room = 10.0 * other.error;
      }
      const double error = apart(results[k].gain, gain);
      if (error > 100.0 * room) t.looseness.push_back(results[k].error / error);
      if (error <= results[k].error + room) continue;
      ++t.broken;
      std::ostringstream text;
      text << "\nlaw " << i << " A " << points[k].amplitude << " w " << points[k].frequency << " accuracy " << accuracy
           << ": error " << error << " estimated " << results[k].error << " room " << room;
      t.which += text.str();
    }
  }
  return t;
}

ElastoPlastic<double> elasto_plastic() {
  ElastoPlastic<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = 316.0;
  law.sigma2 = 0.4;
  return law;
}

BoucWen<double> bouc_wen() {
  BoucWen<double> law;
  law.k = 1e5;
  law.D = 1e-5;
  law.beta = 0.7;
  law.gamma = 0.3;
  law.n = 2.0;
  return law;
}

template <class Law>
Law with_elements() {
  Law law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma2 = 0.4;
  return law;
}

Xiong<double> xiong() {
  auto law = with_elements<Xiong<double>>();
  law.K = {5e4, 3e4, 2e4};
  law.lambda = {0.3, 0.3, 0.4};
  law.sigma = {50.0, 30.0, 20.0};
  law.tau = 0.01;
  return law;
}

}  // namespace

TEST_CASE("march: the error is not above its estimate", "[df][kernel][march][error]") {
  struct Kind {
    const char* name;
    Element (*law)(Random&);
    int unanswered;  ///< of a hundred, at most
  };
  for (const Kind& kind : {Kind{"elasto-plastic", random_elasto_plastic, 1}, Kind{"xiong", random_xiong, 4},
                           Kind{"dahl", random_dahl, 1}, Kind{"bouc-wen", random_bouc_wen, 10}}) {
    const Tally t = tally(kind.law, 50, 21);
    CAPTURE(kind.name, t.points, t.unanswered, t.broken, t.which);
    CHECK(t.points == 2000);
    CHECK(100 * t.unanswered <= kind.unanswered * t.points);
    CHECK(t.broken == 0);
    // Not excessively larger: the largest true errors come near it.
    REQUIRE_FALSE(t.looseness.empty());
    CHECK(*std::ranges::min_element(t.looseness) < 30.0);
  }
}

TEST_CASE("march: agrees with quadrature and FFT, all harmonics", "[df][kernel][march]") {
  Random random(9);
  for (const Element& element : {Element(elasto_plastic()), Element(xiong()), Element(dahl(2.0)), Element(bouc_wen())})
    for (int i = 0; i < 6; ++i) {
      const DfPoint point{random.spread(1e-6, 1e-2), random.spread(0.1, 100.0), 0.0};
      const double accuracy = random.spread(1e-8, 1e-4);
      const auto df = describing_function(element, point, asking(accuracy));
      const auto other = describing_function(element, point, with(DfMethod::quadrature, 1e-11));
      CAPTURE(std::string(element.kind()), point.amplitude, point.frequency, accuracy);
      REQUIRE(df.status == Status::converged);
      CHECK(df.error <= accuracy);
      CHECK(apart(df.gain, other.gain) <= df.error + 10.0 * other.error);
      CHECK(df.mean == Approx(other.mean).margin(1e-6 * std::abs(other.harmonics[0])));
      CHECK(df.dissipation == Approx(other.dissipation).epsilon(1e-3));
      for (std::size_t k = 0; k < 7; ++k)
        CHECK(std::abs(df.harmonics[k] - other.harmonics[k]) <= 20.0 * df.error * std::abs(df.harmonics[0]) + 1e-11);
      if (i != 0) continue;
      const auto samples = describing_function(element, point, with(DfMethod::fft, 1e-3));
      CHECK(apart(df.gain, samples.gain) <= df.error + samples.error);
    }
}

TEST_CASE("march: Bouc-Wen with gamma = 0, n = 1 is Dahl, in closed form", "[df][kernel][march][claims]") {
  BoucWen<double> law = bouc_wen();
  law.beta = 1.0;
  law.gamma = 0.0;
  law.n = 1.0;
  for (const double accuracy : {1e-4, 1e-6, 1e-8})
    for (const double A : {1e-7, 5e-6, 1e-5, 5e-5, 1e-3}) {
      CAPTURE(accuracy, A);
      const double a = A * 1e5;
      const Complex expected(
          2.0 / A * std::cyl_bessel_i(1.0, a) / std::cosh(a),
          4.0 / (pi * A) * (a < 1e-3 ? a * a * (1.0 / 3.0 - 2.0 / 15.0 * a * a) : 1.0 - std::tanh(a) / a));
      const auto df = describing_function(law, {A, 3.0, 0.0}, asking(accuracy));
      CHECK(df.method == "kernel");
      CHECK(apart(df.gain, expected) <= df.error);
    }
}

TEST_CASE("march: what never slips is a spring", "[df][kernel][march]") {
  for (const double w : {0.1, 10.0, 1000.0}) {
    CAPTURE(w);
    const auto elastic = describing_function(elasto_plastic(), {1e-6, w, 0.0}, asking(1e-8));
    CHECK(elastic.method == "kernel");
    CHECK(apart(elastic.gain, {1e5, w * (316.0 + 0.4)}) < 1e-10);
    const auto below = describing_function(xiong(), {1e-6, w, 0.0}, asking(1e-8));
    CHECK(below.method == "kernel");
    CHECK(apart(below.gain, {1e5, w * (100.0 + 0.4)}) < 1e-10);
  }
}

TEST_CASE("march: a finer mesh is as much better as its order says", "[df][kernel][march][order]") {
  // Five stages, from panels of 0.8 to 0.55: (0.8/0.55)^9 = 29 for a smooth integrand.
  const MarchedHalfPeriod half(*KernelLaw::of(elasto_plastic()), asking(1e-6));
  double coarse = 0.0, fine = 0.0, finest = 0.0;
  for (const DfPoint& point : grid(7, 5)) {
    CAPTURE(point.amplitude, point.frequency);
    const auto exact = half.on_mesh(point, 5);
    REQUIRE(exact);
    coarse = std::max(coarse, apart(*half.on_mesh(point, 1), *exact));
    fine = std::max(fine, apart(*half.on_mesh(point, 2), *exact));
    finest = std::max(finest, apart(*half.on_mesh(point, 3), *exact));
  }
  CAPTURE(coarse, fine, finest);
  CHECK(fine < coarse / 10.0);
  CHECK(finest < fine / 30.0);
}

TEST_CASE("march: instruction sets agree, neither threads nor the other points change a number",
          "[df][kernel][march][isa][threads]") {
  const auto points = grid(11, 13);
  for (const Element& element :
       {Element(elasto_plastic()), Element(xiong()), Element(dahl(1.5)), Element(bouc_wen())}) {
    const auto portable = describing_function_table(element, points, asking(1e-6));
    for (const Isa isa : all_isas()) {
      CAPTURE(std::string(element.kind()), to_string(isa));
      if (!is_available(isa)) continue;
      auto options = asking(1e-6, isa);
      const auto table = describing_function_table(element, points, options);
      options.threads = 2;
      const auto threaded = describing_function_table(element, points, options);
      double worst = 0.0;
      bool same = true;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double room = portable[i].error + table[i].error;
        worst = std::max(worst, apart(table[i].gain, portable[i].gain) / room);
        same = same && table[i].harmonics == threaded[i].harmonics && table[i].error == threaded[i].error;
      }
      CHECK(worst <= 1.0);
      CHECK(same);
      options.threads = 1;
      for (const std::size_t i : {std::size_t{3}, std::size_t{70}, std::size_t{140}})
        CHECK(describing_function(element, points[i], options).gain == table[i].gain);
    }
  }
}

TEST_CASE("march: extreme parameters", "[df][kernel][march][extreme]") {
  for (const double vs : {1e-9, 1e-3, 1e3})
    for (const double sigma0 : {1e-3, 1e5, 1e12})
      for (const double A : {1e-12, 1e-5, 1e3})
        for (const double w : {1e-6, 1.0, 1e6}) {
          ElastoPlastic<double> law = elasto_plastic();
          law.vs = vs;
          law.sigma0 = sigma0;
          law.sigma1 = 0.0;
          CAPTURE(vs, sigma0, A, w);
          std::vector<DescribingFunction> results(1);
          const DfPoint point{A, w, 0.0};
          DfKernel::of(law, asking(1e-6))->compute({&point, 1}, results);
          if (results[0].method.empty()) continue;
          CHECK(results[0].error <= 1e-6);
          const Complex gain = results[0].gain;
          CHECK(gain.imag() >= 0.4 * w - results[0].error * std::abs(gain));
          if (sigma0 * A < 0.6) CHECK(gain.real() == Approx(sigma0).epsilon(1e-6));
          const double part = (gain.imag() - 0.4 * w) * pi * A / 4.0;
          if (sigma0 * A > 1e6 && 0.4 * w * A < 1e3) CHECK(part >= 0.999 * law.Fc);
          if (sigma0 * A > 1e6 && 0.4 * w * A < 1e3) CHECK(part <= 1.001 * law.Fs);
        }
}

TEST_CASE("march: what it leaves to other methods", "[df][kernel][march]") {
  auto uneven = elasto_plastic();
  uneven.Fc_minus = 0.9;
  CHECK_FALSE(DfKernel::of(uneven, asking(1e-6)));
  auto fading = elasto_plastic();
  fading.vd = 0.1;
  CHECK_FALSE(DfKernel::of(fading, asking(1e-6)));
  auto growing = bouc_wen();
  growing.beta = -0.1;
  CHECK_FALSE(DfKernel::of(growing, asking(1e-6)));
  auto branched = bouc_wen();
  branched.n = 1.5;
  CHECK_FALSE(DfKernel::of(branched, asking(1e-6)));
  CHECK_FALSE(DfKernel::of(dahl(0.5), asking(1e-6)));
  CHECK(describing_function(elasto_plastic(), {1e-3, 1.0, 0.01}).method == "quadrature");
  CHECK(describing_function(elasto_plastic(), {1e-3, 1.0, 0.0}).method == "kernel");
}
