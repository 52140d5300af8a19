#include "limcycle/analysis/study/claims/limit_cycles/cycle_claims.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "limcycle/analysis/random_bits.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"

namespace limcycle::cycle_claims {
namespace {

template <class Law>
Law with_levels(double Fs, double Fc) {
  Law law;
  law.Fs = law.Fs_minus = Fs;
  law.Fc = law.Fc_minus = Fc;
  return law;
}

}  // namespace

void at_random(ClaimChecks& checks, const ClaimOptions& options, std::string_view id, int most,
               const std::function<void(RandomPoints&)>& test) {
  checks.random(true);
  RandomPoints draw(options.seed ^ fnv1a(id));
  for (int i = 0; i < std::min(options.random_points, most); ++i) {
    if (options.stop && options.stop()) {
      checks.stop(Status::interrupted);
      break;
    }
    test(draw);
  }
  checks.random(false);
}

std::string at(std::initializer_list<std::pair<const char*, double>> values) {
  std::string out;
  for (const auto& [name, value] : values) {
    const std::string_view all(name);
    const auto bar = all.find('|');
    out += (out.empty() ? "" : ", ") + std::string(all.substr(0, bar)) + " = " + short_number(value, 6);
    if (bar != std::string_view::npos) out += " " + std::string(all.substr(bar + 1));
  }
  return out;
}

Coulomb<double> coulomb(double Fs, double Fc, double sigma2) {
  auto law = with_levels<Coulomb<double>>(Fs, Fc);
  law.sigma2 = sigma2;
  return law;
}

Stribeck<double> stribeck(double Fs, double Fc, double vs) {
  auto law = with_levels<Stribeck<double>>(Fs, Fc);
  law.vs = vs;
  return law;
}

LuGre<double> lugre(double Fs, double Fc, double sigma2) {
  auto law = with_levels<LuGre<double>>(Fs, Fc);
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = std::sqrt(1e5);
  law.sigma2 = sigma2;
  return law;
}

std::string Servo::text() const { return at({{"m|kg", mass}, {"kp|N/m", kp}, {"ki|N/(m s)", ki}, {"kd|N s/m", kd}}); }

Loop servo_loop(const Servo& servo, Element friction) {
  LoopParts parts;
  parts.plant = Mass{servo.mass, 0.0, 0.0};
  Pid controller;
  controller.kp = servo.kp;
  controller.ki = servo.ki;
  controller.kd = servo.kd;
  parts.controller = controller;
  parts.friction = std::move(friction);
  return build_loop(parts);
}

Servo stabilising_servo(RandomPoints& draw) {
  Servo servo;
  servo.mass = draw.log_between(0.3, 3.0);
  const double frequency = draw.log_between(0.5, 5.0), damping = draw.between(0.4, 2.0);
  servo.kp = servo.mass * frequency * frequency;
  servo.kd = 2.0 * damping * servo.mass * frequency;
  servo.ki = servo.kd * servo.kp / servo.mass / draw.log_between(1.2, 4.0);
  return servo;
}

Loop belt_loop(const Belt& belt, Element friction) {
  LoopParts parts;
  parts.plant = belt;
  parts.friction = std::move(friction);
  return build_loop(parts);
}

Loop forward_loop(Element element, std::vector<double> numerator, std::vector<double> denominator, double delay) {
  LoopParts parts;
  parts.plant = TransferFunction{std::move(numerator), std::move(denominator), delay};
  parts.element = std::move(element);
  return build_loop(parts);
}

Loop van_der_pol(double mu) {
  Cubic<double> cubic;
  cubic.coefficient = 1.0 / 3.0;
  return forward_loop(cubic, {mu, 0.0}, {1.0, -mu, 1.0});
}

Settled settled(const Loop& loop, double displacement, const ClaimOptions& options, double floor) {
  SettleOptions settle_options;
  settle_options.amplitude_floor = floor * std::max(displacement, 1e-3);
  settle_options.stop = settle_options.shooting.stop = options.stop;
  return settle(loop, displaced(loop, displacement), settle_options);
}

std::optional<ShootingResult> reached_cycle(const Loop& loop, double displacement, const std::string& where,
                                            const ClaimOptions& options, ClaimChecks& checks) {
  auto found = settled(loop, displacement, options);
  if (found.outcome == Outcome::cycle && found.shot) return std::move(found.shot);
  if (found.outcome == Outcome::undecided) {
    checks.stop(options.stop && options.stop() ? Status::interrupted : Status::incomplete);
  } else {
    checks.is_true(where, "there is a limit cycle (it comes to " + std::string(to_string(found.outcome)) + ")", false);
  }
  return std::nullopt;
}

double zero_between(const std::function<double(double)>& f, double low, double high, double accuracy) {
  const double at_low = f(low), at_high = f(high);
  if (at_low == 0.0) return low;
  if (at_high == 0.0) return high;
  if (!(at_low * at_high < 0.0)) return std::nan("");
  bool finite = true;
  const auto checked = [&](double x) {
    const double value = f(x);
    finite = finite && std::isfinite(value);
    return value;
  };
  const auto narrow = [&](double a, double b) {
    return !finite || std::abs(b - a) <= accuracy * std::max(std::abs(a), std::abs(b));
  };
  std::uintmax_t steps = 200;
  const auto [from, to] = boost::math::tools::toms748_solve(checked, low, high, at_low, at_high, narrow, steps);
  return finite ? 0.5 * (from + to) : std::nan("");
}

std::vector<double> zeros_on_grid(const std::function<double(double)>& f, double low, double high, int points) {
  std::vector<double> zeros;
  const auto point = [&](int i) {
    const double share = static_cast<double>(i) / points;
    return low > 0.0 ? low * std::pow(high / low, share) : low + share * (high - low);
  };
  double before = f(low);
  for (int i = 1; i <= points; ++i) {
    const double here = f(point(i));
    if (before * here < 0.0) zeros.push_back(zero_between(f, point(i - 1), point(i)));
    if (here == 0.0) zeros.push_back(point(i));
    before = here;
  }
  return zeros;
}

}  // namespace limcycle::cycle_claims
