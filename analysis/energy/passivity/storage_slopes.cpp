#include "limcycle/analysis/energy/passivity/storage_slopes.hpp"
#include "limcycle/analysis/golden_maximum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limcycle {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double roundings = 64.0 * epsilon, doubtful = 1e-9;

/// One state, evaluated over all velocities of one sign after the other.
class SlopeScan {
 public:
  SlopeScan(const OneStateLaw& law, double z) : law_(law) { result_.z = z; }

  SlopeGap run() {
    for (const double side : {1.0, -1.0}) {
      points_.clear();
      for (const double speed : law_.speeds()) points_.push_back(law_.at(result_.z, side * speed));
      for (const OneStatePoint& point : points_)
        result_.finite = result_.finite && std::isfinite(point.rate) && std::isfinite(point.supply);
      look_for_leaks(side);
      for (const int direction : {1, -1}) {
        look_for_extrema(side, direction);
        look_beyond(side, direction);
      }
    }
    measure(result_.up, 1);
    measure(result_.down, -1);
    return result_;
  }

 private:
  PassingGain& best(int direction) { return direction > 0 ? result_.up : result_.down; }
  void offer(int direction, double v, double gain) {
    PassingGain& old = best(direction);
    if (gain > old.gain) old.gain = gain, old.v = v;
  }
  double gain_at(std::size_t i, int direction) const {
    const OneStatePoint& point = points_[i];
    return point.exists && point.rate * direction > 0.0 ? -point.supply / std::abs(point.rate) : -infinite;
  }

  /// f = 0 with F v < 0: the law gives energy as long as that velocity is kept.
  void look_for_leaks(double side) {
    const auto& speeds = law_.speeds();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!points_[i].exists) continue;
      if (points_[i].rate == 0.0 && points_[i].supply < 0.0) result_.leak = side * speeds[i];
      if (i == 0 || !points_[i - 1].exists || !(points_[i].rate * points_[i - 1].rate < 0.0)) continue;
      double low = speeds[i - 1], high = speeds[i];
      for (int k = 0; k < 60; ++k) {
        const double middle = std::sqrt(low * high);
        (law_.at(result_.z, side * middle).rate * points_[i].rate > 0.0 ? high : low) = middle;
      }
      const OneStatePoint zero = law_.at(result_.z, side * high);
      const double around = std::max(std::abs(points_[i].rate), std::abs(points_[i - 1].rate));
      const bool crosses = std::abs(zero.rate) < 1e-6 * around;
      if (crosses && zero.supply < -doubtful * high * law_.law().scales().output) result_.leak = side * high;
    }
  }

  void look_for_extrema(double side, int direction) {
    const auto& speeds = law_.speeds();
    const auto gain = [&](double log_speed) { return law_.gain(result_.z, side * std::exp(log_speed), direction); };
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double here = gain_at(i, direction);
      if (!(here > -infinite)) continue;
      offer(direction, side * speeds[i], here);
      if (i == 0 || i + 1 == points_.size()) continue;
      const double most = std::max(gain_at(i - 1, direction), gain_at(i + 1, direction));
      if (!(here > most + 1e-13 * std::abs(most))) continue;
      const double v =
          std::exp(golden_maximum(gain, std::log(speeds[i - 1]), std::log(speeds[i]), std::log(speeds[i + 1]), 30));
      offer(direction, side * v, law_.gain(result_.z, side * v, direction));
    }
  }

  /// Unbounded growth: from the last speed on the gain rises by as much, or more, every decade. A gain that settles
  /// rises by a tenth of the previous rise.
  void look_beyond(double side, int direction) {
    if (std::isfinite(law_.top_speed()) || law_.rate_independent()) return;
    const double last = law_.speeds().back();
    double gains[3];
    for (int k = 0; k < 3; ++k) gains[k] = law_.gain(result_.z, side * last * std::pow(10.0, k), direction);
    if (!(gains[0] > -infinite && gains[1] > -infinite && gains[2] > -infinite)) return;
    // At the very end of the states the sign of f may be one of roundings.
    if (!(law_.gain((1.0 - 1e-11) * result_.z, side * last, direction) > -infinite)) return;
    const double before = gains[1] - gains[0], rise = gains[2] - gains[1];
    offer(direction, side * 100.0 * last, gains[2]);
    if (!(rise > 0.0) || rise < 0.5 * before) return;
    const double terms = terms_at(side * 100.0 * last, direction);
    if (rise > doubtful * terms)
      best(direction).endless = true;
    else if (rise > roundings * terms)
      best(direction).unsure = true;
  }

  /// |q| + |z dq/dz| + |v dq/dv|: change of the gain by relative errors of z and v, and so of the law's own terms.
  double terms_at(double v, int direction) const {
    constexpr double h = 1e-7;
    const double z = result_.z, here = law_.gain(z, v, direction);
    double terms = std::abs(here);
    const auto add = [&](double moved) {
      terms += moved > -infinite ? std::abs(moved - here) / h : std::abs(here) / h;
    };
    add(law_.gain(z * (1.0 - h), v, direction));
    add(law_.gain(z, v * (1.0 - h), direction));
    return terms;
  }
  void measure(PassingGain& passing, int direction) {
    if (passing.gain > -infinite) passing.terms = terms_at(passing.v, direction);
  }

  const OneStateLaw& law_;
  SlopeGap result_;
  std::vector<OneStatePoint> points_;
};

/// Uniform, and graded by halves towards both ends and 0. A state without bound is followed for a thousand scales.
std::vector<double> grid_of(const OneStateLaw& law) {
  const double scale = law.law().state_scale(0);
  std::vector<double> grid{0.0};
  for (const double edge : {law.low(), law.high()}) {
    const double end = std::isfinite(edge) ? edge : std::copysign(4.0 * scale, edge);
    if (end == 0.0) continue;
    for (int k = 1; k < 48; ++k) grid.push_back(end * k / 48.0);
    for (int k = 6; k <= 24; k += 2) grid.push_back(std::ldexp(end, -k));
    if (std::isfinite(edge)) {
      for (int k = 6; k <= 33; ++k) grid.push_back(end - std::ldexp(end, -k));
      grid.push_back(end);
    } else {
      for (int k = 0; k <= 8; ++k) grid.push_back(std::ldexp(end, k));
    }
  }
  std::ranges::sort(grid);
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return grid;
}

/// Slopes that agree everywhere still give no storage if their integral falls without bound: towards infinity, or
/// towards an end of the states where f -> 0 while F v < 0.
bool has_bounded_storage(const OneStateLaw& law) {
  for (const double edge : {law.low(), law.high()}) {
    if (!std::isfinite(edge)) return false;
    for (const double speed : law.speeds())
      for (const double v : {speed, -speed}) {
        const OneStatePoint end = law.at(edge, v), before = law.at((1.0 - 1e-6) * edge, v);
        const bool stands = end.exists && std::abs(end.rate) <= 1e-3 * std::abs(before.rate);
        const bool outwards = before.rate * edge > 0.0;
        if (stands && outwards && end.supply < -doubtful * speed * law.law().scales().output) return false;
      }
  }
  return true;
}

int severity(Passive verdict) { return verdict == Passive::no ? 2 : verdict == Passive::undecided ? 1 : 0; }

/// From the ends inwards: laws of the LuGre family fail there first.
std::vector<std::size_t> from_ends(std::size_t count) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; 2 * i < count; ++i) {
    order.push_back(count - 1 - i);
    if (i != count - 1 - i) order.push_back(i);
  }
  return order;
}

/// States between grid points at which the gap has a local maximum close to 0.
std::vector<SlopeGap> refined(const OneStateLaw& law, const std::vector<SlopeGap>& gaps) {
  std::vector<SlopeGap> more;
  for (std::size_t i = 1; i + 1 < gaps.size(); ++i) {
    const double here = gaps[i].relative(), most = std::max(gaps[i - 1].relative(), gaps[i + 1].relative());
    if (!(here > -0.3) || !(here > most + 1e-12)) continue;
    const auto height = [&](double z) { return slope_gap(law, z).relative(); };
    more.push_back(slope_gap(law, golden_maximum(height, gaps[i - 1].z, gaps[i].z, gaps[i + 1].z, 24)));
  }
  return more;
}

}  // namespace

double SlopeGap::relative() const {
  if (leak != 0.0 || up.endless || down.endless) return 1.0;
  if (!(up.gain > -infinite) || !(down.gain > -infinite)) return -1.0;
  const double size = std::abs(up.gain) + std::abs(down.gain);
  return size > 0.0 ? (up.gain + down.gain) / size : 0.0;
}

Passive SlopeGap::verdict() const {
  if (leak != 0.0 || up.endless || down.endless) return Passive::no;
  if (!finite || up.unsure || down.unsure) return Passive::undecided;
  if (!(up.gain > -infinite) || !(down.gain > -infinite)) return Passive::yes;
  const double sum = up.gain + down.gain, terms = up.terms + down.terms;
  return sum <= roundings * terms ? Passive::yes : sum <= doubtful * terms ? Passive::undecided : Passive::no;
}

SlopeGap slope_gap(const OneStateLaw& law, double z) { return SlopeScan(law, z).run(); }

SlopeSurvey survey_slopes(const OneStateLaw& law, bool complete, const std::function<bool()>& stop) {
  SlopeSurvey survey;
  survey.worst.z = std::numeric_limits<double>::quiet_NaN();
  const auto grid = grid_of(law);
  survey.gaps.resize(grid.size());
  Passive& found = survey.passive = Passive::yes;
  const auto take = [&](const SlopeGap& gap) {
    const Passive verdict = gap.verdict();
    const int rank = severity(verdict), before = severity(found);
    const bool first = std::isnan(survey.worst.z);
    if (first || rank > before || (rank == before && gap.relative() > survey.worst.relative())) survey.worst = gap;
    if (rank > before) found = verdict;
    if (!gap.finite) survey.status = Status::not_finite;
  };
  for (const std::size_t i : from_ends(grid.size())) {
    if (stop && stop()) {
      survey.status = Status::interrupted;
      survey.passive = Passive::undecided;
      survey.gaps.clear();
      return survey;
    }
    take(survey.gaps[i] = slope_gap(law, grid[i]));
    if (!complete && found == Passive::no) {
      survey.gaps = {survey.worst};
      return survey;
    }
  }
  if (survey.passive == Passive::yes && !has_bounded_storage(law)) survey.passive = Passive::undecided;
  for (const SlopeGap& gap : refined(law, survey.gaps)) {
    take(gap);
    survey.gaps.push_back(gap);
  }
  std::ranges::sort(survey.gaps, {}, &SlopeGap::z);
  return survey;
}

Passive one_state_verdict(const Element& law, double top_speed, const std::function<bool()>& stop) {
  return survey_slopes(OneStateLaw(law, top_speed), false, stop).passive;
}

}  // namespace limcycle
