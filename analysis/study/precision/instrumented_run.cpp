#include "limcycle/analysis/study/precision/instrumented_run.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {
namespace {

/// Evaluations of the right side that a step of a stepper takes; for the stiff one with its Jacobian and solutions.
int evaluations_per_step(StepperKind kind) {
  switch (kind) {
    case StepperKind::fehlberg78:
      return 13;
    case StepperKind::rodas5p:
      return 20;
    case StepperKind::exact:
      return 10;
    default:
      return 6;
  }
}

constexpr long to_locate = 20;  ///< steps that the location of an event may cost

class Watch {
 public:
  Watch(const Loop& loop, const LoopState& start, const MarchMethod& method, const InstrumentedRunOptions& options)
      : options_(options), method_(method), field_(loop), last_(loop.elements.size() - 1) {
    field_.modes() = start.modes;
    step_.x1 = start.x;
    field_.rate(step_.x1, step_.dx1, 0.0);
    low_ = high_ = field_.y(start.x);
  }

  InstrumentedRun operator()() {
    if (method_.fixed())
      by_fixed_steps();
    else
      by_stepper();
    run_.swing = high_ - low_;
    return std::move(run_);
  }

 private:
  void by_stepper() {
    const auto kind = std::get<StepperKind>(method_.kind);
    ErrorWeights weights = loop_weights(field_.loop(), method_.setting);
    if (method_.plain) std::ranges::fill(weights.atol, method_.setting);
    March march(field_, kind, std::move(weights));
    march.begin(step_.x1, 0.0, options_.section);
    const double budget = steps_allowed(evaluations_per_step(kind));
    while (march.t() < options_.duration &&
           goes_on(static_cast<double>(march.steps() + to_locate * march.events()), budget)) {
      run_.status = march.step(options_.duration);
      run_.steps = march.steps();
      if (run_.status != Status::converged) return;
      if (march.last().on_section) run_.crossings.push_back(march.t());
      look(march.last());
    }
  }

  void by_fixed_steps() {
    const auto kind = std::get<FixedMethod>(method_.kind);
    FixedStepper stepper(field_, kind);
    const double h = method_.setting, budget = steps_allowed(limcycle::evaluations_per_step(kind));
    const auto count = static_cast<long>(std::ceil(options_.duration / h));
    if (static_cast<double>(count) > budget) {  // known in advance
      run_.gave_up = true;
      run_.status = Status::max_iterations;
      return;
    }
    bool armed = false;
    for (long i = 0; i < count && goes_on(static_cast<double>(i), budget); ++i) {
      step_.t0 = h * static_cast<double>(i);
      step_.t1 = h * static_cast<double>(i + 1);
      step_.x0 = step_.x1;
      step_.dx0 = step_.dx1;
      stepper.step(step_.x1, step_.dx1, step_.t0, h);
      run_.steps = i + 1;
      if (!is_finite(step_.x1) || !is_finite(step_.dx1)) {
        run_.status = Status::not_finite;
        return;
      }
      if (armed && options_.section.value(step_.x1) >= 0.0) {
        run_.crossings.push_back(crossing());
        armed = false;
      }
      armed = armed || options_.section.before(step_.x1);
      look(step_);
    }
  }

  /// Evaluations are weighted by the size of the state: four components are one unit.
  double steps_allowed(int per_step) const {
    return options_.evaluations / (per_step * std::max(1.0, static_cast<double>(field_.size()) / 4.0));
  }

  bool goes_on(double cost, double budget) {
    if (cost >= budget) {
      run_.gave_up = true;
      run_.status = Status::max_iterations;
      return false;
    }
    if (options_.stop && run_.steps % 256 == 0 && options_.stop()) run_.status = Status::interrupted;
    return run_.status == Status::converged;
  }

  /// By the cubic through the step.
  double crossing() {
    double from = 0.0, to = 1.0;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (from + to);
      step_.interpolate(middle, work_);
      (options_.section.value(work_) >= 0.0 ? to : from) = middle;
    }
    return step_.t0 + to * (step_.t1 - step_.t0);
  }

  void look(const Step& step) {
    field_.rate(step.x1, work_, step.t1);
    run_.peak = std::max(run_.peak, std::abs(field_.output(last_)));
    const double v = field_.input(last_).v;
    if (v * v_ < 0.0) ++run_.reversals;
    if (v != 0.0) v_ = v;
    const double y = field_.y(step.x1);
    if (step.t1 > options_.duration - options_.last) {
      low_ = seen_ ? std::min(low_, y) : y;
      high_ = seen_ ? std::max(high_, y) : y;
      seen_ = true;
    }
    while (run_.y.size() < options_.samples.size() && options_.samples[run_.y.size()] <= step.t1) {
      const double h = step.t1 - step.t0, at = options_.samples[run_.y.size()];
      if (h > 0.0) step.interpolate(std::clamp((at - step.t0) / h, 0.0, 1.0), work_);
      run_.y.push_back(h > 0.0 ? field_.y(work_) : y);
    }
  }

  const InstrumentedRunOptions& options_;
  const MarchMethod& method_;
  LoopField field_;
  std::size_t last_;
  InstrumentedRun run_;
  Step step_;
  State work_;
  double v_ = 0.0, low_ = 0.0, high_ = 0.0;
  bool seen_ = false;
};

}  // namespace

std::string MarchMethod::name() const {
  return std::string(std::visit([](auto which) { return to_string(which); }, kind)) + (plain ? ", one atol" : "");
}

InstrumentedRun instrumented_run(const Loop& loop, const LoopState& start, const MarchMethod& method,
                                 const InstrumentedRunOptions& options) {
  return Watch(loop, start, method, options)();
}

}  // namespace limcycle
