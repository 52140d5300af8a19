#include "limcycle/analysis/orbit/simulate/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "limcycle/analysis/on_threads.hpp"
#include "limcycle/analysis/orbit/simulate/ensemble_work.hpp"

namespace limcycle {
namespace {

/// The widest kernels of the set that this many members can fill: all give the same numbers.
const LaneKernels& kernels_of(Isa isa, std::size_t members) {
  if (isa == Isa::avx512 && members > 4) return avx512_lane_kernels;
  return isa != Isa::scalar && members > 2 ? avx2_lane_kernels : scalar_lane_kernels;
}

/// One thread at work on a group of loops of one shape.
class LaneRun {
 public:
  LaneRun(EnsembleWork& work, EnsembleGroup& group)
      : work_(work),
        options_(work.options()),
        group_(group),
        kernels_(kernels_of(options_.isa, group.members.size())),
        lanes_(kernels_.lanes),
        at_{group.shape->states},
        rows_(static_cast<double*>(::operator new(
            sizeof(double) * static_cast<std::size_t>(at_.count()) * static_cast<std::size_t>(lanes_), alignment))),
        seats_(static_cast<std::size_t>(lanes_)) {
    batch_.rows = rows_.get();
    batch_.curve = group.shape->curve;
  }

  void run() {
    const LaneKernel kernel = kernel_for(kernels_, *group_.shape);
    const int used = options_.lanes > 0 ? std::min(options_.lanes, lanes_) : lanes_;
    for (int lane = 0; lane < lanes_; ++lane) leave_idle(lane);
    for (int lane = 0; lane < used; ++lane) refill(lane);
    while (seated_ > 0) {
      kernel(batch_);
      const bool stop = ++calls_ % 64 == 0 && work_.stopped();
      for (int lane = 0; lane < lanes_; ++lane) {
        if (number(lane, LaneRows::active) == 0.0) continue;
        if (stop)
          finish(lane, Status::interrupted);
        else if (const auto event = static_cast<int>(number(lane, LaneRows::event)); event != 0)
          handle(lane, event);
      }
    }
    work_.count(useful_, batch_.attempts * used);
  }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(double* rows) const { ::operator delete(rows, alignment); }
  };

  struct Seat {
    std::size_t member = 0;
    std::optional<OutcomeWatch> watch;
  };

  double& number(int lane, int row) {
    return rows_[static_cast<std::size_t>(row) * seats_.size() + static_cast<std::size_t>(lane)];
  }
  Seat& seat(int lane) { return seats_[static_cast<std::size_t>(lane)]; }
  const Loop& loop(int lane) { return *work_.member(seat(lane).member).loop; }

  /// Fills an empty lane: values common to all lanes (the exponent, whether damping fades) are read from empty ones
  /// too.
  void leave_idle(int lane) {
    const std::size_t first = group_.members.front();
    const EnsembleMember& any = work_.member(first);
    write_lane(*any.loop, loop_weights(*any.loop, work_.bounds(first).rtol), any.start.x, rows_.get() + lane, lanes_);
    number(lane, LaneRows::end) = infinite;
  }

  void refill(int lane) {
    const auto next = work_.take(group_);
    if (!next) {
      number(lane, LaneRows::active) = 0.0;
      return;
    }
    const EnsembleMember& member = work_.member(*next);
    const MotionBounds& bounds = work_.bounds(*next);
    write_lane(*member.loop, loop_weights(*member.loop, bounds.rtol), member.start.x, rows_.get() + lane, lanes_);
    seat(lane).member = *next;
    seat(lane).watch.emplace(watch_for(*member.loop, bounds, options_.accuracy));
    double y = 0.0;
    for (int i = 0; i < at_.n; ++i) y += number(lane, at_.C_y() + i) * number(lane, at_.state() + i);
    seat(lane).watch->begin(0.0, y);
    number(lane, LaneRows::end) = options_.duration;
    number(lane, LaneRows::ceiling) = bounds.amplitude_ceiling;
    number(lane, LaneRows::most_steps) = static_cast<double>(options_.max_steps);
    number(lane, LaneRows::level) = infinite;
    number(lane, LaneRows::active) = 1.0;
    batch_.fresh = true;
    ++seated_;
  }

  void handle(int lane, int event) {
    OutcomeWatch& watch = *seat(lane).watch;
    if (event & (lane_turned | lane_crossed)) {
      const double start = number(lane, LaneRows::step_start), end = number(lane, LaneRows::time);
      const OutputStep step{
          start,
          end - start,
          number(lane, LaneRows::y_start),
          number(lane, LaneRows::y_end),
          {number(lane, LaneRows::y_bend), number(lane, LaneRows::y_bend + 1), number(lane, LaneRows::y_bend + 2)}};
      if (event & lane_crossed) watch.crossed(step);
      if (event & lane_turned) watch.turned(step);
    }
    if (event & lane_look) look(lane);
    if (event & (lane_left | lane_not_finite)) watch.diverged();
    if (const auto status = verdict(event, watch)) return finish(lane, *status);
    number(lane, LaneRows::look) = watch.next_look();
    number(lane, LaneRows::level) = watch.level();
  }

  void look(int lane) {
    read_lane(loop(lane), rows_.get() + lane, lanes_, at_.rate(), rates_);
    read_lane(loop(lane), rows_.get() + lane, lanes_, at_.state(), state_);
    seat(lane).watch->look(number(lane, LaneRows::time), state_, rates_, work_.member(seat(lane).member).start.modes);
  }

  /// Final status of the member, if it has ended.
  std::optional<Status> verdict(int event, const OutcomeWatch& watch) const {
    if (event & lane_not_finite) return Status::not_finite;
    if (event & lane_stalled) return Status::stalled;
    if (event & lane_left) return Status::converged;
    if (options_.until_decided && watch.decided()) return Status::converged;
    if (event & lane_ended) return at_end(watch, options_);
    if (event & lane_budget) return Status::max_iterations;
    return std::nullopt;
  }

  void finish(int lane, Status status) {
    const Seat& here = seat(lane);
    EnsembleResult& result = work_.results()[here.member];
    conclude(result, *here.watch, status);
    read_lane(loop(lane), rows_.get() + lane, lanes_, at_.state(), result.state.x);
    result.state.modes = work_.member(here.member).start.modes;
    result.time = number(lane, LaneRows::time);
    result.steps = static_cast<long>(number(lane, LaneRows::accepted));
    result.refused = static_cast<long>(number(lane, LaneRows::refused));
    result.in_lanes = true;
    // Friction alone has no family of periodic motions: only a motion that never repeats is passed to settle().
    if (!here.watch->decided() && leaves_open(result, *here.watch, options_))
      ask_settle(result, work_.member(here.member), work_.bounds(here.member), options_.max_steps,
                 [this] { return work_.stopped(); });
    useful_ += result.steps + result.refused;
    --seated_;
    refill(lane);
  }

  EnsembleWork& work_;
  const EnsembleOptions& options_;
  EnsembleGroup& group_;
  const LaneKernels& kernels_;
  int lanes_;
  LaneRows at_;
  std::unique_ptr<double[], Free> rows_;
  std::vector<Seat> seats_;
  LaneBatch batch_;
  State state_, rates_;
  int seated_ = 0;
  long calls_ = 0, useful_ = 0;
};

/// One member of any kind, by March.
class SingleRun {
 public:
  SingleRun(EnsembleWork& work, std::size_t index)
      : work_(work),
        member_(work.member(index)),
        bounds_(work.bounds(index)),
        options_(work.options()),
        loop_(*member_.loop),
        result_(work.results()[index]),
        field_(loop_),
        march_(field_, StepperKind::automatic, loop_weights(loop_, bounds_.rtol)),
        watch_(watch_for(loop_, bounds_, options_.accuracy)) {
    const LoopState& start = member_.start;
    field_.modes() = start.modes;
    march_.begin(start.x, 0.0);
    watch_.begin(0.0, field_.y(start.x));
  }

  void run() {
    std::optional<Status> status;
    while (!status) status = step();
    conclude(result_, watch_, *status);
    result_.state = {march_.x(), field_.modes()};
    result_.time = march_.t();
    result_.steps = march_.steps();
    if (leaves_open(result_, watch_, options_))
      ask_settle(result_, member_, bounds_, options_.max_steps, [this] { return work_.stopped(); });
  }

 private:
  std::optional<Status> step() {
    if (march_.steps() % 64 == 0 && work_.stopped()) return Status::interrupted;
    const Status status = march_.step(std::min(options_.duration, 1e15));
    if (status == Status::not_finite) watch_.diverged();
    if (status != Status::converged) return status;
    look();
    if (std::abs(field_.y(march_.x())) > bounds_.amplitude_ceiling) {
      watch_.diverged();
      return Status::converged;
    }
    if (options_.until_decided && watch_.decided()) return Status::converged;
    if (march_.t() >= std::min(options_.duration, 1e15)) return at_end(watch_, options_);
    if (march_.steps() >= options_.max_steps) return Status::max_iterations;
    return std::nullopt;
  }

  void look() {
    const Step& last = march_.last();
    const OutputStep step = OutputStep::through(loop_, last);
    const double level = watch_.level();
    if (step.y0 < level && step.y1 >= level) watch_.crossed(step);
    if ((field_.y_rate(last.dx0) < 0.0) != (field_.y_rate(last.dx1) < 0.0)) watch_.turned(step);
    if (last.switched) watch_.switched(field_, march_.x(), march_.t(), *last.switched);
    if (march_.t() < watch_.next_look()) return;
    field_.rate(march_.x(), rates_, march_.t());
    watch_.look(march_.t(), march_.x(), rates_, field_.modes());
  }

  EnsembleWork& work_;
  const EnsembleMember& member_;
  const MotionBounds& bounds_;
  const EnsembleOptions& options_;
  const Loop& loop_;
  EnsembleResult& result_;
  LoopField field_;
  March march_;
  OutcomeWatch watch_;
  State rates_;
};

void require(bool good, const std::string& what, double value) {
  if (!good) throw std::invalid_argument(what + ", got " + std::to_string(value));
}

void validate(const MotionBounds& bounds) {
  require(bounds.rtol > 0.0 && bounds.rtol <= 0.1, "rtol must be in (0, 0.1]", bounds.rtol);
  require(bounds.amplitude_floor >= 0.0, "amplitude_floor must be at least 0", bounds.amplitude_floor);
  require(bounds.amplitude_ceiling > 0.0, "amplitude_ceiling must be more than 0", bounds.amplitude_ceiling);
}

void validate(std::span<const EnsembleMember> members, const EnsembleOptions& options) {
  validate(static_cast<const MotionBounds&>(options));
  require(options.duration > 0.0, "duration must be more than 0", options.duration);
  require(options.until_decided || options.duration < infinite, "duration must be finite unless until_decided",
          options.duration);
  require(options.max_steps > 0, "max_steps must be more than 0", static_cast<double>(options.max_steps));
  require(options.accuracy > 0.0, "accuracy must be more than 0", options.accuracy);
  require(options.lanes >= 0, "lanes must be at least 0", options.lanes);
  require(options.threads >= 0 && options.threads <= 1024, "threads must lie in 0..1024", options.threads);
  if (!is_available(options.isa))
    throw std::invalid_argument("this machine has no " + std::string(to_string(options.isa)));
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::string who = "member " + std::to_string(i);
    if (members[i].loop == nullptr) throw std::invalid_argument(who + " has no loop");
    const LoopField field(*members[i].loop);
    const LoopState& start = members[i].start;
    require(start.x.size() == field.size(), who + " must start with " + std::to_string(field.size()) + " states",
            static_cast<double>(start.x.size()));
    require(start.modes.size() == field.modes().size(),
            who + " must start with " + std::to_string(field.modes().size()) + " modes",
            static_cast<double>(start.modes.size()));
    if (!is_finite(start.x)) throw std::invalid_argument(who + " must start from finite numbers");
    if (members[i].own) validate(*members[i].own);
  }
}

}  // namespace

EnsembleRun run_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options) {
  validate(members, options);
  EnsembleWork work(members, options);
  const auto march = [&work] {
    for (EnsembleGroup& group : work.groups()) {
      if (group.shape) {
        LaneRun(work, group).run();
        continue;
      }
      while (const auto member = work.take(group)) SingleRun(work, *member).run();
    }
  };
  on_threads(thread_count(options.threads), march, [&work] { work.end(); });
  return {std::move(work.results()), work.occupancy()};
}

}  // namespace limcycle
