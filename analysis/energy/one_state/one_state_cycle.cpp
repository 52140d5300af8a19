#include "limcycle/analysis/energy/one_state/one_state_cycle.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

namespace limcycle {
namespace {

constexpr double most_growth = 2.0;  // of a small difference in one cycle: ten cycles then keep twelve digits

/// Gains over states, of one velocity.
using GainRow = std::vector<double>;

/// Energy that two velocities take out, and the states between which they do.
struct Pair {
  std::size_t up, down, from, to;  // indices of the velocities, and of the states between which it is worthwhile
  double energy, top_speed;
};

/// Every pair of velocities of a grid, over a grid of states.
class PairSearch {
 public:
  /// Omits states closer to an end of the reachable range than `margin` times it (motion there is slow, and ill
  /// conditioned), and speeds below `slowest` velocity scales.
  PairSearch(const OneStateLaw& law, const SlopeSurvey& survey, double margin, double slowest) : law_(law) {
    const auto add = [&](double z) {
      if (is_inside(z, law.high(), margin) && is_inside(-z, -law.low(), margin)) z_.push_back(z);
    };
    for (const SlopeGap& gap : survey.gaps) add(gap.z);
    if (closed())
      for (const SlopeGap& gap : survey.gaps) add(-gap.z);
    for (int k = 3; k < 20; ++k)  // the states about the worst one, on both sides
      for (const double part : {1.0 - std::ldexp(1.0, -k), 1.0, 1.0 + std::ldexp(1.0, -k)})
        for (const double side : {1.0, -1.0}) add(side * part * survey.worst.z);
    std::ranges::sort(z_);
    z_.erase(std::unique(z_.begin(), z_.end()), z_.end());
    choose_velocities(survey, slowest);
    for (const double v : velocities_)
      for (const int direction : {1, -1}) {
        GainRow row;
        for (const double z : z_) row.push_back(law.gain(z, v, direction));
        (direction > 0 ? up_ : down_).push_back(std::move(row));
      }
  }

  std::vector<TwoSpeedCycle> best(std::size_t count) {
    std::vector<Pair> pairs = closed() ? symmetric_pairs() : all_pairs();
    const double enough = 0.1 * law_.law().scales().output * law_.law().scales().displacement;
    std::ranges::sort(pairs, [enough](const Pair& a, const Pair& b) {
      if ((a.energy >= enough) != (b.energy >= enough)) return a.energy >= enough;
      if (a.energy >= enough && a.top_speed != b.top_speed) return a.top_speed < b.top_speed;
      return a.energy > b.energy;
    });
    std::vector<TwoSpeedCycle> cycles;
    for (std::size_t i = 0; i < pairs.size() && i < 200 && cycles.size() < count; ++i)
      if (const auto cycle = settled(pairs[i])) cycles.push_back(*cycle);
    return cycles;
  }

 private:
  static bool is_inside(double z, double edge, double margin) {
    return !std::isfinite(edge) || z < edge - margin * std::abs(edge);
  }
  bool closed() const { return law_.law().follows_position(); }

  void choose_velocities(const SlopeSurvey& survey, double slowest) {
    const double scale = law_.velocity_scale();
    std::vector<double> speeds;
    if (law_.rate_independent()) {
      speeds = {scale};
    } else {
      const double top = std::min(law_.top_speed(), 1e15 * scale);
      const double step = std::pow(10.0, 0.2);
      double speed = slowest * scale;
      while (speed < top) {
        speeds.push_back(speed);
        speed *= step;
      }
      speeds.push_back(top);
      const double worst[] = {survey.worst.up.v, survey.worst.down.v, survey.worst.leak};
      for (const double v : worst)
        if (std::abs(v) >= slowest * scale && std::abs(v) <= top) speeds.push_back(std::abs(v));
    }
    for (const double speed : speeds)
      for (const double v : {speed, -speed}) velocities_.push_back(v);
  }

  double panel(const GainRow& gains, std::size_t i) const {
    return 0.5 * (gains[i] + gains[i + 1]) * (z_[i + 1] - z_[i]);
  }

  /// For each pair the run of states over which it takes out most energy (Kadane).
  std::vector<Pair> all_pairs() const {
    std::vector<Pair> pairs;
    for (std::size_t u = 0; u < velocities_.size(); ++u)
      for (std::size_t d = 0; d < velocities_.size(); ++d) {
        Pair pair{u, d, 0, 0, 0.0, std::max(std::abs(velocities_[u]), std::abs(velocities_[d]))};
        double sum = 0.0;
        std::size_t from = 0;
        for (std::size_t i = 0; i + 1 < z_.size(); ++i) {
          if (!(sum > 0.0)) sum = 0.0, from = i;
          sum += panel(up_[u], i) + panel(down_[d], i);
          if (sum > pair.energy) pair.energy = sum, pair.from = from, pair.to = i + 1;
        }
        if (pair.energy > 0.0) pairs.push_back(pair);
      }
    return pairs;
  }

  /// Pairs +-v over [-a, a]: for an odd law such a cycle also ends where it began in x.
  std::vector<Pair> symmetric_pairs() const {
    std::vector<Pair> pairs;
    const std::size_t n = z_.size();
    for (std::size_t u = 0; u < velocities_.size(); ++u) {
      const std::size_t d = u ^ 1;
      for (std::size_t i = 0; 2 * i + 1 < n && z_[i] == -z_[n - 1 - i]; ++i) {
        double sum = 0.0;
        for (std::size_t k = i; k < n - 1 - i; ++k) sum += panel(up_[u], k) + panel(down_[d], k);
        if (sum > 0.0) pairs.push_back({u, d, i, n - 1 - i, sum, std::abs(velocities_[u])});
      }
    }
    return pairs;
  }

  TwoSpeedCycle cycle_of(const Pair& pair) const {
    TwoSpeedCycle cycle{.z1 = z_[pair.from], .z2 = z_[pair.to], .v_up = velocities_[pair.up]};
    cycle.v_down = velocities_[pair.down];
    const auto ratio = [&](double z) { return law_.at(z, cycle.v_up).rate / law_.at(z, cycle.v_down).rate; };
    cycle.multiplier = std::abs(ratio(cycle.z2) / ratio(cycle.z1));
    return cycle;
  }

  /// The pair over states between which its motion does not diverge, if it takes out energy there. A law without
  /// history does not reach an unstable cycle, but it can begin on one that passes z = 0.
  std::optional<TwoSpeedCycle> settled(Pair pair) const {
    TwoSpeedCycle cycle = cycle_of(pair);
    if (cycle.multiplier < 1.0) return cycle;
    const bool through_zero = cycle.z1 <= 0.0 && cycle.z2 >= 0.0;
    if (through_zero && cycle.multiplier <= most_growth) return cycle;
    if (closed()) return std::nullopt;
    const auto zero = static_cast<std::size_t>(std::ranges::lower_bound(z_, 0.0) - z_.begin());
    std::optional<TwoSpeedCycle> best;
    double most = 0.0;
    for (std::size_t from = pair.from; from < pair.to; ++from) {
      double sum = 0.0;
      for (std::size_t to = from + 1; to <= pair.to; ++to) {
        sum += panel(up_[pair.up], to - 1) + panel(down_[pair.down], to - 1);
        if (!(sum > most)) continue;
        Pair part = pair;
        part.from = from, part.to = to;
        const TwoSpeedCycle shorter = cycle_of(part);
        const bool passes = from <= zero && to >= zero;
        if (shorter.multiplier < 1.0 || (passes && shorter.multiplier <= most_growth)) best = shorter, most = sum;
      }
    }
    return best;
  }

  const OneStateLaw& law_;
  std::vector<double> z_, velocities_;
  std::vector<GainRow> up_, down_;
};

}  // namespace

void integrate(const OneStateLaw& law, TwoSpeedCycle& cycle) {
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  const double way = cycle.z2 - cycle.z1;
  // Over [0, 1], where the rule's error estimate is one of the integral itself.
  const auto over = [&](auto&& f, double& error) {
    return Rule::integrate([&](double part) { return way * f(cycle.z1 + part * way); }, 0.0, 1.0, 12, 1e-12, &error);
  };
  double up_error = 0.0, down_error = 0.0, ignored = 0.0;
  const double up = over([&](double z) { return law.gain(z, cycle.v_up, 1); }, up_error);
  const double down = over([&](double z) { return law.gain(z, cycle.v_down, -1); }, down_error);
  cycle.energy = up + down;
  cycle.error = up_error + down_error + 1e-14 * (std::abs(up) + std::abs(down));
  cycle.time_up = over([&](double z) { return 1.0 / law.at(z, cycle.v_up).rate; }, ignored);
  cycle.time_down = over([&](double z) { return -1.0 / law.at(z, cycle.v_down).rate; }, ignored);
}

std::vector<TwoSpeedCycle> two_speed_cycles(const OneStateLaw& law, const SlopeSurvey& survey, int reach) {
  constexpr std::pair<double, double> limits[reaches] = {{1e-2, 1e-3}, {1e-4, 1e-4}, {1e-6, 1e-6}, {0.0, 1e-9}};
  const auto [margin, slowest] = limits[reach];
  std::vector<TwoSpeedCycle> cycles;
  for (TwoSpeedCycle& cycle : PairSearch(law, survey, margin, slowest).best(4)) {
    integrate(law, cycle);
    if (std::isfinite(cycle.energy) && cycle.energy > 10.0 * cycle.error) cycles.push_back(cycle);
  }
  return cycles;
}

}  // namespace limcycle
