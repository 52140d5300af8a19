#include "limcycle/analysis/study/identify/profile.hpp"

#include <gsl/gsl_cdf.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/identify/bounded_fit.hpp"

namespace limcycle {
namespace {

/// Farthest that a profile is followed, in the coordinate: a factor of 12, ten times the typical size, most of (0, 1).
double farthest(Coordinate coordinate) {
  switch (coordinate) {
    case Coordinate::log:
      return std::log(12.0);
    case Coordinate::linear:
      return 10.0;
    case Coordinate::logit:
      return 5.0;
  }
  return 0.0;
}

/// Starts for a sliding level that is to fall, or a Stribeck velocity that is to rise: the break-away level is one of
/// the two levels, sliding is lower, and the velocity between them is beyond the fastest of the records. None for other
/// coordinates.
std::vector<Eigen::VectorXd> beyond_speeds(const ParameterSpace& space, const Eigen::VectorXd& u, Eigen::Index k,
                                           bool falls) {
  constexpr double lower = 0.4;  // as a logarithm
  const auto vs = space.source_of("vs");
  const Eigen::Index speed = vs ? space.coordinate_of(*vs) : -1;
  std::vector<Eigen::VectorXd> starts;
  if (speed < 0) return starts;
  const double fastest = std::log(space.numbers()[*vs].high);
  for (const auto& levels : space.bounds()) {
    if (levels.above < 0 || levels.below < 0 || !(falls ? k == levels.below : k == speed)) continue;
    for (const double beyond : {std::log(3.0), std::log(30.0)})
      for (const Eigen::Index level : {levels.above, levels.below}) {
        if (level == levels.below && u(levels.above) - u(levels.below) < 1e-3) continue;
        Eigen::VectorXd start = u;
        start(levels.above) = u(level);
        start(levels.below) = u(level) - lower;
        start(speed) = fastest + beyond;
        starts.push_back(std::move(start));
      }
  }
  return starts;
}

/// Where a profile reaches the wanted rise.
struct ProfileEnd {
  enum class Kind { found, beyond, unknown } kind = Kind::unknown;  ///< beyond: farther than it was followed
  double distance = 0.0;
};

/// One coordinate held at a distance from the fit, all others fitted.
class Profile {
 public:
  Profile(const FitWithSlopes& at, Eigen::Index k, const std::function<bool()>& stop) : at_(at), k_(k), stop_(stop) {
    const auto& covariance = at.linear.covariance;
    for (Eigen::Index i = 0; i < covariance.rows(); ++i)
      if (i != k && covariance(i, i) > 0.0) active_.push_back(i);  // the others change nothing
    trend_.setZero(covariance.rows());
    if (covariance(k, k) > 0.0) trend_ = covariance.col(k) / covariance(k, k);
  }

  /// The distance of the sign of `first`, whose size is the first guess, `most` at most.
  ProfileEnd crossing(double first, double most) {
    const double sign = first < 0.0 ? -1.0 : 1.0;
    double inside = 0.0, outside = infinite, distance = std::min(std::abs(first), most);
    for (int i = 0; i < 12; ++i) {
      const auto share = share_of_rise(sign * distance);
      if (!share) return {};
      if (*share > 0.8 && *share < 1.25) return {ProfileEnd::Kind::found, sign * distance / std::sqrt(*share)};
      if (*share < 1.0 && distance >= most) return {ProfileEnd::Kind::beyond, sign * most};
      (*share < 1.0 ? inside : outside) = distance;
      if (outside - inside < 0.02 * outside) return {ProfileEnd::Kind::found, sign * 0.5 * (inside + outside)};
      const double guess = *share > 0.0 && std::isfinite(*share) ? distance / std::sqrt(*share) : infinite;
      if (std::isfinite(outside)) {
        const double margin = 0.05 * (outside - inside);
        distance =
            std::isfinite(guess) ? std::clamp(guess, inside + margin, outside - margin) : 0.5 * (inside + outside);
      } else {
        distance = std::min({std::max(guess, 1.05 * distance), std::max(4.0 * distance, 0.05 * most), most});
      }
    }
    return {};
  }

  /// True if the sum is as low several times that distance away on the same side, from another start: where the level
  /// that the records show is that of breaking away, and sliding lies below it at speeds that they do not reach.
  bool goes_on_elsewhere(double distance, double most) {
    constexpr double times = 4.0, least = 0.3, hopeless = 30.0, far_off = 100.0;
    Eigen::VectorXd entries;
    constexpr int few = 8, many = 40;
    const double at = std::min(std::max(times * std::abs(distance), least), most);
    for (const Eigen::VectorXd& start : beyond_speeds(at_.misfit.space(), at_.fit.u, k_, distance < 0.0)) {
      if (stop_ && stop_()) return false;
      Fit there;
      there.u = start;
      there.u(k_) = at_.fit.u(k_) + std::copysign(at, distance);
      // Records that say nothing of the fall are met nearly as well at once.
      const bool answered = at_.misfit.at(there.u, entries, nullptr);
      if (!answered || entries.squaredNorm() - at_.fit.sum_of_squares > far_off * at_.rise) continue;
      for (const int iterations : {few, many}) {
        there = fit_within(at_.misfit, there, felt_coordinates(at_.misfit, there.u), iterations, stop_, k_);
        const double rise = there.sum_of_squares - at_.fit.sum_of_squares;
        if (rise < -0.1 && (!better_ || there.sum_of_squares < better_->sum_of_squares)) better_ = there;
        if (rise < at_.rise) return true;
        if (!(rise < hopeless * at_.rise)) break;
      }
    }
    return false;
  }

  const std::optional<Fit>& better() const { return better_; }

 private:
  /// The least sum of squares at this distance.
  Fit held_at(double distance, bool along_trend, int most_iterations) {
    Fit from = at_.fit;
    if (along_trend) from.u += distance * trend_;
    from.u(k_) = at_.fit.u(k_) + distance;
    return fit_within(at_.misfit, from, active_, most_iterations, stop_, k_);
  }

  /// Rise of the sum of squares at this distance over the wanted one; infinite where the law has no answer. Nothing if
  /// the fit ends before it shows on which side of the crossing it is.
  std::optional<double> share_of_rise(double distance) {
    const bool may_follow = trend_.cwiseAbs().maxCoeff() * std::abs(distance) < 3.0;
    Fit held = held_at(distance, may_follow, 15);
    if (held.status == Status::not_finite && may_follow) held = held_at(distance, false, 15);
    if (held.status == Status::max_iterations) held = fit_within(at_.misfit, held, active_, 60, stop_, k_);
    const double rise = held.sum_of_squares - at_.fit.sum_of_squares;
    if (rise < -0.1 && (!better_ || held.sum_of_squares < better_->sum_of_squares)) better_ = held;
    const bool ended = held.status == Status::converged || held.status == Status::not_finite ||
                       held.possible_decrease < 0.04 * at_.rise;
    if ((stop_ && stop_()) || (!ended && rise >= at_.rise)) return std::nullopt;
    return rise / at_.rise;
  }

  const FitWithSlopes& at_;
  Eigen::Index k_;
  const std::function<bool()>& stop_;
  std::vector<Eigen::Index> active_;
  Eigen::VectorXd trend_;
  std::optional<Fit> better_;
};

bool is_identifiable(const FreeNumber& number, double value, const std::optional<double>& low,
                     const std::optional<double>& high) {
  if (!high) return false;
  switch (number.coordinate) {
    case Coordinate::log:
      return low && *low > 0.1 * value && *high < 10.0 * value;
    case Coordinate::linear:
      return true;
    case Coordinate::logit:
      return low && *high - *low < 0.6;
  }
  return false;
}

/// A number that has a coordinate, about a fit.
class AroundFit {
 public:
  AroundFit(const FitWithSlopes& at, std::size_t index)
      : at_(at),
        number_(at.misfit.space().numbers()[index]),
        row_(static_cast<Eigen::Index>(index)),
        k_(at.misfit.space().coordinate_of(index)),
        most_(farthest(number_.coordinate)),
        half_(std::sqrt(at.rise) * at.linear.deviation(k_)) {}

  NumberInterval linear() const {
    NumberInterval result;
    if (!(half_ < most_)) return result;
    result.low = result.linear_low = value_at(-half_);
    result.high = result.linear_high = value_at(half_);
    result.identifiable = is_identifiable(number_, value_at(0.0), result.low, result.high);
    return result;
  }

  NumberInterval profiled(std::optional<Fit>& better, const std::function<bool()>& stop) const {
    using Kind = ProfileEnd::Kind;
    NumberInterval result = linear();
    // A free motion that no small change moves jumps somewhere: where a body that came to rest would have gone on.
    if (at_.misfit.start_states() > 0 && !std::isfinite(half_)) return result;
    Profile profile(at_, k_, stop);
    const Room room = room_around();
    const auto end = [&](double sign, double most) {
      return most > 0.0 ? profile.crossing(sign * std::min(half_, most), most) : ProfileEnd{Kind::beyond, 0.0};
    };
    ProfileEnd up = end(1.0, room.above), down = end(-1.0, room.below);
    const auto look_elsewhere = [&](ProfileEnd& one, double sign, double most) {
      if (one.kind == Kind::beyond || !(most > 0.0)) return;
      const double from = one.kind == Kind::found ? one.distance : sign * std::min(half_, most);
      if (profile.goes_on_elsewhere(from, most)) one.kind = Kind::beyond;
    };
    look_elsewhere(up, 1.0, room.above);
    look_elsewhere(down, -1.0, room.below);
    result.low = result.high = std::nullopt;
    const auto is_known = [](const ProfileEnd& one, bool law_ends) {
      return one.kind == Kind::found || (one.kind == Kind::beyond && law_ends);
    };
    if (is_known(up, room.law_ends_above)) result.high = value_at(up.distance);
    if (is_known(down, room.law_ends_below)) result.low = value_at(down.distance);
    result.complete = up.kind != Kind::unknown && down.kind != Kind::unknown;
    result.identifiable =
        is_identifiable(number_, value_at(0.0), down.kind == Kind::unknown ? result.linear_low : result.low,
                        up.kind == Kind::unknown ? result.linear_high : result.high);
    if (profile.better()) better = profile.better();
    return result;
  }

 private:
  struct Room {
    double below, above;  ///< how far a profile is followed
    bool law_ends_below = false, law_ends_above = false;
  };
  /// To the bounds that do not move with another number.
  Room room_around() const {
    Room room{most_, most_};
    for (const auto& bound : at_.misfit.space().bounds()) {
      const double distance = std::max(bound.room(at_.fit.u), 0.0);
      const bool stops_fall = bound.above == k_ && bound.below < 0, stops_rise = bound.below == k_ && bound.above < 0;
      if (stops_fall && distance <= room.below) {
        room.below = distance;
        room.law_ends_below = bound.of_law;
      }
      if (stops_rise && distance <= room.above) {
        room.above = distance;
        room.law_ends_above = bound.of_law;
      }
    }
    return room;
  }
  double value_at(double distance) const {
    Eigen::VectorXd u = at_.fit.u;
    u(k_) += distance;
    return std::max(at_.misfit.space().values(u)(row_), number_.range.low);
  }

  const FitWithSlopes& at_;
  const FreeNumber& number_;
  Eigen::Index row_, k_;
  double most_, half_;
};

/// Calls `ask(around)` where number `index` has a coordinate: a dependent share becomes a free one for that, and
/// another one dependent. `own` gets the map back from the coordinates there.
template <class Ask>
NumberInterval with_coordinate(const FitWithSlopes& at, std::size_t index, const Ask& ask) {
  const ParameterSpace& space = at.misfit.space();
  if (space.coordinate_of(index) >= 0) return ask(AroundFit(at, index), [](const Eigen::VectorXd& u) { return u; });
  std::size_t other = 0;
  while (other < space.numbers().size() && (other == index || !space.is_share_of_sum(other))) ++other;
  if (other == space.numbers().size())  // the only share
    return {.low = 1.0, .high = 1.0, .linear_low = 1.0, .linear_high = 1.0, .identifiable = true};
  const ParameterSpace turned = space.with_dependent(other);
  Misfit same(turned, at.misfit.records(), at.misfit.noise(), at.misfit.shooting());
  Fit there = at.fit;
  there.u = turned.coordinates(space.values(at.fit.u));
  same.start_from(there.u);
  const auto turned_at = with_slopes(same, there);
  if (!turned_at) return {.complete = false};
  return ask(AroundFit(*turned_at, index),
             [&](const Eigen::VectorXd& u) { return space.coordinates(turned.values(u)); });
}

}  // namespace

LinearCovariance linear_covariance(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& units) {
  const Eigen::Index n = slopes.cols();
  // Columns of very different size first get the same one, so that "dependent" does not depend on units.
  Eigen::VectorXd size = slopes.colwise().norm();
  const double largest = size.maxCoeff();
  for (Eigen::Index k = 0; k < n; ++k)
    if (!(size(k) > 1e-10 * largest)) size(k) = infinite;
  const Eigen::VectorXd inverse_size = size.cwiseInverse();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(slopes * inverse_size.asDiagonal(), Eigen::ComputeThinV);
  LinearCovariance result;
  result.covariance.setZero(n, n);
  result.deviation.setZero(n);
  const Eigen::VectorXd& values = svd.singularValues();
  std::vector<bool> lost(static_cast<std::size_t>(n), false);
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const Eigen::VectorXd direction = svd.matrixV().col(j);
    if (values(j) > 1e-8 * values(0)) {
      const Eigen::VectorXd scaled = direction.cwiseProduct(inverse_size) / values(j);
      result.covariance += scaled * scaled.transpose();
    } else {
      for (Eigen::Index k = 0; k < n; ++k)
        if (std::abs(direction(k)) > 1e-6) lost[static_cast<std::size_t>(k)] = true;
    }
  }
  for (Eigen::Index k = 0; k < n; ++k)
    result.deviation(k) =
        lost[static_cast<std::size_t>(k)] || inverse_size(k) == 0.0 ? infinite : std::sqrt(result.covariance(k, k));
  const Eigen::MatrixXd counted = units.size() > 0 ? Eigen::MatrixXd(slopes * units.asDiagonal()) : slopes;
  const Eigen::JacobiSVD<Eigen::MatrixXd> plain(counted, Eigen::ComputeThinV);
  result.singular_values = plain.singularValues();
  result.directions = plain.matrixV();
  return result;
}

double interval_rise(double sum_of_squares, Eigen::Index entries, Eigen::Index coordinates, double least) {
  const auto freedom = static_cast<double>(std::max<Eigen::Index>(entries - coordinates, 1));
  const double t = gsl_cdf_tdist_Pinv(0.975, freedom);
  return t * t * std::max(sum_of_squares / freedom, least);
}

std::optional<FitWithSlopes> with_slopes(const Misfit& misfit, const Fit& fit) {
  Eigen::VectorXd entries;
  Eigen::MatrixXd slopes;
  if (fit.u.size() == 0 || !misfit.at(fit.u, entries, &slopes)) return std::nullopt;
  const Eigen::Index starts = misfit.start_states();
  const bool by_squares = std::ranges::none_of(misfit.records(), &PreparedRecord::huber);
  // A number that may be 0 is determined if its deviation is small for itself, however large for its typical size.
  Eigen::VectorXd units = Eigen::VectorXd::Ones(fit.u.size());
  for (Eigen::Index k = 0; k < units.size(); ++k)
    if (misfit.space().numbers()[misfit.space().number_of(k)].coordinate == Coordinate::linear)
      units(k) = std::max(1.0, std::abs(fit.u(k)));
  return FitWithSlopes{misfit, fit, linear_covariance(slopes, units),
                       interval_rise(by_squares ? fit.sum_of_squares : misfit.spread(entries), misfit.size(),
                                     misfit.space().size() + starts, starts > 0 ? 1.0 : 1e-6)};
}

NumberInterval profile_interval(const FitWithSlopes& at, std::size_t index, std::optional<Fit>& better,
                                const std::function<bool()>& stop) {
  return with_coordinate(at, index, [&](const AroundFit& around, const auto& own) {
    std::optional<Fit> found;
    const NumberInterval result = around.profiled(found, stop);
    if (found) {
      better = found;
      better->u = own(found->u);
    }
    return result;
  });
}

NumberInterval linear_interval(const FitWithSlopes& at, std::size_t index) {
  return with_coordinate(at, index, [](const AroundFit& around, const auto&) { return around.linear(); });
}

}  // namespace limcycle
