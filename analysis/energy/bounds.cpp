#include "limcycle/analysis/energy/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "limcycle/analysis/energy/one_state_law.hpp"
#include "limcycle/analysis/energy/resimulate.hpp"

namespace limcycle {
namespace {

/// The largest |F| over the states that can be reached and the velocities.
class LargestForce {
 public:
  explicit LargestForce(const OneStateLaw& law) : law_(law) {}

  ForceBound run() {
    const double scale = law_.law().state_scale(0);
    const double low = std::max(law_.low(), -1e6 * scale), high = std::min(law_.high(), 1e6 * scale);
    constexpr int count = 96;
    for (int k = 0; k <= count; ++k) scan(low + (high - low) * k / count);
    for (int round = 0; round < 3; ++round) refine(low, high, (high - low) / count);
    best_.up_to_speed = law_.top_speed();
    best_.kind = BoundKind::exact;
    if (!std::isfinite(law_.low()) || !std::isfinite(law_.high()) || grows()) best_.value = infinite;
    return best_;
  }

 private:
  double force(double z, double v) const {
    const OneStatePoint point = law_.at(z, v);
    return point.exists ? std::abs(point.force) : 0.0;
  }
  void offer(double z, double v) {
    const double value = force(z, v);
    if (value > best_.value) best_.value = value, best_.z = z, best_.v = v;
  }
  void scan(double z) {
    for (const double speed : law_.speeds())
      for (const double v : {speed, -speed}) offer(z, v);
  }
  void refine(double low, double high, double step) {
    const double a = std::max(low, best_.z - step), b = std::min(high, best_.z + step);
    offer(golden_maximum([&](double z) { return force(z, best_.v); }, a, best_.z, b, 60), best_.v);
    const auto& speeds = law_.speeds();
    const double speed = std::abs(best_.v), side = std::copysign(1.0, best_.v);
    const auto above = std::ranges::upper_bound(speeds, speed);
    const auto below = std::ranges::lower_bound(speeds, speed);
    const double from = below == speeds.begin() ? speed : *std::prev(below);
    const double to = above == speeds.end() ? speed : *above;
    const auto at_speed = [&](double log_speed) { return force(best_.z, side * std::exp(log_speed)); };
    offer(best_.z, side * std::exp(golden_maximum(at_speed, std::log(from), std::log(speed), std::log(to), 60)));
  }
  /// Without a limit of the speed: whether the force still rises beyond the last speed looked at.
  bool grows() const {
    if (std::isfinite(law_.top_speed()) || law_.rate_independent()) return false;
    return force(best_.z, 10.0 * best_.v) > 1.5 * best_.value && std::abs(best_.v) >= law_.speeds().back();
  }

  const OneStateLaw& law_;
  ForceBound best_;
};

template <class E>
double highest_level(const E& law) {
  return std::max(law.Fs, law.Fs_minus);
}
template <class E>
double viscous(const E& law, double speed) {
  if constexpr (requires { law.sigma2; }) return law.sigma2 > 0.0 ? law.sigma2 * speed : 0.0;
  return 0.0;
}

/// Bounds that the equations of a law prove.
struct Analytic {
  double speed;

  /// |z_i|, or nothing where states are not so bounded.
  std::vector<StateBound> states(const auto&) const { return {}; }
  template <class E>
  requires requires(E e) { e.sum_of_limits(); }
  std::vector<StateBound> states(const E& law) const {
    return even(law.states(), [&](int i) { return law.state_scale(i); });
  }
  std::vector<StateBound> states(const Gms<double>& law) const {
    return even(law.states(), [&](int i) { return law.alpha[static_cast<std::size_t>(i)] * highest_level(law); });
  }
  std::vector<StateBound> states(const Xiong<double>& law) const {
    auto list = even(static_cast<int>(law.K.size()), [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      return law.lambda[k] * highest_level(law) / law.K[k];
    });
    list.push_back({std::min(law.Fc, law.Fc_minus), highest_level(law), BoundKind::analytic});
    return list;
  }
  std::vector<StateBound> states(const Wojewoda<double>& law) const {
    // In slip z is 0; at rest the spring takes over with 2 Fc - Fs, which is less than Fs in size for Fc >= 0.
    return {{-law.Fs_minus / law.ks, law.Fs / law.ks, BoundKind::analytic}};
  }

  /// |F|; nothing where it is not known.
  std::optional<double> force(const auto&) const { return std::nullopt; }
  /// |F - sigma2 v| <= Fs: at rest, in slip at g(v) <= Fs, or capped by it. Wojewoda: 2 Fc - g >= -Fs.
  template <class E>
  requires(std::same_as<E, Coulomb<double>> || std::same_as<E, Stribeck<double>> || std::same_as<E, Karnopp<double>> ||
           std::same_as<E, Quinn<double>> || std::same_as<E, Awrejcewicz<double>> ||
           std::same_as<E, Wojewoda<double>> || std::same_as<E, Xiong<double>> || std::same_as<E, TwoState<double>> ||
           std::same_as<E, NonDrift<double>>) std::optional<double> force(const E& law)
  const { return highest_level(law) + viscous(law, speed); }
  std::optional<double> force(const Iwan<double>& law) const { return law.Fs; }
  std::optional<double> force(const MaxwellSlip<double>& law) const { return law.sum_of_limits(); }
  /// |F_h| <= Fs, as dz/dt turns back there, so that |dz/dt| <= |v| (1 + (Fs/Fc)^n).
  std::optional<double> force(const Leuven<double>& law) const {
    const double most = highest_level(law), least = std::min(law.Fc, law.Fc_minus);
    const double pull = law.sigma1 > 0.0 ? law.sigma1 * speed * (1.0 + std::pow(most / least, law.n)) : 0.0;
    return std::min(most, law.sum_of_limits()) + pull + viscous(law, speed);
  }
  /// |F_i| <= alpha_i Fs; |dF_i/dt| <= k_i |v| in stick and C alpha_i (1 + Fs/Fc) in slip.
  std::optional<double> force(const Gms<double>& law) const {
    const double most = highest_level(law), ratio = 1.0 + most / std::min(law.Fc, law.Fc_minus);
    double sum = most + viscous(law, speed);
    for (std::size_t i = 0; i < law.sigma1.size(); ++i)
      if (law.sigma1[i] > 0.0)
        sum += law.sigma1[i] / law.k[i] * std::max(law.k[i] * speed, law.C * law.alpha[i] * ratio);
    return sum;
  }

 private:
  static std::vector<StateBound> even(int count, auto&& size) {
    std::vector<StateBound> list;
    list.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) list.push_back({-size(i), size(i), BoundKind::analytic});
    return list;
  }
};

/// Speeds and ways of the inputs of a search.
class Inputs {
 public:
  Inputs(const ErasedElement<double>& law, const BoundsOptions& options) : random_(options.seed) {
    const Scales scales = law.scales();
    // A law that knows no size of its own is the same at any.
    const bool has_way = std::isfinite(scales.displacement), has_velocity = std::isfinite(scales.velocity);
    way_ = has_way ? scales.displacement : has_velocity ? 1e-3 * scales.velocity : 1e-6;
    const double velocity = has_velocity ? scales.velocity : 10.0 * way_;
    top_ = std::min(options.top_speed, 1e3 * velocity);
    slow_ = std::min(1e-2 * velocity, top_);
  }

  VelocityCycle next(long number) {
    VelocityCycle input;
    const double sense = number % 2 == 0 ? 1.0 : -1.0;
    if (number % 3 == 0) {  // load slowly, then jump to the top speed, the same way or back
      const double back = number % 6 < 3 ? 1.0 : -1.0;
      add(input, sense * slow_, 40.0 * way_);
      add(input, sense * back * top_, between(0.1, 30.0) * way_);
      add(input, -sense * slow_, between(0.1, 30.0) * way_);
    } else {
      const int pieces = 3 + static_cast<int>(number % 5);
      for (int k = 0; k < pieces; ++k) {
        const double side = std::uniform_real_distribution<>(-1.0, 1.0)(random_);
        add(input, std::copysign(between(slow_, top_), side), between(0.01, 30.0) * way_);
      }
    }
    return input;
  }

 private:
  double between(double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<>(0.0, 1.0)(random_));
  }
  static void add(VelocityCycle& input, double v, double way) {
    const double from = input.time.empty() ? 0.0 : input.period();
    for (const double t : {from, from + way / std::abs(v)}) {
      input.time.push_back(t);
      input.velocity.push_back(v);
    }
  }

  std::mt19937_64 random_;
  double way_ = 0.0, slow_ = 0.0, top_ = 0.0;
};

Bounds one_state_bounds(const ErasedElement<double>& law, double top_speed) {
  const OneStateLaw one(law, top_speed);
  Bounds result;
  result.states = {{one.low(), one.high(), BoundKind::exact}};
  result.force = LargestForce(one).run();
  return result;
}

}  // namespace

std::string_view to_string(BoundKind kind) {
  return kind == BoundKind::exact ? "exact" : kind == BoundKind::analytic ? "analytic" : "searched";
}

WorstSeen worst_seen(const ErasedElement<double>& law, const BoundsOptions& options) {
  WorstSeen seen;
  seen.low.assign(static_cast<std::size_t>(law.states()), infinite);
  seen.high.assign(static_cast<std::size_t>(law.states()), -infinite);
  ResimulationOptions run;
  run.tolerance = 1e-9;
  run.max_steps = 20'000;
  run.stop = options.stop;
  run.watch = [&](const Input<double>& in, Mode mode, std::span<const double> z) {
    for (std::size_t i = 0; i < z.size(); ++i) {
      seen.low[i] = std::min(seen.low[i], z[i]);
      seen.high[i] = std::max(seen.high[i], z[i]);
    }
    seen.force = std::max(seen.force, std::abs(law.output({0.0, in.v, in.drive}, mode, z)));
  };
  Inputs inputs(law, options);
  for (; seen.inputs < options.inputs && !(options.stop && options.stop()); ++seen.inputs)
    if (resimulate_virgin(law, inputs.next(seen.inputs), 2, run).status != Status::converged) ++seen.unfinished;
  return seen;
}

Bounds bounds(const Element<double>& element, const BoundsOptions& options) {
  if (!is_friction(element)) throw std::invalid_argument("bounds are of a friction law");
  if (!(options.top_speed > 0.0))
    throw std::invalid_argument("a top speed must be positive, not " + std::to_string(options.top_speed));
  const ErasedElement<double> law(element);
  Bounds result;
  if (OneStateLaw::fits(element)) {
    result = one_state_bounds(law, options.top_speed);
  } else {
    const Analytic analytic{options.top_speed};
    result.states = std::visit([&](const auto& e) { return analytic.states(e); }, element);
    if (const auto force = std::visit([&](const auto& e) { return analytic.force(e); }, element))
      result.force = {*force, options.top_speed, BoundKind::analytic};
  }
  result.seen = worst_seen(law, options);
  if (options.stop && options.stop()) result.status = Status::interrupted;
  if (result.states.empty() && options.inputs > 0)
    for (std::size_t i = 0; i < result.seen.low.size(); ++i)
      result.states.push_back({result.seen.low[i], result.seen.high[i], BoundKind::searched});
  return result;
}

}  // namespace limcycle
