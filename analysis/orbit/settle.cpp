#include "limcycle/analysis/orbit/settle.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/measure.hpp"
#include "limcycle/analysis/orbit/rest_watch.hpp"
#include "limcycle/analysis/orbit/turning_points.hpp"

namespace limcycle {
namespace {

/// One run: simulation, and shooting whenever the swings look steady.
class Settling {
 public:
  Settling(const Loop& loop, LoopState start, const SettleOptions& options)
      : loop_(loop),
        options_(options),
        start_(std::move(start)),
        field_(loop),
        march_(field_, StepperKind::automatic, loop_weights(loop, options.rtol)),
        rest_(typical_sizes(loop), slow_time(loop), options.rtol) {}

  Settled run() {
    field_.modes() = start_.modes;
    march_.begin(start_.x, 0.0);
    note();
    while (!decided_) step();
    result_.time = march_.t();
    result_.steps = march_.steps();
    return std::move(result_);
  }

 private:
  void decide(Outcome outcome, std::string why) {
    result_.outcome = outcome;
    result_.why = std::move(why);
    decided_ = true;
  }

  void note() {
    field_.rate(march_.x(), dx_, march_.t());
    append(result_.trace, field_, march_.x(), dx_, march_.t());
  }

  void step() {
    if (options_.stop && options_.stop()) return decide(Outcome::undecided, "interrupted");
    if (march_.steps() > options_.max_steps)
      return decide(Outcome::undecided, "neither rest nor a cycle was recognised within the step budget");
    const Status status = march_.step(1e15);
    if (status == Status::not_finite) return decide(Outcome::divergence, "the state left the range of numbers");
    if (status != Status::converged)
      return decide(Outcome::undecided, "the simulation ended with status " + std::string(to_string(status)));
    note();
    const double y = result_.trace.y.back();
    if (std::abs(y) > options_.amplitude_ceiling) return decide(Outcome::divergence, "y grew beyond all bounds");
    if (march_.t() >= 1e15) return decide(Outcome::undecided, "nothing was decided within 1e15 s");
    if (turning_.feed(march_.t(), y)) look_at_swings();
    if (decided_) return;
    const auto verdict = rest_.look(march_.t(), march_.x(), dx_);
    if (verdict == RestWatch::Verdict::at_rest)
      return decide(slides_at_rest(loop_) ? Outcome::sliding : Outcome::rest, "all rates died out, but for noise");
    if (verdict == RestWatch::Verdict::steady && std::abs(result_.trace.velocity.back()) > rubbing_speed(loop_))
      decide(Outcome::sliding, "the body slides at constant speed");
  }

  void look_at_swings() {
    const auto& points = turning_.points();
    if (points.size() < 5) return;
    bool exact = false;
    const double rest = loop_.C_y.dot(loop_.rest_point(exact).transpose());
    if (exact && died_out(turning_, rest, options_.amplitude_floor)) {
      return decide(slides_at_rest(loop_) ? Outcome::sliding : Outcome::rest,
                    "the swings decayed below the smallest amplitude of interest");
    }
    if (points.size() < next_try_) return;
    for (std::size_t order : {2U, 4U, 6U})  // turning points per period
      if (points.size() > 2 * order && steady(order) && try_cycle(order)) return;
  }

  /// Do the last swings repeat those one period (of `order` turning points) before, to within 5 %?
  bool steady(std::size_t order) const {
    for (std::size_t k = 0; k < order; ++k)
      if (std::abs(turning_.swing(k) / turning_.swing(k + order) - 1.0) > 0.05) return false;
    return true;
  }

  /// The part of the trace since the turning point `count` back.
  Trace recent(std::size_t count) const {
    const auto& points = turning_.points();
    const double since = points[points.size() - 1 - count].t;
    Trace part;
    for (std::size_t i = 0; i < result_.trace.t.size(); ++i) {
      if (result_.trace.t[i] < since) continue;
      part.t.push_back(result_.trace.t[i]);
      part.y.push_back(result_.trace.y[i]);
      part.rate.push_back(result_.trace.rate[i]);
    }
    return part;
  }

  /// Does the motion from here return with the period of a known cycle of this swing?
  std::optional<std::size_t> recognised(const LoopState& here, double swing) const {
    for (std::size_t i = 0; i < options_.known.size(); ++i) {
      const Cycle& cycle = options_.known[i];
      if (std::abs(2.0 * cycle.amplitude / swing - 1.0) > 0.02) continue;
      const Section section = choose_section(loop_, cycle.trace);
      ReturnMap map(loop_, section, std::nullopt,
                    {options_.rtol, options_.shooting.max_steps_per_map, options_.stop, false, infinite,
                     returns_of(section, cycle.trace)});
      auto at = map.approach(here);
      for (int k = 0; k < 4 && at.status == Status::converged; ++k) {
        at = map(at.state);
        if (at.status != Status::converged || std::abs(at.time / cycle.period - 1.0) > 1e-4) continue;
        Trace again;
        if (record(loop_, at.state, cycle.period, options_.rtol, 200, again) != Status::converged) break;
        const auto [low, high] = extremes(again);
        if (std::abs((high - low) / (2.0 * cycle.amplitude) - 1.0) < 1e-4) return i;
      }
    }
    return std::nullopt;
  }

  /// Swings that are still uneven may show several periods as one: takes the least one that the orbit has.
  void shorten(ShootingResult& shot, const Section& section, bool half, const ShootingOptions& options) const {
    for (int fewer = 1; fewer < options.returns; ++fewer) {
      if (options.returns % fewer != 0) continue;
      ShootingOptions shorter = options;
      shorter.returns = fewer;
      shorter.warm_maps = 0;
      auto found = shoot(loop_, shot.cycle.start, section, half, shorter);
      const double times = static_cast<double>(options.returns) / fewer;
      if (found.status != Status::converged || std::abs(times * found.cycle.period / shot.cycle.period - 1.0) > 1e-6)
        continue;
      shot = std::move(found);
      return;
    }
  }

  bool try_cycle(std::size_t order) {
    next_try_ = turning_.points().size() + turning_.points().size() / 2 + 1;
    const Trace period = recent(order);
    const auto [low, high] = extremes(period);
    const double swing = high - low;
    const LoopState here{march_.x(), field_.modes()};
    result_.known = recognised(here, swing);
    if (result_.known) {
      decide(Outcome::cycle, "the motion repeats itself with the period and swing of a known cycle");
      return true;
    }
    const auto reflection = symmetry(loop_);
    const double middle = reflection ? (loop_.C_y * reflection->centre).value() : 0.0;
    const bool half = reflection && order % 4 == 2 && std::abs(0.5 * (low + high) - middle) < 0.02 * swing;
    ShootingOptions shooting = options_.shooting;
    shooting.max_maps = std::min(shooting.max_maps, 80);
    shooting.longest_map = 10.0 * (period.t.back() - period.t.front());
    const Section section = choose_section(loop_, period);
    shooting.returns = returns_of(section, period);
    auto shot = shoot(loop_, here, section, half, shooting);
    if (shot.status == Status::converged) shorten(shot, section, half, shooting);
    if (shot.status == Status::interrupted) decide(Outcome::undecided, "interrupted");
    if (shot.status != Status::converged || shot.cycle.stable == false) return false;
    const double mismatch = std::abs(2.0 * shot.cycle.amplitude / swing - 1.0);
    if (!shot.cycle.stable && mismatch < 0.01) {
      decide(Outcome::undecided, "periodic, but one of a family of periodic motions (multiplier 1): no limit cycle");
      return true;
    }
    // Far from the cycle yet, but nearer to it than at the last try: a slow approach.
    const bool nearer =
        candidate_ && std::abs(candidate_->period / shot.cycle.period - 1.0) < 1e-6 && mismatch < 0.8 * mismatch_;
    if (!shot.cycle.stable || (mismatch > 0.1 && !nearer)) {
      candidate_ = shot.cycle;
      mismatch_ = mismatch;
      return false;
    }
    result_.shot = std::move(shot);
    decide(Outcome::cycle, nearer ? "the motion approaches a cycle that shooting confirms"
                                  : "the motion repeats itself and shooting confirms it");
    return true;
  }

  const Loop& loop_;
  const SettleOptions& options_;
  LoopState start_;
  LoopField field_;
  March march_;
  RestWatch rest_;
  TurningPoints turning_;
  Settled result_;
  State dx_;
  std::optional<Cycle> candidate_;
  double mismatch_ = 0.0;
  std::size_t next_try_ = 5;
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
