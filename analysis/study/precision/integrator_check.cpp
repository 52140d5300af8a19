#include "limcycle/analysis/study/precision/integrator_check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/study/precision/work_precision.hpp"

namespace limcycle {
namespace {

constexpr std::size_t most_candidates = 2000;  // a stepper at its limit of stability may reverse y at every step
constexpr int refined = 12;

/// A step within which y turns.
struct Turn {
  Step step;
  std::vector<Mode> modes;  ///< at its beginning
  double y;                 ///< by the cubic
};

class Run {
 public:
  Run(const Loop& loop, const Cycle& cycle, const State& sizes, const IntegratorCheckOptions& options)
      : loop_(loop),
        cycle_(cycle),
        sizes_(sizes),
        options_(options),
        field_(loop),
        march_(field_, options.stepper, loop_weights(loop, options.rtol)),
        section_(choose_section(loop, cycle.trace)),
        returns_(static_cast<std::size_t>(returns_of(section_, cycle.trace))) {}

  IntegratorCheck operator()() {
    field_.modes() = cycle_.start.modes;
    march_.begin(cycle_.start.x, 0.0, section_);
    const double end = options_.periods * cycle_.period;
    low_ = high_ = field_.y(cycle_.start.x);
    while (march_.t() < end && go_on(end)) {
    }
    run_.steps = march_.steps();
    if (run_.status != Status::converged) return run_;
    compare_states();
    measure_period();
    const double begin = cpu_seconds();
    measure_amplitude();
    run_.measuring = cpu_seconds() - begin;
    return run_;
  }

 private:
  /// On a cycle every period costs about the same, as does each half of a half-wave symmetric one: the first shows if
  /// all of them fit into the step limit.
  bool too_dear() const {
    constexpr long worth_a_guess = 10000;
    constexpr double uneven = 1.5;
    if (march_.steps() >= options_.max_steps) return true;
    if (march_.steps() < worth_a_guess) return false;
    const int parts = cycle_.half_wave_symmetric ? 2 : 1;
    const double share = (std::floor(parts * march_.t() / cycle_.period) + 1.0) / (parts * options_.periods);
    return static_cast<double>(march_.steps()) > uneven * share * static_cast<double>(options_.max_steps);
  }

  bool go_on(double end) {
    if (too_dear()) {
      run_.gave_up = true;
      run_.status = Status::max_iterations;
      return false;
    }
    if (options_.stop && march_.steps() % 256 == 0 && options_.stop()) run_.status = Status::interrupted;
    const bool last_period = march_.t() > end - 1.02 * cycle_.period;
    if (last_period) modes_ = field_.modes();
    if (run_.status == Status::converged) run_.status = march_.step(end);
    if (run_.status != Status::converged) return false;
    if (march_.last().on_section) crossings_.push_back(march_.t());
    if (last_period) watch_turn();
    return true;
  }

  void watch_turn() {
    const Step& step = march_.last();
    const double y0 = field_.y(step.x0), y1 = field_.y(step.x1);
    low_ = seen_ ? std::min({low_, y0, y1}) : std::min(y0, y1);
    high_ = seen_ ? std::max({high_, y0, y1}) : std::max(y0, y1);
    seen_ = true;
    if (field_.y_rate(step.dx0) * field_.y_rate(step.dx1) >= 0.0 || turns_.size() >= most_candidates) return;
    turns_.push_back({step, modes_, 0.5 * (y0 + y1)});
  }

  void compare_states() {
    double worst = 0.0;
    for (std::size_t i = 0; i < sizes_.size(); ++i)
      if (sizes_[i] > 0.0) worst = std::max(worst, std::abs(march_.x()[i] - cycle_.start.x[i]) / sizes_[i]);
    run_.state_error = worst;
  }

  void measure_period() {
    if (crossings_.size() < 3 * returns_) return;
    const std::size_t count = crossings_.size() - returns_, from = count / 2;
    double least = infinite, most = 0.0, sum = 0.0;
    for (std::size_t i = from; i < count; ++i) {
      const double period = crossings_[i + returns_] - crossings_[i];
      least = std::min(least, period);
      most = std::max(most, period);
      sum += period;
    }
    run_.period = sum / static_cast<double>(count - from);
    run_.spread = (most - least) / run_.period;
    run_.periodic = true;
  }

  /// Only the largest and smallest turns matter; they are located by marches.
  void measure_amplitude() {
    for (const double side : {1.0, -1.0}) {
      std::ranges::sort(turns_, [&](const Turn& a, const Turn& b) { return side * a.y > side * b.y; });
      double& extreme = side > 0.0 ? high_ : low_;
      for (std::size_t i = 0; i < turns_.size() && i < static_cast<std::size_t>(refined); ++i) {
        const double y = value_at(turns_[i]);
        if (std::isfinite(y) && side * y > side * extreme) extreme = y;
      }
    }
    run_.amplitude = 0.5 * (high_ - low_);
  }

  /// y at its turn: by secant steps on its rate, each a march of its own from the beginning of the step.
  double value_at(const Turn& turn) {
    const double t0 = turn.step.t0, t1 = turn.step.t1;
    double a = t0, b = t1, ra = field_.y_rate(turn.step.dx0), rb = field_.y_rate(turn.step.dx1), y = turn.y;
    for (int k = 0; k < 4; ++k) {
      const double t = std::clamp(a - ra * (b - a) / (rb - ra), std::min(a, b), std::max(a, b));
      LoopField field(loop_);
      field.modes() = turn.modes;
      March march(field, options_.stepper, loop_weights(loop_, options_.rtol));
      march.begin(turn.step.x0, t0);
      for (int n = 0; march.t() < t && n < 1000; ++n)
        if (march.step(t) != Status::converged) return y;
      State dx;
      field.rate(march.x(), dx, march.t());
      const double rate = field.y_rate(dx), bend = (rb - ra) / (b - a);
      const double here = field.y(march.x());
      if (!std::isfinite(here)) return y;
      y = bend != 0.0 ? here - 0.5 * rate * rate / bend : here;  // the parabola through the located point
      if (rate == 0.0 || std::abs(rate) < 1e-9 * std::abs(rb - ra)) break;
      if ((rate > 0.0) == (ra > 0.0)) {
        a = t;
        ra = rate;
      } else {
        b = t;
        rb = rate;
      }
    }
    return y;
  }

  const Loop& loop_;
  const Cycle& cycle_;
  const State& sizes_;
  const IntegratorCheckOptions& options_;
  LoopField field_;
  March march_;
  Section section_;
  std::size_t returns_;
  IntegratorCheck run_;
  std::vector<double> crossings_;
  std::vector<Turn> turns_;
  std::vector<Mode> modes_;
  double low_ = 0.0, high_ = 0.0;
  bool seen_ = false;
};

}  // namespace

State sizes_on_cycle(const Loop& loop, const Cycle& cycle) {
  State sizes(static_cast<std::size_t>(loop.states()), 0.0);
  LoopField field(loop);
  field.modes() = cycle.start.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-6));
  march.limit_step(cycle.period / 200.0);
  march.begin(cycle.start.x, 0.0);
  while (march.t() < cycle.period && march.step(cycle.period) == Status::converged)
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::max(sizes[i], std::abs(march.x()[i]));
  return sizes;
}

IntegratorCheck check_integrator(const Loop& loop, const Cycle& cycle, const State& sizes,
                                 const IntegratorCheckOptions& options) {
  if (options.periods < 4) throw std::invalid_argument("a run over a cycle needs at least 4 periods");
  return Run(loop, cycle, sizes, options)();
}

}  // namespace limcycle
