#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/law_march.hpp"

// Requirements for every friction law: each test runs over the whole list of laws and the samples of each.
using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Displacement and speed over which the behaviour of a law changes.
template <class Law>
double length(const Law& law) {
  const double own = law.scales().displacement;
  return own < infinite ? own : 1e-4;
}
template <class Law>
double speed(const Law& law) {
  const double own = law.scales().velocity;
  return own < infinite ? own : 1e-3;
}

template <class Law>
MarchSteps steps_of(const Law& law, const Sample& sample) {
  return {0.05 * length(law), 0.2 * speed(law), 0.1 * sample.fastest};
}
template <class Law>
LawMarch<Law> march_of(const Law& law, const Sample& sample) {
  return LawMarch<Law>(law, steps_of(law, sample));
}

/// Strokes of all lengths and speeds on the scales of a law, some of which continue in the direction of the last one.
/// `after` is called at the end of each.
template <class Law>
void wander(LawMarch<Law>& march, const Law& scaled_as, const Sample& sample, unsigned seed, double sign,
            auto&& after) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  double direction = sign;
  for (int stroke = 0; stroke < 12; ++stroke) {
    const double way = length(scaled_as) * 0.05 * std::pow(600.0, u(random));
    const double v = speed(scaled_as) * 0.01 * std::pow(3000.0, u(random));
    const double longest = sample.slowest > 0.0 ? 10.0 * sample.slowest : infinite;
    if (u(random) < 0.75) direction = -direction;
    march.glide(march.x() + direction * way, std::min(way / v, longest));
    after();
  }
}

/// The same law for the mirrored motion: the levels of the two directions are exchanged.
template <class Law>
Law reflected(Law law) {
  if constexpr (requires { law.Fs_minus; }) {
    std::swap(law.Fs, law.Fs_minus);
    if constexpr (requires { law.Fc; }) std::swap(law.Fc, law.Fc_minus);
    if constexpr (requires { law.forces; }) {
      std::swap(law.velocities, law.velocities_minus);
      std::swap(law.forces, law.forces_minus);
    }
  }
  return law;
}

template <class Law>
double reflected_state(const Law& law, std::size_t i, double z) {
  return is_even_state(law, static_cast<int>(i)) ? z : -z;
}

template <class Law>
std::vector<double> sorted_guards(const Law& law, const Input<double>& in, Mode mode, const std::vector<double>& z) {
  std::vector<double> guards;
  if constexpr (HasModes<Law, double>) {
    guards.resize(static_cast<std::size_t>(law.guards(mode)));
    law.guard(in, mode, z, guards);
    std::ranges::sort(guards);
  }
  return guards;
}

/// Equations at one point and at the mirrored one.
template <class Law>
bool is_reflected(const Law& law, const Law& other, const Input<double>& in, Mode mode, const std::vector<double>& z) {
  const Input<double> back{-in.x, -in.v, -in.drive};
  const Mode mirrored = law.mirror(mode);
  std::vector<double> z_back(z.size()), dz(z.size()), dz_back(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) z_back[i] = reflected_state(law, i, z[i]);
  law.rate(in, mode, z, dz);
  other.rate(back, mirrored, z_back, dz_back);
  const double F = law.output(in, mode, z), F_back = other.output(back, mirrored, z_back);
  bool same = law.mirror(mirrored) == mode && std::abs(F + F_back) <= 1e-13 * (std::abs(F) + law.scales().output);
  for (std::size_t i = 0; i < z.size(); ++i)
    same = same && std::abs(dz_back[i] - reflected_state(law, i, dz[i])) <= 1e-13 * (std::abs(dz[i]) + std::abs(in.v));
  const auto g = sorted_guards(law, in, mode, z), g_back = sorted_guards(other, back, mirrored, z_back);
  same = same && g.size() == g_back.size();
  for (std::size_t i = 0; same && i < g.size(); ++i)
    same = std::abs(g[i] - g_back[i]) <= 1e-13 * (std::abs(g[i]) + 1e-3 * law.scales().output) || g[i] == g_back[i];
  return same;
}

/// Runs `check(law, sample)` on every sample of every law: of those defined under any prescribed motion, or of those
/// that need the applied force near rest.
void for_laws(auto&& check, bool with_band = false) {
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_some_samples<Kind>([&](const auto& law, const Sample& sample) {
      INFO(Kind<double>::kind << ", " << sample.name);
      if ((drive_band(law) > 0.0) == with_band) check(law, sample);
    });
  });
}

/// Modes that switches at these inputs can lead to.
template <class Law>
std::set<std::int64_t> reachable_modes(const Law& law, const std::vector<Input<double>>& inputs) {
  std::set<std::int64_t> modes;
  std::vector<double> z(static_cast<std::size_t>(law.states()));
  if constexpr (HasModes<Law, double>) {
    for (const auto& in : inputs) modes.insert(law.start(in, z).value);
    for (std::size_t known = 0; known < modes.size();) {
      known = modes.size();
      for (const auto value : std::set(modes))
        for (const auto& in : inputs)
          for (int k = 0; k < law.guards({value}); ++k) modes.insert(law.next(in, {value}, z, k).value);
    }
  }
  return modes;
}

}  // namespace

TEST_CASE("friction laws: every kind is listed once, with samples, one of which is odd") {
  std::set<std::string_view> kinds;
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    INFO(Kind<double>::kind);
    CHECK(kinds.insert(Kind<double>::kind).second);
    bool odd = false;
    for_samples<Kind>([&](const auto& law, const Sample&) { odd = odd || law.odd(); });
    CHECK(odd);
  });
  CHECK_THROWS_WITH(made<Coulomb<double>>({{"Fc", 1.0}, {"mu", 1.0}}), Catch::Contains("has no key mu"));
  CHECK_THROWS_WITH(made<Coulomb<double>>({{"Fc", 1.0}, {"Fs", 0.5}}), Catch::Contains("at least Fc"));
  CHECK_THROWS_WITH(made<Dahl<double>>({{"Fc", 1.0}}), Catch::Contains("needs sigma0"));
}

TEST_CASE("friction laws: the parameter table carries every value to a copy") {
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      INFO(Kind<double>::kind << ", " << sample.name);
      const Kind<double> copy = recast<Kind, double>(law);
      for (const auto& parameter : Kind<double>::parameters())
        std::visit([&](auto member) { CHECK((copy.*member == law.*member)); }, parameter.member);
      CHECK(copy.states() == law.states());
      CHECK(copy.odd() == law.odd());
    });
  });
}

TEST_CASE("friction laws: reflecting the motion reflects equations, guards and the whole way") {
  for_laws([](const auto& law, const Sample& sample) {
    const auto other = reflected(law);
    LawMarch forth(law, steps_of(law, sample)), back(other, steps_of(law, sample));
    long points = 0, wrong = 0;
    forth.watch = [&](const Input<double>& in, Mode mode, const std::vector<double>& z) {
      ++points;
      if (!is_reflected(law, other, in, mode, z)) ++wrong;
    };
    std::vector<double> forces;
    std::vector<std::vector<double>> states;
    wander(forth, law, sample, 11, 1.0, [&] {
      forces.push_back(forth.force());
      states.push_back(forth.z());
    });
    CHECK(points > 200);
    CHECK(wrong == 0);
    std::size_t k = 0;
    double gap = 0.0, state_gap = 0.0;
    wander(back, law, sample, 11, -1.0, [&] {
      gap = std::max(gap, std::abs(back.force() + forces[k]));
      for (std::size_t i = 0; i < back.z().size(); ++i)
        state_gap = std::max(state_gap, std::abs(back.z()[i] - reflected_state(law, i, states[k][i])) /
                                            law.state_scale(static_cast<int>(i)));
      ++k;
    });
    CHECK(gap <= 1e-9 * law.scales().output);
    CHECK(state_gap <= 1e-9);
    CHECK(forth.events() == back.events());
  });
}

TEST_CASE("friction laws that need the applied force: reflection, bounds and energy in every mode") {
  const auto check = [](const auto& law, const Sample& sample) {
    REQUIRE(law.states() == 0);
    const auto other = reflected(law);
    const double band = drive_band(law);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    std::vector<Input<double>> inputs;
    for (int k = 0; k < 400; ++k)
      inputs.push_back({0.0, (k % 2 == 0 ? 3.0 * band : 1e-2) * u(random), 2.0 * sample.level * u(random)});
    const auto modes = reachable_modes(law, inputs);
    CHECK(modes.size() >= 3);
    long inside = 0, wrong = 0;
    for (const auto value : modes) {
      for (const auto& in : inputs) {
        if (!is_reflected(law, other, in, {value}, {})) ++wrong;
        const auto guards = sorted_guards(law, in, {value}, {});
        if (!guards.empty() && guards.front() < 0.0) continue;
        ++inside;
        const double F = law.output(in, {value}, {}), bound = sample.level + sample.per_speed * std::abs(in.v);
        if (std::abs(F) > bound * (1.0 + 1e-12)) ++wrong;
        bool held = false;
        if constexpr (requires { law.held(Mode{}); }) held = law.held({value}) != Held::nothing;
        if (sample.passive && !held && F * in.v < 0.0) ++wrong;
      }
    }
    CHECK(inside > 100);
    CHECK(wrong == 0);
  };
  for_laws(check, true);
}

TEST_CASE("friction laws: the force is bounded as claimed, and finite states stay so") {
  for_laws([](const auto& law, const Sample& sample) {
    auto march = march_of(law, sample);
    double excess = -infinite;
    bool finite = true;
    march.watch = [&](const Input<double>& in, Mode mode, const std::vector<double>& z) {
      const double bound = sample.level + sample.per_speed * std::abs(in.v) + sample.per_way * std::abs(in.x);
      excess = std::max(excess, std::abs(law.output(in, mode, z)) / bound - 1.0);
      for (const double value : z) finite = finite && std::isfinite(value);
    };
    for (unsigned seed = 1; seed <= 2; ++seed) wander(march, law, sample, seed, 1.0, [] {});
    CHECK(finite);
    CHECK(excess <= 1e-6);
  });
}

TEST_CASE("friction laws: no work can be had from an unloaded law that is passive") {
  for_laws([](const auto& law, const Sample& sample) {
    if (!sample.passive) return;
    for (unsigned seed = 21; seed <= 22; ++seed) {
      auto march = march_of(law, sample);
      wander(march, law, sample, seed, 1.0, [] {});
      CHECK(march.least_work() >= -1e-6 * sample.level * length(law));
      CHECK(march.work() > 0.0);
    }
  });
}

TEST_CASE("friction laws: at constant speed the force becomes that of the Stribeck curve") {
  const auto check = [](const auto& law, const Sample& sample) {
    if (!sample.is_steady) return;
    for (const double v : {0.3, 1.0, 7.0, -0.3, -2.0}) {
      auto march = march_of(law, sample);
      const double velocity = v * speed(law) + (v < 0.0 ? -1.0 : 1.0) * drive_band(law),
                   way = sample.settles * length(law);
      const double T = std::max(way / std::abs(velocity), 40.0 * sample.slowest);
      march.slide(velocity * T, T);
      double expected = sample.steady;
      using Law = std::decay_t<decltype(law)>;
      if constexpr (std::is_base_of_v<StribeckCurve<double>, Law>) {
        expected = static_cast<const StribeckCurve<double>&>(law).level(velocity);
      } else if constexpr (requires { law.level(velocity); }) {
        expected = law.level(velocity);
      }
      REQUIRE(expected < Sample::nothing);
      if (v < 0.0) expected = -expected;
      if constexpr (requires { law.sigma2; }) expected += law.sigma2 * velocity;
      INFO("velocity " << velocity);
      CHECK(march.force() == Approx(expected).epsilon(1e-8));
    }
  };
  for_laws(check);
  for_laws(check, true);
}

TEST_CASE("friction laws: return points are remembered where the memory is non-local, and not where it is local") {
  for_laws([](const auto& law, const Sample& sample) {
    const Features features = std::decay_t<decltype(law)>::features;
    if (features.memory == Memory::non_local && !features.drifts) CHECK(sample.closes < Sample::nothing);
    if (features.memory == Memory::none) return;
    if (features.memory == Memory::local && !features.drifts && sample.closes == Sample::nothing) return;
    LawMarch march(law, {0.05 * length(law), infinite, sample.fastest});
    const double L = length(law), v = 1e-2 * speed(law);
    const auto to = [&](double x) {
      march.slide(x * L, std::abs(x * L - march.x()) / v);
      return march.force();
    };
    // A virgin loading and, in it, a loop in a loop in a loop; then the same again, wider.
    double gap = 0.0;
    for (const double w : {0.3, 1.0}) {
      const double outer = to(3.0 * w), low = to(1.2 * w), high = to(2.4 * w), inner = to(1.8 * w);
      gap = std::max({gap, std::abs(to(2.4 * w) - high), std::abs(to(1.8 * w) - inner), std::abs(to(2.4 * w) - high),
                      std::abs(to(1.2 * w) - low), std::abs(to(3.0 * w) - outer)});
    }
    if (sample.closes < Sample::nothing) {
      CHECK(gap <= sample.closes * sample.level);
    } else if (features.memory == Memory::local) {
      CHECK(gap >= 1e-2 * sample.level);
    }
  });
}

TEST_CASE("friction laws: a rate-independent law depends on the way alone, not on its timing") {
  for_laws([](const auto& law, const Sample& sample) {
    if (!sample.rate_independent) return;
    auto slow = march_of(law, sample), fast = march_of(law, sample);
    const double L = length(law);
    double gap = 0.0;
    for (const double x : {0.4, -0.3, 2.0, 1.1, 1.5, -4.0, 0.2}) {
      slow.glide(x * L, 1e4);
      fast.slide(0.5 * (fast.x() + x * L), 1e-5);
      fast.slide(x * L, 1e-3);
      gap = std::max(gap, std::abs(slow.force() - fast.force()));
    }
    CHECK(gap <= 1e-5 * sample.level);
  });
}
