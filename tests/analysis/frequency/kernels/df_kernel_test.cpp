// The kernels of describing functions against closed forms, other methods, finer meshes and each other.
#include "limcycle/analysis/frequency/kernels/df_kernel.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <sstream>

#include "limcycle/models/friction/bristle/bouc_wen.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/analysis/frequency/random_points.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

/// `tame`: with an error bound known in advance.
LuGre<double> random_lugre(Random& random, bool tame) {
  LuGre<double> law;
  law.Fc = law.Fc_minus = random.spread(0.1, 10.0);
  law.Fs = law.Fs_minus = law.Fc * (tame ? random.uniform(1.0, 4.0) : random.spread(1.0, 30.0));
  law.vs = random.spread(1e-6, 1e-1);
  law.delta = random.coin() ? 2.0 : tame ? random.uniform(0.5, 2.0) : random.uniform(0.5, 5.0);
  law.curve.index = static_cast<int>(random.uniform(0.0, 3.0));
  law.sigma0 = random.spread(1e3, 1e8);
  law.sigma1 = random.coin() ? 0.0 : random.spread(1.0, 1e4);
  law.sigma2 = random.coin() ? 0.0 : random.spread(1e-3, 10.0);
  if (!tame && random.coin()) law.vd = random.spread(1e-4, 1e-1);
  return law;
}

std::vector<DescribingFunction> by_kernel(const Element& element, const std::vector<DfPoint>& points,
                                          const DfOptions& options) {
  const auto kernel = DfKernel::of(element, options);
  REQUIRE(kernel);
  std::vector<DescribingFunction> results(points.size());
  kernel->compute(points, results);
  return results;
}

/// Random laws at random points, against the finest mesh, and if that gives no answer against the quadrature.
Tally tally(bool tame, int laws, unsigned seed) {
  Random random(seed);
  Tally t;
  for (int i = 0; i < laws; ++i) {
    const Element element = random_lugre(random, tame);
    std::vector<DfPoint> points;
    for (int k = 0; k < 20; ++k) points.push_back({random.spread(1e-7, 1e-1), random.spread(0.01, 1000.0), 0.0});
    const double accuracy = random.spread(1e-9, 1e-3);
    const auto results = by_kernel(element, points, asking(accuracy, best_isa(), 1));
    const auto exact = by_kernel(element, points, asking(1.3e-11, best_isa(), 1));
    for (std::size_t k = 0; k < points.size(); ++k) {
      ++t.points;
      if (results[k].method.empty()) {
        ++t.unanswered;
        continue;
      }
      CHECK(results[k].error <= accuracy);
      Complex gain = exact[k].gain;
      double room = exact[k].error;
      if (exact[k].method.empty()) {
        const auto other = describing_function(element, points[k], with(DfMethod::quadrature, 1e-10, 1));
        gain = other.gain;
        room = other.error;
      }
      const double error = apart(results[k].gain, gain);
      if (error > 100.0 * room) t.looseness.push_back(results[k].error / error);
      if (error <= results[k].error + room) continue;
      ++t.broken;
      const auto& law = law_of<LuGre<double>>(element);
      std::ostringstream text;
      text << "\nA " << points[k].amplitude << " w " << points[k].frequency << " Fs/Fc " << law.Fs / law.Fc << " vs "
           << law.vs << " delta " << law.delta << " curve " << law.curve.index << " sigma0 " << law.sigma0 << " sigma1 "
           << law.sigma1 << " vd " << law.vd << " accuracy " << accuracy << ": error " << error << " estimated "
           << results[k].error;
      t.which += text.str();
    }
  }
  return t;
}

/// First harmonic of the state, sine + j cosine after the reversal, on a mesh of this width.
Complex state_harmonic(const LuGre<double>& law, DfPoint point, HalfPeriodSettings settings) {
  const HalfPeriodPanels panels(settings.stages, settings.width, 1);
  std::vector<const double*> selected;
  const auto range =
      Layers({law.Fs / law.sigma0, law.vs, 0.0}, settings).range(panels, point.amplitude, point.frequency);
  panels.select(range, selected);
  const std::vector<double> amplitude(2, point.amplitude), frequency(2, point.frequency);
  std::vector<double> scratch(100000), sums(4);
  LinearTask task;
  task.collocation = &panels.collocation();
  task.panels = selected.data();
  task.panel_count = static_cast<int>(selected.size());
  task.orders = 1;
  task.remembered = range.remembered;
  task.amplitude = amplitude.data();
  task.frequency = frequency.data();
  task.scratch = scratch.data();
  task.state_sums = sums.data();
  scalar_linear_kernels.lugre[settings.stages](law, task);
  return {sums[0], sums[2]};
}

}  // namespace

TEST_CASE("kernel: the bound holds for every motion", "[df][kernel][error]") {
  const Tally t = tally(true, 450, 7);
  CAPTURE(t.points, t.unanswered, t.broken, t.which);
  CHECK(t.points == 9000);
  CHECK(t.unanswered == 0);
  CHECK(t.broken == 0);
  // Not excessively larger: the largest true errors come near it.
  CHECK(*std::ranges::min_element(t.looseness) < 5.0);
}

TEST_CASE("kernel: beyond the bound's laws the difference of two meshes holds", "[df][kernel][error]") {
  const Tally t = tally(false, 100, 8);
  CAPTURE(t.points, t.unanswered, t.broken, t.which);
  CHECK(t.points == 2000);
  CHECK(t.unanswered <= t.points / 20);
  CHECK(t.broken == 0);
}

TEST_CASE("kernel: LuGre agrees with quadrature and FFT, all harmonics", "[df][kernel]") {
  Random random(9);
  for (int i = 0; i < 40; ++i) {
    const Element element = i == 0 ? Element(lugre()) : random_lugre(random, i % 2 == 0);
    const DfPoint point{random.spread(1e-6, 1e-1), random.spread(0.1, 1000.0), 0.0};
    const double accuracy = random.spread(1e-9, 1e-4);
    const auto df = describing_function(element, point, asking(accuracy));
    const auto other = describing_function(element, point, with(DfMethod::quadrature, 1e-11));
    CAPTURE(point.amplitude, point.frequency, accuracy);
    REQUIRE(df.status == Status::converged);
    CHECK(df.error <= accuracy);
    CHECK(apart(df.gain, other.gain) <= df.error + other.error);
    CHECK(df.symmetric);
    CHECK(df.mean == 0.0);
    CHECK(df.dissipation == Approx(other.dissipation).epsilon(1e-3));
    for (std::size_t k = 0; k < 7; ++k)
      CHECK(std::abs(df.harmonics[k] - other.harmonics[k]) <= 20.0 * df.error * std::abs(df.harmonics[0]) + 1e-11);
    if (i % 10 != 0) continue;
    const auto samples = describing_function(element, point, with(DfMethod::fft, 1e-3));
    CHECK(apart(df.gain, samples.gain) <= df.error + samples.error);
  }
}

TEST_CASE("kernel: Dahl with exponent 1 has its closed form", "[df][kernel][claims]") {
  for (const double accuracy : {1e-4, 1e-6, 1e-8, 1e-10})
    for (const double A : {1e-12, 1e-7, 5e-6, 1e-5, 5e-5, 1e-3}) {
      CAPTURE(accuracy, A);
      const double a = A * 1e5;
      const double slope = a < 1e-3 ? a * a * (1.0 / 3.0 - 2.0 / 15.0 * a * a) : 1.0 - std::tanh(a) / a;
      const Complex expected(2.0 / A * std::cyl_bessel_i(1.0, a) / std::cosh(a), 4.0 / (pi * A) * slope);
      const auto df = describing_function(dahl(), {A, 3.0, 0.0}, asking(accuracy));
      CHECK(df.method == "kernel");
      CHECK(df.error <= accuracy);
      CHECK(apart(df.gain, expected) <= df.error + 1e-14);
    }
  // Below 1 the level is reached within a finite displacement, with a branch point there.
  CHECK_FALSE(DfKernel::of(dahl(0.5), asking(1e-6)));
  CHECK(describing_function(dahl(0.5), {1e-5, 1.0, 0.0}).method == "quadrature");
}

TEST_CASE("kernel: the order of the collocation is seen", "[df][kernel][order]") {
  const LuGre<double> law = lugre();
  for (const auto& [stages, wide] : {std::pair{4, 0.5}, {5, 0.6}, {6, 0.75}, {8, 1.2}}) {
    for (const DfPoint point : {DfPoint{1e-4, 30.0, 0.0}, DfPoint{1e-3, 3.0, 0.0}}) {
      CAPTURE(stages, point.amplitude);
      const Complex exact = state_harmonic(law, point, {8, 0.2, 0.02, 1e-7, 1e-13});
      // The caps shrink with the panels.
      const double coarse = apart(state_harmonic(law, point, {stages, wide, 0.5, 1e-4}), exact);
      const double fine = apart(state_harmonic(law, point, {stages, 0.5 * wide, 0.125, 1e-4}), exact);
      CAPTURE(coarse, fine);
      CHECK(std::log2(coarse / fine) > 2.0 * stages - 2.0);
    }
  }
}

TEST_CASE("kernel: instruction sets agree", "[df][kernel][isa]") {
  const auto points = grid(23, 17);
  LuGre<double> odd_curve = lugre();
  odd_curve.delta = 0.7;
  odd_curve.curve.index = 2;
  odd_curve.vd = 0.01;
  for (const Element& element : {Element(lugre()), Element(odd_curve), Element(dahl())})
    for (const double accuracy : {1e-4, 1e-6, 1e-9}) {
      const auto portable = describing_function_table(element, points, asking(accuracy));
      for (const Isa isa : all_isas()) {
        CAPTURE(to_string(isa), accuracy);
        if (!is_available(isa)) {
          CHECK_THROWS_AS(describing_function_table(element, points, asking(accuracy, isa)), std::invalid_argument);
          continue;
        }
        const auto table = describing_function_table(element, points, asking(accuracy, isa));
        double worst = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) worst = std::max(worst, apart(table[i].gain, portable[i].gain));
        CHECK(worst < 1e-12);
      }
    }
}

TEST_CASE("kernel: neither threads nor the other points change a number", "[df][kernel][threads]") {
  auto points = grid(41, 37);
  for (std::size_t i = 0; i < points.size(); i += 500) points[i].bias = 1e-4;  // by another method
  auto options = asking(1e-6, best_isa());
  const auto one = describing_function_table(lugre(), points, options);
  REQUIRE(one.size() == points.size());
  for (const int threads : {0, 2, 3}) {
    options.threads = threads;
    std::size_t told = 0;
    const auto more =
        describing_function_table(lugre(), points, options, {}, [&](std::size_t done) { told = std::max(told, done); });
    REQUIRE(more.size() == points.size());
    CHECK(told == points.size());
    bool same = true;
    for (std::size_t i = 0; i < points.size(); ++i)
      same = same && one[i].harmonics == more[i].harmonics && one[i].error == more[i].error &&
             one[i].method == more[i].method;
    CHECK(same);
  }
  options.threads = 1;
  for (const std::size_t i : {std::size_t{3}, std::size_t{700}, std::size_t{1400}})
    CHECK(describing_function(lugre(), points[i], options).gain == one[i].gain);
  options.threads = -1;
  CHECK_THROWS_AS(describing_function_table(lugre(), points, options), std::invalid_argument);
}

TEST_CASE("kernel: a stop keeps the points before it", "[df][kernel][threads]") {
  const auto points = grid(60, 60);
  for (const int threads : {1, 2}) {
    auto options = asking(1e-6, best_isa());
    options.threads = threads;
    int asked = 0;
    const auto part = describing_function_table(lugre(), points, options, [&] { return ++asked > 2000; });
    CHECK(part.size() > 500);
    CHECK(part.size() < points.size());
    for (const auto& df : part) CHECK(df.method == "kernel");
  }
}

TEST_CASE("kernel: extreme parameters", "[df][kernel][extreme]") {
  for (const double Fs : {1.0, 1.5})
    for (const double vs : {1e-9, 1e-3, 1e3})
      for (const double sigma0 : {1e-3, 1e5, 1e12})
        for (const double A : {1e-12, 1e-5, 1e3})
          for (const double w : {1e-6, 1.0, 1e6}) {
            LuGre<double> law = lugre();
            law.Fs = law.Fs_minus = Fs;
            law.vs = vs;
            law.sigma0 = sigma0;
            law.sigma1 = 0.0;
            CAPTURE(Fs, vs, sigma0, A, w);
            const auto df = describing_function(law, {A, w, 0.0}, asking(1e-6));
            REQUIRE(df.status == Status::converged);
            CHECK(df.error <= 1e-6);
            CHECK(std::isfinite(df.gain.real()));
            CHECK(df.gain.imag() >= 0.4 * w * (1.0 - 1e-12));
            // A spring of stiffness sigma0 while it holds, dry friction once it slides far.
            if (sigma0 * A < 1e-9 * Fs) CHECK(df.gain.real() == Approx(sigma0).epsilon(1e-6));
            const double part = (df.gain.imag() - 0.4 * w) * pi * A / 4.0;
            if (sigma0 * A > 1e6 * Fs && 0.4 * w * A < 1e3) CHECK(part >= 0.999 * law.Fc);
            if (sigma0 * A > 1e6 * Fs && 0.4 * w * A < 1e3) CHECK(part <= 1.001 * law.Fs);
          }
}

TEST_CASE("kernel: what it leaves to other methods", "[df][kernel]") {
  LuGre<double> uneven = lugre();
  uneven.Fc_minus = 0.9;
  CHECK_FALSE(DfKernel::of(uneven, asking(1e-6)));
  CHECK_FALSE(DfKernel::of(coulomb(1.0, 1.0), asking(1e-6)));
  CHECK_FALSE(DfKernel::of(lugre(), asking(1e-13)));
  CHECK_FALSE(DfKernel::of(lugre(), asking(1e-6, Isa::scalar, DfKernel::most_harmonics + 1)));
  CHECK(describing_function(lugre(), {1e-3, 1.0, 0.01}).method == "quadrature");
  CHECK(describing_function(lugre(), {1e-3, 1.0, 0.0}).method == "kernel");
  CHECK(describing_function(lugre(), {1e-3, 1.0, 0.0}, with(DfMethod::quadrature, 1e-6)).method == "quadrature");
}

TEST_CASE("a law that knows no rate is computed once an amplitude", "[df][rate]") {
  BoucWen<double> bouc_wen;
  bouc_wen.alpha = 0.1;
  bouc_wen.k = 1e5;
  bouc_wen.D = 1e-5;
  bouc_wen.beta = 0.7;
  bouc_wen.gamma = 0.3;
  bouc_wen.n = 2.0;
  Jenkins<double> jenkins;
  jenkins.k = 1e5;
  jenkins.Fc = 1.0;
  for (const Element& element : {Element(bouc_wen), Element(dahl(2.0)), Element(jenkins)}) {
    std::vector<DfPoint> points;
    for (const double A : {3e-6, 3e-5, 3e-4})
      for (const double w : {0.1, 30.0, 1e3}) points.push_back({A, w, 0.0});
    for (const int threads : {1, 3}) {
      auto options = asking(1e-8);
      options.threads = threads;
      const auto table = describing_function_table(element, points, options);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto alone = describing_function(element, points[i], with(DfMethod::quadrature, 1e-8));
        CAPTURE(points[i].amplitude, points[i].frequency);
        CHECK(apart(table[i].gain, alone.gain) <= table[i].error + alone.error);
        CHECK(table[i].gain == table[i - i % 3].gain);
        CHECK(table[i].dissipation == Approx(alone.dissipation).epsilon(1e-6).margin(1e-14));
      }
    }
  }
}

TEST_CASE("the linear form of a law is its own equations", "[laws][kernel]") {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const LuGre<double> law = random_lugre(random, false);
    const double v = (random.coin() ? 1.0 : -1.0) * random.spread(1e-9, 10.0),
                 z = random.uniform(-1.0, 1.0) * law.Fs / law.sigma0;
    const Input<double> in{0.0, v, 0.0};
    double dz[1];
    const double state[1] = {z};
    law.rate(in, {}, state, dz);
    const auto rate = law.linear_rate(in);
    const auto output = law.linear_output(in);
    const double size = std::abs(rate.source) + std::abs(rate.decay * z);
    CHECK(std::abs(rate.source - rate.decay * z - dz[0]) <= 1e-14 * size);
    CHECK(output.stiffness * z + output.damping * dz[0] + output.rest ==
          Approx(law.output(in, {}, state)).epsilon(1e-13));
    Dahl<double> simple = dahl();
    simple.rate(in, {}, state, dz);
    const auto linear = simple.linear_rate(in);
    CHECK(linear.source - linear.decay * z == Approx(dz[0]).epsilon(1e-12).margin(1e-14 * std::abs(v)));
  }
}
