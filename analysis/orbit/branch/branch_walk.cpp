#include "limcycle/analysis/orbit/branch/branch_walk.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "limcycle/analysis/orbit/branch/branch_end.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double smallest_share = 1e-5;  ///< of the largest amplitude: below, the orbit has shrunk into rest
constexpr double longest_share = 1e5;    ///< of the shortest period: above, the period is going to infinity
constexpr double largest_share = 1e5;    ///< of the first amplitude: above, the amplitude is going to infinity
constexpr double sharpest_turn = 0.96;   ///< cosine of the angle that the tangent may turn by in a step
constexpr double longest_jump = 10.0;    ///< of the shortest steps, relative to them, at a corner
constexpr double upright = 1e-7;         ///< change of s along a branch at one value of the parameter
constexpr std::size_t most_passed = 6;   ///< points that predict the next one
constexpr int longest_crawl = 10;        ///< points in tiny steps along a very unstable cycle

/// One direction of a branch, from a solved first spot.
class Walk {
 public:
  Walk(BranchMap& map, BranchSolver& solver, const ContinuationOptions& options, BranchSpot first, double direction)
      : map_(map), solver_(solver), options_(options), now_(std::move(first)), s0_(now_.s()) {
    if (now_.tangent(now_.tangent.size() - 1) * direction < 0.0) now_.tangent = -now_.tangent;
    start_ = now_.cycle;
    pass(true);
    take(now_);
  }

  void run() {
    double h = options_.first_step;
    const long begun = map_.steps();
    while (!ended_) {
      if (map_.stopped()) return finish(Status::interrupted);
      const bool many = std::ssize(branch_.points) > options_.max_points;
      if (many || map_.steps() - begun > options_.max_steps) {
        end_here(many ? "point limit reached" : "step limit reached");
        return finish(Status::max_iterations);
      }
      h = std::clamp(h, options_.min_step, options_.max_step);
      if (leaves_range(h) ? to_border(h) : step(h)) continue;
      h *= 0.4;
      if (map_.stopped()) return finish(Status::interrupted);
      if (h < options_.min_step) give_up(false);
    }
  }

  Branch& branch() { return branch_; }
  bool closed() const { return closed_; }

 private:
  static double ds(const BranchSpot& spot) { return spot.tangent(spot.tangent.size() - 1); }
  double parameter(const BranchSpot& spot) const { return map_.scale().p(spot.s()); }

  void finish(Status status) {
    branch_.status = status;
    ended_ = true;
  }

  /// Predicted position after a step h: along the tangent, or on the polynomial through the last points that agrees
  /// best with the one through one point fewer.
  VectorXd predicted(double h) const {
    VectorXd best = now_.w + h * now_.tangent, shorter = best;
    double agreement = infinite;
    const auto count = std::ssize(passed_);
    for (Index points = 2; points <= count; ++points) {
      VectorXd longer = VectorXd::Zero(now_.w.size());
      for (Index i = count - points; i < count; ++i) {
        double weight = 1.0;
        for (Index j = count - points; j < count; ++j)
          if (j != i) weight *= (length_ + h - at(j).first) / (at(i).first - at(j).first);
        longer += weight * at(i).second;
      }
      const double difference = (longer - shorter).norm();
      if (difference < agreement && points > 2) {
        agreement = difference;
        best = longer;
      }
      shorter = longer;
    }
    return best;
  }
  const std::pair<double, VectorXd>& at(Index i) const { return passed_[static_cast<std::size_t>(i)]; }

  /// Records the position on the branch, in one frame.
  void pass(bool new_frame) {
    if (new_frame) passed_.clear();
    if (!passed_.empty()) length_ += (now_.w - passed_.back().second).norm();
    if (passed_.size() == most_passed) passed_.pop_front();
    passed_.emplace_back(length_, now_.w);
  }

  /// One step along the tangent; h becomes the next one. False: it must be shorter.
  bool step(double& h) {
    auto next = solver_.solve(predicted(h), now_.tangent, now_.jacobian);
    if (!next || collapsed(*next)) return false;
    const double moved = (next->w - now_.w).norm();
    const double turn = next->tangent.dot(now_.tangent);
    if ((turn < sharpest_turn || moved > 1.5 * h) && h > 100.0 * options_.min_step) return false;
    if (moved > longest_jump * h) return false;  // onto another branch
    if (next->s() < 0.0 || next->s() > ParameterScale::length) return false;
    const int iterations = next->iterations;
    if (!accept(std::move(*next), h)) return ended_;
    if (iterations <= 4 && turn > 0.97) h *= 1.6;
    if (iterations >= 7 || turn < 0.9) h *= 0.7;
    return true;
  }

  /// True if every state returns to itself after no time: that solves the equations, but is no cycle.
  bool collapsed(const BranchSpot& next) const {
    return next.cycle.amplitude < 1e-3 * now_.cycle.amplitude && next.cycle.period < 1e-3 * now_.cycle.period;
  }

  bool leaves_range(double h) const {
    const double s = now_.s() + h * ds(now_);
    return s < 0.0 || s > ParameterScale::length;
  }

  /// The point at the end of the range.
  bool to_border(double) {
    const double border = ds(now_) < 0.0 ? 0.0 : ParameterScale::length;
    if (now_.s() == border) {
      end_here("the end of the range is reached");
      return true;
    }
    VectorXd w = now_.w + (border - now_.s()) / ds(now_) * now_.tangent;
    w(w.size() - 1) = border;
    const VectorXd fixed = (ds(now_) < 0.0 ? -1.0 : 1.0) * VectorXd::Unit(w.size(), w.size() - 1);
    auto last = solver_.solve(w, fixed, now_.jacobian);
    if (!last || last->tangent.dot(now_.tangent) < 0.5) return false;
    last->w(w.size() - 1) = border;
    if (accept(std::move(*last), 1.0) && !ended_) end_here("the end of the range is reached");
    return true;
  }

  /// Adds a solved spot to the branch, with the events on the way to it. False: the walk has ended, or an event could
  /// not be located and the step must be shorter.
  bool accept(BranchSpot next, double h) {
    if (!find_events(now_, next)) {
      if (h > 100.0 * options_.min_step) return false;
      branch_.status = Status::incomplete;
    }
    if (ended_) return false;
    if (closes(now_, next)) return false;
    const BranchSpot before = std::move(now_);
    now_ = std::move(next);
    pass(false);
    take(now_);
    if (options_.progress) options_.progress(now_.s() / ParameterScale::length);
    const Cycle& cycle = now_.cycle;
    if (cycle.amplitude < smallest_share * largest_ || cycle.period > longest_share * shortest_ ||
        cycle.amplitude > largest_share * start_.amplitude || crawls(before))
      give_up(true);
    if (ended_ || !solver_.frame_is_worn(now_)) return !ended_;
    if (auto moved = solver_.reframe(now_, &before, ds(now_))) {
      now_ = std::move(*moved);
      pass(true);
    }
    return true;
  }

  /// True on a very unstable cycle: with a multiplier of hundreds, motions leave it at once, and Newton converges from
  /// such a small neighbourhood that the branch cannot be followed in reasonable time.
  bool crawls(const BranchSpot& before) {
    const double moved = std::abs(now_.s() - before.s());
    const bool unstable = !now_.multipliers.empty() && std::abs(now_.multipliers.front()) > 100.0;
    crawl_ = unstable && moved < 1e-2 ? crawl_ + 1 : 0;
    return crawl_ > longest_crawl;
  }

  void take(const BranchSpot& spot) {
    BranchPoint point{parameter(spot), spot.cycle};
    point.cycle.trace = {};
    largest_ = std::max(largest_, point.cycle.amplitude);
    shortest_ = std::min(shortest_, point.cycle.period);
    branch_.points.push_back(std::move(point));
  }

  // --- events -----------------------------------------------------------------------------------------------------

  static std::size_t outside(const BranchSpot& spot) {
    return static_cast<std::size_t>(
        std::ranges::count_if(spot.multipliers, [](const auto& value) { return std::abs(value) > 1.0; }));
  }

  /// False if there is an event that could not be located.
  bool find_events(const BranchSpot& a, const BranchSpot& b) {
    // A branch along which the parameter stays is a family of cycles, which turns back and forth by rounding.
    if (std::min(std::abs(ds(a)), std::abs(ds(b))) < upright) return true;
    if (ds(a) * ds(b) < 0.0) return fold(a, b);  // it explains one multiplier that crosses 1
    const std::size_t before = outside(a), after = outside(b);
    return before == after || stability(a, b, std::max(before, after));
  }

  /// Solves g = 0 on the branch between a and b, where it has opposite signs, by the secant kept in the bracket
  /// (Illinois). Empty if the corrector fails.
  template <class G>
  std::optional<BranchSpot> locate(const BranchSpot& a, const BranchSpot& b, G&& g) {
    double low = 0.0, high = 1.0, g_low = g(a), g_high = g(b);
    std::optional<BranchSpot> best;
    for (int i = 0; i < 50; ++i) {
      double at = (low * g_high - high * g_low) / (g_high - g_low);
      if (!(at > low && at < high)) at = 0.5 * (low + high);
      // A parabola from a along its tangent to b: a good guess, and a point on the chord's plane.
      const VectorXd chord = b.w - a.w;
      const VectorXd along = chord.dot(a.tangent) * a.tangent;
      const VectorXd guess = a.w + at * along + at * at * (chord - along);
      auto spot = solver_.solve(guess, a.tangent, a.jacobian, BranchSolver::Derivatives::precise);
      if (!spot) return std::nullopt;
      const double value = g(*spot);
      best = std::move(spot);
      if (value == 0.0 || std::abs(value) < 1e-9 || high - low < 1e-9) break;
      if (value * g_high < 0.0) {
        low = high;
        g_low = g_high;
      } else {
        g_low *= 0.5;
      }
      const double moved = std::abs(at - high);
      high = at;
      g_high = value;
      if (moved < 1e-8) break;
      if (low > high) {
        std::swap(low, high);
        std::swap(g_low, g_high);
      }
    }
    return best;
  }

  BranchEvent event_at(const BranchSpot& spot, BranchEvent::Type type, std::string why) const {
    BranchEvent event;
    event.type = type;
    event.parameter = parameter(spot);
    event.period = spot.cycle.period;
    event.amplitude = spot.cycle.amplitude;
    event.point = branch_.points.size();
    event.why = std::move(why);
    return event;
  }

  double relative_error(double s_error, double s) const {
    const double p = map_.scale().p(s);
    return std::abs(map_.scale().slope(s)) * s_error / (p != 0.0 ? std::abs(p) : 1.0);
  }

  void add(const BranchSpot& spot, BranchEvent event, double s_error) {
    event.error = relative_error(s_error, spot.s());
    branch_.events.push_back(std::move(event));
    take(spot);
    branch_.points.back().cycle.stable.reset();  // on the border
    if (options_.until_event) finish(Status::converged);
  }

  bool fold(const BranchSpot& a, const BranchSpot& b) {
    auto spot = locate(a, b, [](const BranchSpot& at) { return ds(at); });
    if (!spot) return false;
    const std::size_t before = outside(a), after = outside(b);
    const std::string side = before < after ? "; the cycle is less stable beyond it" : "";
    // Off the extremum by d sigma, the parameter is off by ds * d sigma / 2, of which the first factor is left over.
    const double rise = std::max(std::abs(spot->s() - a.s()), std::abs(spot->s() - b.s()));
    if (rise < 1e2 * std::max({spot->s_error, a.s_error, b.s_error, 1e-10})) return true;  // upright but for rounding
    const double left = ds(*spot) * (b.w - a.w).norm() * std::abs(ds(*spot)) / std::max(std::abs(ds(a) - ds(b)), 1e-12);
    add(*spot,
        event_at(*spot, BranchEvent::Type::fold,
                 "the branch turns back: a stable and an unstable cycle, or two unstable ones, merge" + side),
        spot->s_error + std::abs(left));
    return true;
  }

  bool stability(const BranchSpot& a, const BranchSpot& b, std::size_t rank) {
    const auto radius = [rank](const BranchSpot& at) {
      return rank <= at.multipliers.size() ? std::log(std::max(std::abs(at.multipliers[rank - 1]), 1e-12)) : -30.0;
    };
    auto spot = locate(a, b, radius);
    if (!spot) return false;
    const std::complex<double> mu = spot->multipliers[rank - 1];
    std::string what = "a pair of complex multipliers crosses the unit circle (onto a torus)";
    if (std::abs(mu.imag()) < 1e-6)
      what = mu.real() > 0.0     ? "a multiplier crosses +1 away from a fold (branches cross)"
             : map_.frame().half ? "a multiplier of the half period crosses -1: the cycle loses its symmetry (a pair "
                                   "of asymmetric cycles appears; the multiplier of the period crosses +1)"
                                 : "a multiplier crosses -1 (period doubling)";
    const double slope = std::abs(radius(b) - radius(a)) / (b.w - a.w).norm();
    const double left = std::abs(radius(*spot)) / slope + 10.0 * spot->orbit_error / slope;
    add(*spot,
        event_at(*spot, BranchEvent::Type::stability,
                 what + (radius(b) > 0.0 ? ": stability is lost" : ": stability is gained")),
        spot->s_error + std::abs(ds(*spot)) * left);
    return true;
  }

  // --- ends -------------------------------------------------------------------------------------------------------

  /// Clause about cycles of many sizes at the last value.
  std::string family_at_end() const {
    constexpr double same = 1e-8;
    constexpr int many = 5;
    const auto& points = branch_.points;
    int count = 0;
    double low = infinite, high = 0.0;
    for (auto point = points.rbegin(); point != points.rend(); ++point, ++count) {
      if (std::abs(point->parameter / points.back().parameter - 1.0) > same) break;
      low = std::min(low, point->cycle.amplitude);
      high = std::max(high, point->cycle.amplitude);
    }
    if (count < many || high < 1.001 * low) return "";
    return "; at this value there are cycles of any amplitude from " + short_number(low, 4) + " to " +
           short_number(high, 4);
  }

  void end_here(std::string why) {
    BranchEvent event = event_at(now_, BranchEvent::Type::end, std::move(why) + family_at_end());
    event.point = branch_.points.size() - 1;
    branch_.events.push_back(std::move(event));
    ended_ = true;
  }

  /// True if the branch is back at its start.
  bool closes(const BranchSpot& a, const BranchSpot& b) {
    if (branch_.points.size() < 6 || (a.s() - s0_) * (b.s() - s0_) > 0.0) return false;
    const auto near = [](double x, double y) { return std::abs(x / y - 1.0) < 0.3; };
    if (!near(b.cycle.period, start_.period) || !near(b.cycle.amplitude, start_.amplitude)) return false;
    VectorXd w = a.w + (s0_ - a.s()) / (b.s() - a.s()) * (b.w - a.w);
    const Index m = w.size() - 1;
    auto spot = solver_.solve(w, (b.s() < a.s() ? -1.0 : 1.0) * VectorXd::Unit(m + 1, m), a.jacobian);
    if (!spot) return false;
    const double tolerance = 1e-6 + 10.0 * (spot->cycle.error + start_.error);
    if (std::abs(spot->cycle.period / start_.period - 1.0) > tolerance ||
        std::abs(spot->cycle.amplitude / start_.amplitude - 1.0) > tolerance)
      return false;
    now_ = std::move(*spot);
    take(now_);
    end_here("closed branch: it returns to its start");
    closed_ = true;
    return true;
  }

  /// Removes changes of stability just before an end that is no event, and the points behind them. Where a motion
  /// begins to stick or to switch a branch turns at a corner: what Newton's method finds beyond it within its own
  /// accuracy has the multipliers of the other side. True if there were any.
  bool leave_out_corner(double end) {
    constexpr double narrow = 1e-5;
    bool any = false;
    while (!branch_.events.empty() && branch_.events.back().type == BranchEvent::Type::stability &&
           branch_.events.back().point > 0 && std::abs(branch_.events.back().parameter / end - 1.0) < narrow) {
      branch_.points.erase(branch_.points.begin() + static_cast<std::ptrdiff_t>(branch_.events.back().point),
                           branch_.points.end());
      branch_.events.pop_back();
      any = true;
    }
    return any;
  }

  void give_up(bool on_purpose) {
    EndEvidence evidence;
    for (std::size_t i = 0; i < std::min<std::size_t>(100, branch_.points.size()); ++i)
      evidence.last.push_back(&branch_.points[branch_.points.size() - 1 - i]);
    evidence.direction = ds(now_) < 0.0 ? -1.0 : 1.0;
    evidence.largest_amplitude = largest_;
    evidence.shortest_period = shortest_;
    evidence.failure = solver_.failure();
    evidence.invalid = solver_.invalid();
    evidence.first_amplitude = start_.amplitude;
    evidence.on_purpose = on_purpose;
    EndDiagnosis found = diagnose_end(map_, now_, evidence);
    if (!found.understood && leave_out_corner(found.parameter))
      found.why =
          "the branch turns at a corner, where the motion begins to stick or to switch (the last of it, within "
          "the accuracy of that, is left out)";
    end_here(found.why);
    branch_.events.back().parameter = found.parameter;
    branch_.events.back().error = found.error;
    if (!found.understood) branch_.status = Status::incomplete;
  }

  BranchMap& map_;
  BranchSolver& solver_;
  const ContinuationOptions& options_;
  BranchSpot now_;
  std::deque<std::pair<double, VectorXd>> passed_;  ///< arclength and place of the last points in this frame
  double length_ = 0.0;
  Cycle start_;
  double s0_;
  Branch branch_;
  double largest_ = 0.0, shortest_ = infinite;
  int crawl_ = 0;
  bool ended_ = false, closed_ = false;
};

}  // namespace

Branch walk_branch(BranchMap& map, BranchSolver& solver, const ContinuationOptions& options, const BranchSpot& first,
                   double direction, bool& closed) {
  Walk walk(map, solver, options, first, direction);
  walk.run();
  closed = walk.closed();
  return std::move(walk.branch());
}

}  // namespace limcycle
