#include "limcycle/analysis/orbit/settle/settle.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/motion/parallel.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/settle/displaced.hpp"
#include "limcycle/analysis/orbit/settle/drift.hpp"
#include "limcycle/analysis/orbit/settle/growth.hpp"
#include "limcycle/analysis/orbit/settle/irregular.hpp"
#include "limcycle/analysis/orbit/settle/to_cycle/cycle_tries.hpp"
#include "limcycle/analysis/orbit/settle/to_cycle/locked_cycle.hpp"
#include "limcycle/analysis/orbit/settle/wait_on_bristles.hpp"
#include "limcycle/analysis/orbit/settle/watch/swings.hpp"
#include "limcycle/analysis/orbit/settle/watch/switching_watch.hpp"
#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"
#include "limcycle/analysis/orbit/settle/watch/wind_up_watch.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Step limit of shooting before a motion is decided: this constant, plus a multiple of the motion's own steps.
constexpr long steps_of_tries = 200'000, tries_per_step = 3;
/// The same for a sampled loop, most cycles of which are not locked: this constant, plus a part of its steps.
constexpr long steps_of_sampled_tries = 10'000, sampled_steps_per_try = 8;
constexpr long most_sampled_steps = 4'000'000;
constexpr long most_leapt_steps = 1'000'000;
constexpr double large_swing =
    0.05;  ///< of the range of y and the rest: a swing below it may be the ringing of a bristle
constexpr std::size_t enough_turns = 12;  ///< for a cycle to be recognised
constexpr int most_restarts = 3;          ///< with short steps, of a march that left the range of numbers

/// One run: simulation, and shooting whenever the swings look steady.
class Settling {
 public:
  Settling(const Loop& loop, LoopState start, const SettleOptions& options)
      : loop_(loop),
        options_(options),
        start_(std::move(start)),
        field_(loop),
        march_(field_, StepperKind::automatic, loop_weights(loop, options.rtol)),
        stillness_(loop, typical_sizes(loop), slow_time(loop), options.rtol),
        switching_(loop, loop_sizes(loop)),
        wind_up_(loop),
        rubs_elsewhere_(loop.ports.back().rubs && !loop.continuous && !parallel(loop.ports.back().C, loop.C_y)),
        tries_(loop, options) {}

  Settled run() {
    field_.modes() = start_.modes;
    march_.begin(start_.x, 0.0);
    note();
    bool exact = false;
    const double rest = loop_.C_y.dot(loop_.rest_point(exact).transpose());
    if (exact) low_ = high_ = rest;
    while (!decided_) step();
    result_.time = march_.t();
    result_.steps = march_.steps();
    result_.work = tries_.steps() + tried_ + leapt_ + march_.steps();
    result_.passed = tries_.passed();
    return std::move(result_);
  }

 private:
  void decide(Outcome outcome, std::string why) {
    result_.outcome = outcome;
    result_.why = std::move(why) + waited_;
    decided_ = true;
  }

  void note() {
    const bool by_clock = march_.last().by_clock;
    if (!by_clock) append(result_.trace, field_, march_);
    field_.rate(march_.x(), dx_, march_.t());
    if (!by_clock || waits()) return;
    const bool bends = field_.y_rate(dx_) != field_.y_rate(march_.last().dx1);
    if (bends) append(result_.trace, field_, march_.x(), march_.last().dx1, march_.t());
    append(result_.trace, field_, march_.x(), dx_, march_.t());
  }

  /// True if nothing moved since the last reading of a sampled controller: a trace of every sample is long.
  bool waits() const { return field_.y(march_.x()) == result_.trace.y.back() && field_.y_rate(dx_) == 0.0; }

  void step() {
    if (options_.stop && options_.stop()) return decide(Outcome::undecided, "interrupted");
    if (own_steps() > options_.max_steps && own_steps() > horizon()) {
      look_for_growth();
      if (decided_) return;
      if (const auto why_not = look_for_irregular(); !decided_) decide(Outcome::undecided, std::string(why_not));
      return;
    }
    const Status status = march_.step(1e15);
    // At rest steps grow until one of them leaves the range of numbers; a motion that grows passes the ceiling first.
    if (status == Status::not_finite && restarts_++ < most_restarts) return march_.begin(march_.x(), march_.t());
    if (status == Status::not_finite) return decide(Outcome::divergence, "the state left the range of numbers");
    if (status == Status::chattering) {
      field_.rate(march_.x(), dx_, march_.t());
      if (auto still = stillness_.within_rounding(dx_)) return come_to(*still);
    }
    if (status != Status::converged)
      return decide(Outcome::undecided, "the simulation ended with status " + std::string(to_string(status)));
    note();
    const double y = result_.trace.y.back();
    if (std::abs(y) > options_.amplitude_ceiling) return decide(Outcome::divergence, "y grows without bound");
    if (march_.t() >= 1e15) return after_longest_time();
    low_ = std::min(low_, y);
    high_ = std::max(high_, y);
    if (of_y_.turning.feed(march_.t(), y)) {
      if (turning_.points().size() > 1 && turning_.swing(0) > large_swing * (high_ - low_)) ++large_turns_;
      look_at_swings();
    }
    // Between its swings a body may stick for long while it rings.
    if (!decided_ && of_large_.turning.feed(march_.t(), y) &&
        of_large_.turning.points().size() < turning_.points().size())
      look_for_cycle(of_large_);
    if (!decided_ && rubs_elsewhere_ && of_rubbing_.turning.feed(march_.t(), rubbing())) look_for_cycle(of_rubbing_);
    if (decided_) return;
    if (auto still = stillness_.look(march_.t(), march_.x(), dx_, field_.modes())) come_to(*still);
    if (decided_ || !march_.last().switched) return;
    if (march_.last().crept && stillness_.within_rounding(dx_)) return decide(Outcome::rest, "came to rest");
    if (march_.last().by_clock) return read();
    if (auto still = stillness_.switched(march_.t(), march_.x(), dx_)) return come_to(*still);
    if (auto still = switching_.switched(field_, march_.x(), march_.t(), *march_.last().switched)) come_to(*still);
  }

  /// A body that is held for 1e15 s rests, whatever winds up.
  void after_longest_time() {
    if (is_stuck(field_) && field_.y_rate(dx_) == 0.0) return decide(Outcome::rest, "held at rest for 1e15 s");
    decide(Outcome::undecided, "undecided after 1e15 s");
  }

  /// After the clock of a sampled controller has switched.
  void read() {
    ++readings_;
    if (auto still = stillness_.read(march_.t(), march_.x(), field_)) return come_to(*still);
    if (const auto end = wind_up_.read(march_.t(), field_); end && *end > 2.0 * march_.t() && wait()) return;
    if (readings_ <= options_.max_readings) return;
    look_for_irregular();
    if (!decided_)
      decide(Outcome::undecided, "undecided after " + std::to_string(options_.max_readings) + " clock switches");
  }

  /// True if a long wait on bristles was followed without its samples.
  bool wait() {
    const auto waited = wait_on_bristles(loop_, {march_.x(), field_.modes()}, wind_up_.rubs(), options_.rtol,
                                         options_.max_steps, options_.stop);
    if (!waited) return false;
    tried_ += waited->steps;
    const std::string with = " with the continuous controller";
    if (waited->still) {
      decide(waited->still->outcome, "held while the controller winds up, and " + waited->still->why + with);
      return true;
    }
    waited_ = ", after a wait of " + short_number(waited->time, 2) + " s that was followed" + with;
    field_.modes() = waited->resume->modes;
    march_.begin(waited->resume->x, march_.t() + waited->time);
    note();
    return true;
  }

  /// Readings of a sampled controller in that time.
  long samples_in(double time) const { return loop_.continuous ? std::lround(time / sample_time(loop_)) : 0; }

  /// Steps that the motion itself took since it last leapt: a clock cuts even a long wait into many.
  long own_steps() const { return march_.steps() - steps_at_leap_ - readings_; }

  /// The step limit, or more for a motion that has not turned often enough, or not lasted long enough for a known
  /// cycle, to be judged: bristles that ring while the body sticks may take 30,000 steps between two of its turns.
  long horizon() const {
    constexpr long longer = 4;
    constexpr double periods = 6.0;
    const auto may_be = [&](const Cycle& cycle) { return march_.t() < periods * cycle.period; };
    if (loop_.continuous) return most_sampled_steps;  // a stiff bristle takes many after every sample
    // An exact march takes few steps a turn, so that its turns are many before its steps are.
    const bool exact = march_.kind() == StepperKind::exact;
    const std::size_t fewest = exact ? std::min(options_.fewest_turns, enough_turns) : options_.fewest_turns;
    const bool early = large_turns_ < fewest || std::ranges::any_of(options_.known, may_be);
    return early && options_.fewest_turns > 0 ? longer * options_.max_steps : options_.max_steps;
  }

  /// The permanent motion that was followed so far, if it looks like one.
  std::optional<IrregularMotion> motion_so_far() const {
    const bool sampled = loop_.continuous != nullptr;
    // A wait before the first swing, of an integrator that has to wind up, is no part of the motion.
    const std::size_t turns = turning_.points().size();
    const Trace trace = sampled && turns > 4 ? recent(turning_, turns - 2) : since(begin_);
    return permanent_motion(trace, sampled, fewest_returns());
  }

  /// In each part of a permanent motion.
  long fewest_returns() const {
    constexpr std::size_t many_turns = 128;
    return loop_.continuous && turning_.points().size() < many_turns ? 2 : 8;
  }

  /// Decides for that motion of another start in whose range it is.
  bool is_known_irregular(const IrregularMotion& motion) {
    const auto known = [&](const IrregularMotion& other) { return agree(other, motion); };
    if (std::ranges::none_of(options_.known_irregular, known)) return false;
    come_to(motion, "bounded without a period, in the range of another start");
    return true;
  }

  /// Decides for a permanent motion without a period, if two tolerances give the same numbers; else the reason why not.
  std::string_view look_for_irregular() {
    const bool sampled = loop_.continuous != nullptr;
    if (!sampled && drifts(turning_)) return "step limit reached while the motion still drifted";
    const auto motion = motion_so_far();
    if (motion && is_known_irregular(*motion)) return {};
    // An exact march has no tolerance that could be another.
    const bool exact = march_.kind() == StepperKind::exact;
    const auto again = motion && !exact ? permanent_motion(repeated(march_.t()), sampled, fewest_returns()) : motion;
    if (!motion || !again || !agree(*motion, *again))
      return motion ? "bounded, but its range differs between two tolerances"
                    : "step limit reached before rest or a cycle was recognised";
    come_to(*again,
            exact ? "bounded without a period" : "bounded without a period; a second tolerance gives the same range");
    return {};
  }

  /// The same run with a tighter tolerance.
  Trace repeated(double until) const {
    // The samples that the second run has to follow are as many; ten times as tight shows what depends on it.
    const double tighter = loop_.continuous ? 0.1 : 0.01;
    constexpr double tightest = 1e-12;
    constexpr long longer = 10;  // limit of the steps, relative to those of the first run
    LoopField field(loop_);
    field.modes() = start_.modes;
    March march(field, march_.kind(), loop_weights(loop_, std::max(tightest, tighter * options_.rtol)));
    march.begin(start_.x, begin_);
    Trace trace;
    while (march.t() < until && march.steps() < longer * std::max(options_.max_steps, march_.steps())) {
      if (options_.stop && options_.stop()) break;
      if (march.step(until) != Status::converged) break;
      trace.t.push_back(march.t());
      trace.y.push_back(field.y(march.x()));
      trace.rate.push_back(field.y_rate(march.last().dx1));
    }
    return trace;
  }

  void come_to(const IrregularMotion& motion, std::string why) {
    result_.irregular = motion;
    if (loop_.continuous) result_.irregular.beat_frequency = beat_frequency(motion, repetition_time(loop_));
    decide(Outcome::irregular, std::move(why));
  }

  void come_to(Stillness& still) {
    result_.by = std::move(still.by);
    decide(still.outcome, std::move(still.why));
  }

  void look_for_growth() {
    if (grows_like_a_power(turning_) && grows_from_afar(loop_, {march_.x(), field_.modes()}, turning_.swing(0),
                                                        options_.rtol, options_.max_steps, options_.stop))
      decide(Outcome::divergence, "y grows without bound, like a power of time");
  }

  /// True if a sampled loop, whose cycles need not lock to its samples, has turned often enough since the last look.
  /// Fewer turns are enough of a slow motion, each of which takes many samples and differs little from the others.
  bool time_for_irregular() {
    constexpr std::size_t fewest = 24;
    if (!loop_.continuous) return false;
    const std::size_t turns = turning_.points().size();
    const bool slow = readings_ >= next_readings_ && turns >= fewest;
    if (turns < next_irregular_ && !slow) return false;
    if (turns >= next_irregular_) next_irregular_ *= 2;
    if (slow) next_readings_ *= 2;
    return true;
  }

  /// Decides for a cycle of a sampled loop whose swings repeat themselves after a whole number of samples, if the state
  /// does.
  void look_for_lock() {
    const std::size_t turns = turning_.points().size();
    if (!loop_.continuous || (turns < next_lock_ && turns != next_irregular_)) return;
    next_lock_ = std::max(next_lock_, turns + turns / 2);
    const double samples = std::round(repeat_time(recent(turning_, turns / 2)) / repetition_time(loop_));
    auto shot = locked_cycle(loop_, {march_.x(), field_.modes()}, samples, march_.kind(), options_, tried_);
    if (!shot) return;
    result_.shot = std::move(shot);
    decide(Outcome::cycle, "repeats itself after " + std::to_string(std::lround(samples)) + " samples");
  }

  void look_at_swings() {
    const auto& points = turning_.points();
    if (points.size() < 5) return;
    look_for_lock();
    if (decided_) return;
    if (loop_.continuous && !options_.known_irregular.empty() && points.size() >= next_known_) {
      next_known_ += next_known_ / 2;
      if (const auto motion = motion_so_far(); motion && is_known_irregular(*motion)) return;
    }
    if (time_for_irregular()) {
      look_for_irregular();
      if (decided_) return;
    }
    if (points.size() >= next_growth_) {
      next_growth_ *= 2;
      look_for_growth();
      if (decided_) return;
    }
    bool exact = false;
    const double rest = loop_.C_y.dot(loop_.rest_point(exact).transpose());
    if (exact && died_out(turning_, rest, options_.amplitude_floor)) {
      return decide(slides_at_rest(loop_) ? Outcome::sliding : Outcome::rest,
                    "the oscillation decayed below the smallest amplitude of interest");
    }
    look_for_cycle(of_y_);
  }

  void look_for_cycle(Swings& swings) {
    if (swings.turning.points().size() < swings.next_try) return;
    // A period of more turning points is one only if the swings repeat better with it: those of a slow drift do not.
    double least = 0.05;
    for (std::size_t order : {2U, 4U, 6U}) {
      if (swings.turning.points().size() <= 2 * order) return;
      const double change = largest_change(swings.turning, order);
      if (change > least) continue;
      if (shrinks_to_nothing(swings.turning, order)) {
        swings.try_later();
        return;
      }
      if (try_cycle(swings, order, change)) return;
      least = 0.5 * change;
    }
  }

  /// Displacement of the body that rubs.
  double rubbing() const {
    const Eigen::RowVectorXd& row = loop_.ports.back().C;
    return row.dot(Eigen::Map<const Eigen::RowVectorXd>(march_.x().data(), row.size()));
  }

  /// The part of the trace since the turning point `count` back.
  Trace recent(const TurningPoints& turning, std::size_t count) const {
    const auto& points = turning.points();
    return since(points[points.size() - 1 - count].t);
  }

  Trace since(double begin) const {
    Trace part;
    for (std::size_t i = 0; i < result_.trace.t.size(); ++i) {
      if (result_.trace.t[i] < begin) continue;
      part.t.push_back(result_.trace.t[i]);
      part.y.push_back(result_.trace.y[i]);
      part.rate.push_back(result_.trace.rate[i]);
    }
    return part;
  }

  /// `change`: see largest_change().
  bool try_cycle(Swings& swings, std::size_t order, double change) {
    const long most = loop_.continuous ? steps_of_sampled_tries + march_.steps() / sampled_steps_per_try
                                       : steps_of_tries + tries_per_step * march_.steps();
    if (tried_ + tries_.steps() > most) return false;
    swings.try_later();
    NearlyClosed motion =
        nearly_closed(loop_, {march_.x(), field_.modes()}, recent(swings.turning, order), order, change);
    motion.steps += samples_in(motion.period.t.back() - motion.period.t.front());
    auto found = tries_.look_from(motion);
    if (!found) return leap_on(motion, swings);
    result_.known = found->known;
    result_.shot = std::move(found->shot);
    decide(found->outcome, std::move(found->why));
    return true;
  }

  /// Goes on from where a slow drift leads, if this one can be followed.
  bool leap_on(const NearlyClosed& motion, Swings& swings) {
    constexpr std::size_t soon = 6;
    if (loop_.continuous || !has_settled(motion) || leapt_ > most_leapt_steps) return false;
    Drift drift = follow_drift(loop_, motion, options_.shooting);
    (drift.to ? leapt_ : tried_) += drift.steps;
    if (!drift.to) return false;
    begin_ = march_.t() + drift.time;
    start_ = std::move(*drift.to);
    field_.modes() = start_.modes;
    march_.begin(start_.x, begin_);
    swings.leapt_at = swings.turning.points().size();
    swings.next_try = swings.leapt_at + soon;
    steps_at_leap_ = march_.steps();
    return true;
  }

  const Loop& loop_;
  const SettleOptions& options_;
  LoopState start_;     ///< or the end of the last leap
  double begin_ = 0.0;  ///< time of it
  LoopField field_;
  March march_;
  StillnessWatch stillness_;
  SwitchingWatch switching_;
  WindUpWatch wind_up_;
  /// A body behind a spring may be held for long while y swings on: then its own displacement shows a period.
  Swings of_y_, of_rubbing_, of_large_{TurningPoints(true)};
  const TurningPoints& turning_ = of_y_.turning;
  bool rubs_elsewhere_;
  CycleTries tries_;
  Settled result_;
  std::string waited_;  ///< clause about a wait without samples
  State dx_;
  double low_ = infinite, high_ = -infinite;  ///< of y
  std::size_t large_turns_ = 0;
  std::size_t next_growth_ = 64, next_lock_ = 24;
  std::size_t next_irregular_ = 128;  ///< turns, and samples, of a sampled loop: see time_for_irregular()
  long next_readings_ = 100'000;
  std::size_t next_known_ = 16;         ///< turns at which it is compared with the permanent motions of other starts
  long tried_ = 0;                      ///< steps of drifts that could not be followed
  long leapt_ = 0, steps_at_leap_ = 0;  ///< steps of return maps that made leaps, and of the march at the last
  long readings_ = 0;
  int restarts_ = 0;
  bool decided_ = false;
};

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::rest:
      return "rest";
    case Outcome::sliding:
      return "sliding";
    case Outcome::cycle:
      return "cycle";
    case Outcome::divergence:
      return "divergence";
    case Outcome::family:
      return "family";
    case Outcome::irregular:
      return "irregular";
    default:
      return "undecided";
  }
}

Settled settle(const Loop& loop, const LoopState& start, const SettleOptions& options) {
  if (loop.delay > 0.0)
    throw std::invalid_argument(
        "settle: the loop has a dead time, which a simulation from a state does not know; take "
        "in_time_domain() of it");
  return Settling(loop, start, options).run();
}

}  // namespace limcycle
