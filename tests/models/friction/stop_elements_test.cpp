// Jenkins and Maxwell-slip along paths, without any solver: the only arithmetic is that of the law.
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/models/friction/sliders/maxwell_slip.hpp"

using namespace limcycle;

namespace {

MaxwellSlip<double> law_of(std::vector<double> k, std::vector<double> W) {
  MaxwellSlip<double> law;
  law.k = std::move(k);
  law.W = std::move(W);
  return law;
}

/// Moves a law along a path at unit speed from switch to switch.
class Path {
 public:
  explicit Path(const MaxwellSlip<double>& law) : law_(law), s(law.k.size(), 0.0), mode(law.start({}, s)) {}

  double move(double dx) {
    const double direction = dx < 0.0 ? -1.0 : 1.0;
    const Input<double> in{0.0, direction, direction * infinite};
    std::vector<double> g(static_cast<std::size_t>(law_.guards(mode))), ds(s.size());
    const std::size_t reversal = g.size() - 1;
    double left = std::abs(dx);
    for (int events = 0; events < 100; ++events) {
      law_.guard(in, mode, s, g);
      if (g[reversal] < 0.0) {
        mode = law_.next(in, mode, s, static_cast<int>(reversal));
        continue;
      }
      law_.rate(in, mode, s, ds);
      std::size_t first = reversal;
      double distance = left;
      for (std::size_t i = 0; i < s.size(); ++i) {
        const std::size_t guard = 2 * i + (direction < 0.0 ? 1 : 0);
        if (ds[i] != 0.0 && g[guard] / law_.k[i] < distance) distance = g[first = guard] / law_.k[i];
      }
      for (std::size_t i = 0; i < s.size(); ++i) s[i] += ds[i] * distance;
      left -= distance;
      if (first == reversal) break;
      mode = law_.next(in, mode, s, static_cast<int>(first));
    }
    return force();
  }
  double force() const { return law_.output({}, mode, s); }

 private:
  const MaxwellSlip<double>& law_;

 public:
  std::vector<double> s;
  Mode mode;
};

double virgin(const MaxwellSlip<double>& law, double x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < law.k.size(); ++i) sum += std::min(law.k[i] * x, law.W[i]);
  return sum;
}

}  // namespace

TEST_CASE("maxwell-slip: virgin curve and Masing's rule", "[friction][claims]") {
  const auto law = law_of({1000.0, 500.0, 700.0, 100.0}, {0.1, 0.2, 0.5, 0.3});
  for (const double turn : {5e-5, 3e-4, 1.3e-3}) {
    for (const double back : {1e-5, 2e-4, 5e-4, 2.0 * turn}) {
      Path path(law);
      const double top = path.move(turn);
      CHECK(top == Approx(virgin(law, turn)).epsilon(1e-14));
      const double dx = std::min(back, 2.0 * turn);
      CHECK(path.move(-dx) == Approx(top - 2.0 * virgin(law, 0.5 * dx)).epsilon(1e-13).margin(1e-15));
    }
  }
}

TEST_CASE("maxwell-slip: a closed minor loop is wiped out to rounding", "[friction][claims]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  MaxwellSlip<double> law;
  for (int i = 0; i < most_sliders; ++i) {
    law.k.push_back(500.0 + 2000.0 * u(random));
    law.W.push_back(0.01 + 0.1 * u(random));
  }
  REQUIRE_FALSE(law.validate());
  for (int k = 0; k < 50; ++k) {
    const double a = 2e-4 * u(random), b = a * u(random), c = b * u(random), d = c * u(random);
    Path looped(law), straight(law);
    looped.move(a);
    const double before = looped.move(-b);
    looped.move(c);
    const double inner = looped.move(-d);  // a loop within the loop
    looped.move(0.5 * d);
    CHECK(looped.move(-0.5 * d) == Approx(inner).epsilon(1e-13).margin(1e-14));
    looped.move(-(c - d));
    CHECK(looped.force() == Approx(before).epsilon(1e-13).margin(1e-14));
    looped.move(-1e-5);
    straight.move(a);
    straight.move(-b - 1e-5);
    for (std::size_t i = 0; i < law.k.size(); ++i)
      CHECK(std::abs(looped.s[i] - straight.s[i]) < 1e-14 * law.state_scale(static_cast<int>(i)) + 1e-18);
  }
}

TEST_CASE("maxwell-slip: a long slide loses nothing", "[friction]") {
  const auto law = law_of({1e5, 3e4}, {0.7, 0.1});
  Path path(law);
  for (int i = 0; i < 1000; ++i) path.move(1.0);
  CHECK(path.force() == Approx(0.8).epsilon(1e-15));
  CHECK(path.move(-1e-6) == Approx(0.8 - 1e-6 * 1.3e5).epsilon(1e-14));
  CHECK(path.move(-1.0) == Approx(-0.8).epsilon(1e-15));
}

TEST_CASE("maxwell-slip: dissipation of a cycle is 4 W (A - h), element by element", "[friction]") {
  const auto law = law_of({1000.0, 400.0}, {1.5, 2.0});
  const double A = 4e-3;
  double work = 0.0;
  Path path(law);
  path.move(A);
  const int steps = 4000;  // the force is piecewise linear: trapezia are exact except at the kinks
  for (int half = 0; half < 2; ++half)
    for (int j = 0; j < steps; ++j) {
      const double dx = (half == 0 ? -2.0 : 2.0) * A / steps, before = path.force();
      work += 0.5 * dx * (before + path.move(dx));
    }
  CHECK(work == Approx(4.0 * 1.5 * (A - 1.5e-3)).epsilon(1e-6));  // the other sticks: 2 W/k > 2 A
}

TEST_CASE("stop elements are odd, modes included", "[friction]") {
  const auto law = law_of({1000.0, 500.0, 700.0}, {0.1, 0.2, 0.5});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const Slider way = u(random) < 0.0 ? Slider::slips_backward : Slider::slips_forward;
    Mode mode;
    std::vector<double> s(3), minus(3), ds(3), minus_ds(3), g(7), minus_g(7);
    for (int i = 0; i < 3; ++i) {
      if (u(random) < 0.0) mode = with_slider(mode, i, way);
      s[static_cast<std::size_t>(i)] = u(random) * law.state_scale(i);
    }
    std::ranges::transform(s, minus.begin(), [](double z) { return -z; });
    const Input<double> in{0.0, u(random), 0.0}, mirrored{0.0, -in.v, 0.0};
    const Mode turned = law.mirror(mode);
    CHECK(law.mirror(turned) == mode);
    CHECK(law.output(in, mode, s) == -law.output(mirrored, turned, minus));
    law.rate(in, mode, s, ds);
    law.rate(mirrored, turned, minus, minus_ds);
    law.guard(in, mode, s, g);
    law.guard(mirrored, turned, minus, minus_g);
    CHECK(g.back() == minus_g.back());
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(ds[i] == -minus_ds[i]);
      CHECK(g[2 * i] == minus_g[2 * i + 1]);
      CHECK(law.mirror(law.next(in, mode, s, 6)) == law.next(mirrored, turned, minus, 6));
    }
  }
}

TEST_CASE("jenkins: slips at Fc, turns back elastically, and is the one-element maxwell-slip", "[friction]") {
  const Jenkins<double> law{1000.0, 1.5};
  std::vector<double> s{1.4999e-3}, g(2);
  const Input<double> forward{0.0, 0.1, infinite}, backward{0.0, -0.1, -infinite};
  law.guard(forward, {}, s, g);
  CHECK(g[0] == Approx(1e-4));
  const Mode slipping = law.next(forward, {}, s, 0);
  CHECK(law.output(forward, slipping, s) == 1.5);
  CHECK(law.guards(slipping) == 1);
  double ds[1];
  law.rate(forward, slipping, s, ds);
  CHECK(ds[0] == 0.0);
  law.guard(backward, slipping, s, g);
  CHECK(g[0] < 0.0);
  const Mode held = law.next(backward, slipping, s, 0);
  CHECK(held == Mode{0});
  law.guard(backward, held, s, g);
  CHECK(g[0] == 0.0);  // on its limit, not beyond
  law.rate(backward, held, s, ds);
  CHECK(ds[0] == -0.1);
  CHECK(stop_gain(1000.0, 1.5, 4e-3) == *law.exact_describing_function(4e-3, 1.0, 0.0));
}

TEST_CASE("claim A8: its digits survive amplitudes of many yields, and its limits hold", "[friction][claims]") {
  CHECK(stop_gain(1000.0, 1.5, 1.5e-3) == 1000.0);
  CHECK(std::abs(stop_gain(1000.0, 1.5, 1.5e-3 * (1.0 + 1e-9)) - 1000.0) < 1e-5);
  // Far beyond: Re N = (8/(3 pi)) k 2 (h/A)^(3/2) (1 - 3 h/(10 A) - ...), Im N that of Coulomb friction.
  for (const double ratio : {1e-4, 1e-8, 1e-12}) {
    const auto N = stop_gain(1.0, ratio, 1.0);
    CHECK(N.real() == Approx(16.0 / (3.0 * std::numbers::pi) * std::pow(ratio, 1.5) * (1.0 - 0.3 * ratio))
                          .epsilon(1e-13 + ratio * ratio));
    CHECK(N.imag() == Approx(4.0 * ratio / std::numbers::pi * (1.0 - ratio)).epsilon(1e-15));
  }
  // Both forms of the real part agree at the transition between them (h/A = sin^2(1/4)).
  const double ratio = std::pow(std::sin(0.25), 2);
  CHECK(stop_gain(1.0, ratio * (1.0 - 1e-12), 1.0).real() ==
        Approx(stop_gain(1.0, ratio * (1.0 + 1e-12), 1.0).real()).epsilon(1e-11));
}

TEST_CASE("maxwell-slip: broken lists are named", "[friction]") {
  CHECK(law_of({}, {}).validate()->rule == "must have at least one element");
  CHECK(law_of({1.0, 2.0}, {1.0}).validate()->key == "W");
  CHECK(law_of({1.0, 2.0}, {1.0}).validate()->rule == "must have as many entries as k: 2, has 1");
  const std::vector<double> many(32, 1.0);
  CHECK(law_of(many, many).validate()->rule == "must have at most 31 elements, has 32");
  CHECK(MaxwellSlip<double>{}.states() == 0);
}
