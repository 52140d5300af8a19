#include "limcycle/analysis/orbit/branch/continuation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/orbit/branch/branch_end.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Branch followed(const LoopFamily& family, double start, double from, double to, double accuracy = 1e-8) {
  const auto loop = family(start);
  REQUIRE(loop);
  SettleOptions settling;
  settling.amplitude_floor = 1e-7;
  const auto settled = settle(*loop, displaced(*loop, 1.0), settling);
  INFO(settled.why);
  REQUIRE(settled.shot);
  ContinuationOptions options;
  options.from = from;
  options.to = to;
  options.accuracy = accuracy;
  return continue_cycle(family, settled.shot->cycle, start, options);
}

const BranchEvent& only(const Branch& branch, BranchEvent::Type type) {
  const auto is = [type](const BranchEvent& event) { return event.type == type; };
  REQUIRE(std::ranges::count_if(branch.events, is) == 1);
  return *std::ranges::find_if(branch.events, is);
}

const BranchEvent& end_towards(const Branch& branch, bool front) {
  const BranchEvent& event = front ? branch.events.front() : branch.events.back();
  REQUIRE(event.type == BranchEvent::Type::end);
  return event;
}

std::optional<Loop> van_der_pol_of(double mu) { return van_der_pol(mu); }

std::optional<Loop> dead_zone_relay(double d) { return forward(relay(1.0, 0.0, d), {1.0}, {1.0, 3.0, 3.0, 1.0}); }

/// Symmetric oscillation of a relay with dead zone d before 1/(s+1)^3, half period h: pulses of +-1 of width a, from
/// y = -d falling to y = -d rising. Both switching conditions (as claim B1, with two switches in a half period) give d.
struct RelayPulse {
  double first, second;  ///< d by the condition at the rising and at the falling edge of the pulse
  RelayPulse(double h, double a) {
    Eigen::Matrix3d A;
    A << 0, 1, 0, 0, 0, 1, -1, -3, -3;
    const Eigen::Vector3d B(0, 0, 1);
    const Eigen::Matrix3d N = A + Eigen::Matrix3d::Identity();  // N^3 = 0
    const auto flow = [&](double t) -> Eigen::Matrix3d {
      return std::exp(-t) * (Eigen::Matrix3d::Identity() + t * N + 0.5 * t * t * N * N);
    };
    const auto forced = [&](double t) -> Eigen::Vector3d {
      return A.inverse() * (flow(t) - Eigen::Matrix3d::Identity()) * B;
    };
    const Eigen::Vector3d start = -(Eigen::Matrix3d::Identity() + flow(h)).inverse() * flow(h - a) * forced(a);
    first = -start(0);
    second = -(flow(a) * start + forced(a))(0);
  }
};

struct RelayCycle {
  double half_period, dead_zone;
};

/// The oscillation with pulses of width a: the half period that meets both conditions, by a scan and bisection.
RelayCycle with_pulse(double a) {
  const auto excess = [a](double h) {
    const RelayPulse pulse(h, a);
    return pulse.first - pulse.second;
  };
  double low = std::max(a, 1.5) + 1e-9, high = low + 0.01;
  while (high < 4.0 && excess(low) * excess(high) > 0.0) {
    low = high;
    high += 0.01;
  }
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (low + high);
    (excess(low) * excess(mid) <= 0.0 ? high : low) = mid;
  }
  return {low, RelayPulse(low, a).first};
}

}  // namespace

TEST_CASE("continuation: van der Pol from mu = 0.1 to 5 against the table of claim B3") {
  const Branch branch = followed(van_der_pol_of, 1.0, 0.1, 5.0);
  REQUIRE(branch.status == Status::converged);
  CHECK(branch.points.front().parameter == 0.1);
  CHECK(branch.points.front().cycle.period == Approx(6.28711127).epsilon(2e-9));
  CHECK(branch.points.front().cycle.amplitude == Approx(2.00010398).epsilon(5e-9));
  CHECK(branch.points.front().cycle.multipliers[0].real() == Approx(0.5330693).epsilon(1e-6));
  CHECK(branch.points.back().parameter == 5.0);
  CHECK(branch.points.back().cycle.period == Approx(11.61223066).epsilon(2e-9));
  CHECK(branch.points.back().cycle.amplitude == Approx(2.02150806).epsilon(5e-9));
  REQUIRE(branch.events.size() == 2);
  for (const auto& event : branch.events) CHECK(event.why == "the end of the range is reached");
  for (std::size_t i = 0; i + 1 < branch.points.size(); ++i) {
    CHECK(branch.points[i].parameter < branch.points[i + 1].parameter);
    CHECK(branch.points[i].cycle.stable == true);
  }
}

TEST_CASE("continuation: every point of a branch is a cycle of its own loop, with the error it states") {
  const Branch branch = followed(van_der_pol_of, 1.0, 0.5, 2.0, 1e-6);
  for (std::size_t i = 0; i < branch.points.size(); i += 5) {
    const auto& [mu, cycle] = branch.points[i];
    SettleOptions tight;
    const auto settled = settle(*van_der_pol_of(mu), displaced(*van_der_pol_of(mu), 1.0), tight);
    REQUIRE(settled.shot);
    CHECK(std::abs(cycle.period / settled.shot->cycle.period - 1.0) <= cycle.error + 1e-11);
    CHECK(std::abs(cycle.amplitude / settled.shot->cycle.amplitude - 1.0) <= cycle.error + 1e-8);
    CHECK(cycle.error < 1e-6);
  }
}

TEST_CASE("continuation: a relay with dead zone loses its oscillation in a fold, where the closed form says") {
  const Branch branch = followed(dead_zone_relay, 0.05, 0.01, 0.2);
  REQUIRE(branch.status == Status::converged);
  const BranchEvent& fold = only(branch, BranchEvent::Type::fold);
  double low = 0.3, high = 1.7;  // the largest dead zone, by golden section over the width of the pulse
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  while (high - low > 1e-7) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (with_pulse(a).dead_zone > with_pulse(b).dead_zone)
      high = b;
    else
      low = a;
  }
  const RelayCycle exact = with_pulse(0.5 * (low + high));
  CHECK(fold.parameter == Approx(exact.dead_zone).epsilon(1e-9));
  CHECK(std::abs(fold.parameter / exact.dead_zone - 1.0) <= 1e-12 + fold.error);
  CHECK(fold.error < 1e-8);
  CHECK(0.5 * fold.period == Approx(exact.half_period).epsilon(1e-6));
  // Both sides of the fold: stable before it, unstable after it, down to the same end of the range.
  CHECK(branch.points.front().cycle.stable == true);
  CHECK(branch.points.back().cycle.stable == false);
  CHECK(branch.points.front().parameter == 0.01);
  CHECK(branch.points.back().parameter == 0.01);
  // The unstable cycle of the same dead zone has the narrow pulse.
  for (low = 0.01, high = 0.5; high - low > 1e-13;)
    (with_pulse(0.5 * (low + high)).dead_zone < 0.01 ? low : high) = 0.5 * (low + high);
  CHECK(0.5 * branch.points.back().cycle.period == Approx(with_pulse(low).half_period).epsilon(1e-9));
  CHECK_FALSE(branch.points[fold.point].cycle.stable);
}

TEST_CASE("continuation: the cycle of Coulomb friction with stiction shrinks with Fs - Fc and is gone at Fs = Fc") {
  const LoopFamily family = [](double Fs) -> std::optional<Loop> {
    if (Fs < 1.0) return std::nullopt;
    return servo(coulomb(Fs, 1.0, 0.4));
  };
  const Branch branch = followed(family, 1.5, 1.0, 2.0);
  REQUIRE(branch.status == Status::converged);
  for (const auto& [Fs, cycle] : branch.points) {
    if (Fs - 1.0 > 1e-3) CHECK(cycle.amplitude / (Fs - 1.0) == Approx(0.06565304 / 0.5).epsilon(1e-6));
    CHECK(cycle.stable == true);
    CHECK(cycle.multipliers[0].real() == Approx(0.0975085 * 0.0975085).epsilon(Fs - 1.0 > 1e-3 ? 1e-4 : 0.1));
  }
  const BranchEvent& end = end_towards(branch, true);
  CHECK(end.parameter == Approx(1.0).epsilon(1e-9));
  CHECK(end.amplitude < 1e-4);
  CHECK_THAT(end.why, Catch::Matchers::Contains("amplitude falls to zero"));
  CHECK_THAT(end.why, Catch::Matchers::Contains("period grows without bound"));
}

TEST_CASE("continuation: hunting of the LuGre servo ends in a fold as kd grows") {
  const auto fold = [](double vs, double start, double accuracy) {
    const LoopFamily family = [vs](double kd) -> std::optional<Loop> {
      auto law = lugre();
      law.vs = vs;
      auto parts = servo_parts(law);
      parts.controller = pid(3.0, 4.0, kd);
      return build_loop(parts);
    };
    const auto loop = family(start);
    SettleOptions settling;
    settling.amplitude_floor = 1e-7;
    const auto settled = settle(*loop, displaced(*loop, 1.0), settling);
    REQUIRE(settled.shot);
    ContinuationOptions options;
    options.from = start;
    options.to = 1.3 * start;
    options.downwards = false;
    options.until_event = true;
    options.accuracy = accuracy;
    return only(continue_cycle(family, settled.shot->cycle, start, options), BranchEvent::Type::fold);
  };
  // The references were found with the derivative of the map by differences, other sections and other starts.
  const BranchEvent slow = fold(0.001, 350.0, 1e-8);
  CHECK(slow.parameter == Approx(393.229594).epsilon(1e-7));
  CHECK(slow.error < 1e-7);
  // The same fold at other accuracies, from other starts and so on other sections.
  const BranchEvent normal = fold(0.01, 32.0, 1e-8);
  CHECK(normal.parameter == Approx(36.01377176).epsilon(1e-7));
  CHECK(normal.error < 1e-7);
  for (const auto& [start, accuracy] : some_of(std::vector<std::pair<double, double>>{{33.0, 1e-6}, {34.0, 1e-9}})) {
    const BranchEvent other = fold(0.01, start, accuracy);
    CHECK(std::abs(other.parameter / normal.parameter - 1.0) <= 3.0 * (other.error + normal.error) + 1e-10);
  }
}

TEST_CASE(
    "continuation: with more integral gain the hunting cycle folds and goes to infinity where the linear loop "
    "becomes unstable") {
  // m s^3 + (kd + sigma2) s^2 + kp s + ki: unstable from ki = (kd + sigma2) kp / m = 19.2.
  const LoopFamily family = [](double ki) -> std::optional<Loop> {
    auto parts = servo_parts(lugre());
    parts.controller = pid(3.0, ki, 6.0);
    return build_loop(parts);
  };
  const Branch branch = followed(family, 10.0, 8.0, 40.0, 1e-7);
  CHECK(branch.status == Status::converged);
  // Sufficiently small steps also find a narrow pair of folds at 21.0969 and 21.0480, where sticking at the turning
  // point ends.
  CHECK(std::ranges::any_of(branch.events, [](const BranchEvent& event) {
    return event.type == BranchEvent::Type::fold && event.parameter == Approx(21.190874).epsilon(1e-6);
  }));
  const BranchEvent& end = end_towards(branch, false);
  CHECK(end.parameter == Approx(19.2).epsilon(1e-6));
  CHECK_THAT(end.why, Catch::Matchers::Contains("amplitude grows without bound"));
}

TEST_CASE("continuation: stick-slip on a damped belt ends where the mass no longer catches up with the belt") {
  const LoopFamily family = [](double speed) -> std::optional<Loop> {
    LoopParts parts;
    parts.plant = Belt{1.0, 2.0, 0.1, speed};
    parts.friction = coulomb(1.5, 1.0);
    return build_loop(parts);
  };
  const Branch branch = followed(family, 0.1, 0.01, 10.0);
  CHECK(branch.status == Status::converged);
  const BranchEvent& end = end_towards(branch, false);
  // In closed form: slip from y = (Fs - c V)/k, v = V about the point (Fc, 0)/k; lost where its largest velocity is V.
  const double k = 2.0, c = 0.1, decay = 0.5 * c, w = std::sqrt(k - decay * decay);
  const auto peak = [&](double V) {
    const double x = (1.5 - c * V) / k - 1.0 / k;
    // x(t) = e^{-dt} (x cos wt + q sin wt), q = (V + d x)/w; v(t) = e^{-dt} (V cos wt - r sin wt), r = (x k + d V)/w.
    const double r = (x * k + decay * V) / w;
    double best = -1.0;
    for (double t = 0.5 * std::acos(-1.0) / w; t < 2.2 * std::acos(-1.0) / w; t += 1e-5)
      best = std::max(best, std::exp(-decay * t) * (V * std::cos(w * t) - r * std::sin(w * t)));
    return best;
  };
  double low = 0.3, high = 0.7;
  for (int i = 0; i < 40; ++i) (peak(0.5 * (low + high)) > 0.5 * (low + high) ? low : high) = 0.5 * (low + high);
  CHECK(end.parameter == Approx(low).epsilon(1e-5));
  INFO(end.why);
  CHECK((end.why.find("no longer switches") != std::string::npos ||
         end.why.find("order of switches") != std::string::npos));
}

TEST_CASE("continuation: where a falling quantity comes to zero") {
  const auto straight = vanishing({{1.1, 0.2}, {1.2, 0.4}, {1.4, 0.8}});
  REQUIRE(straight);
  CHECK(straight->parameter == Approx(1.0));
  const auto root = vanishing({{1.01, 0.1}, {1.04, 0.2}, {1.16, 0.4}});  // Hopf: sqrt(p - 1)
  REQUIRE(root);
  CHECK(root->parameter == Approx(1.0));
  CHECK_FALSE(vanishing({{1.0, 0.5}, {1.1, 0.4}, {1.2, 0.3}}));
  CHECK_FALSE(vanishing({{1.0, 0.1}, {1.1, 0.2}}));
}

TEST_CASE("continuation: where a period grows without bound, like a logarithm, a pole or a root") {
  const auto limit_of = [](auto place) {
    std::vector<std::pair<double, double>> last;
    for (const double period : {12.0, 9.0, 6.5, 5.0}) last.emplace_back(place(period), 1.0 / period);
    return slowing(last);
  };
  const auto logarithm = limit_of([](double T) { return 2.0 - 3.0 * std::exp(-0.7 * T); });
  REQUIRE(logarithm);
  CHECK(logarithm->parameter == Approx(2.0).epsilon(1e-9));
  const auto pole = limit_of([](double T) { return -1.0 + 2.0 / T; });
  REQUIRE(pole);
  CHECK(pole->parameter == Approx(-1.0).epsilon(1e-9));
  const auto root = limit_of([](double T) { return 5.0 + 2.0 / (T * T); });
  REQUIRE(root);
  CHECK(root->parameter == Approx(5.0).epsilon(1e-9));
  CHECK_FALSE(slowing({{1.0, 1.0 / 3.0}, {1.1, 1.0 / 4.0}, {1.2, 1.0 / 5.0}, {1.3, 1.0 / 6.0}}));
}

TEST_CASE("continuation: what is not a cycle, not a range or not to be finished is said") {
  const LoopFamily family = dead_zone_relay;
  Cycle nothing;
  nothing.period = 1.0;
  nothing.start = displaced(*family(0.05), 1e-3);
  ContinuationOptions options;
  options.from = 0.01;
  options.to = 0.2;
  const Branch none = continue_cycle(family, nothing, 0.05, options);
  CHECK(none.points.empty());
  CHECK(none.status != Status::converged);
  CHECK_FALSE(none.why.empty());
  CHECK_THROWS_AS(continue_cycle(family, nothing, 0.5, options), std::invalid_argument);
  options.to = options.from;
  CHECK_THROWS_AS(continue_cycle(family, nothing, 0.01, options), std::invalid_argument);

  long asked = 0;
  options.to = 0.2;
  options.stop = [&asked] { return ++asked > 20000; };
  SettleOptions settling;
  settling.amplitude_floor = 1e-7;
  const auto settled = settle(*family(0.05), displaced(*family(0.05), 1.0), settling);
  REQUIRE(settled.shot);
  const Branch some = continue_cycle(family, settled.shot->cycle, 0.05, options);
  CHECK(some.status == Status::interrupted);
  CHECK(some.points.size() > 1);
}
