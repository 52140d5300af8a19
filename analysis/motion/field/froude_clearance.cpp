#include "limcycle/analysis/motion/field/froude_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {
namespace {

using Clearance = FroudeClearance<double>;
using Phase = Clearance::Phase;

void check(const FroudeOptions& options) {
  const auto bad = [](const std::string& what, double value) {
    throw std::invalid_argument("froude pendulum: " + what + ", got " + std::to_string(value));
  };
  if (!(options.duration > 0.0 && std::isfinite(options.duration))) bad("duration must be > 0 s", options.duration);
  if (!(options.sample > 0.0 && options.sample <= options.duration))
    bad("sample must be > 0 and at most the duration", options.sample);
  if (options.duration / options.sample > 2e7) bad("sample asks for more than 2e7 rows", options.sample);
  if (!(options.rtol >= 1e-12 && options.rtol <= 1e-3)) bad("rtol must be in 1e-12..1e-3", options.rtol);
}

/// Common interface of both models: rates in the present phase, with their Jacobian by dual numbers.
template <template <class> class Model>
class Field {
 public:
  static constexpr int n = Model<double>::states;
  using D = Dual<n>;

  explicit Field(const Model<double>& model) : model_(model) {
    dual_.pendulum = model.pendulum;
    dual_.law = recast<LuGre, D>(model.law);
    if constexpr (has_phases) dual_.contact = model.contact;
  }
  static constexpr bool has_phases = requires { Model<double>::Phase::touching; };

  void operator()(const State& q, State& dq, double) const { rate(model_, std::span(q), std::span(dq)); }

  void jacobian(const State& q, Eigen::MatrixXd& J, double, State&) const {
    std::array<D, n> x, dx;
    for (std::size_t i = 0; i < n; ++i) x[i] = D::variable(q[i], static_cast<int>(i));
    rate(dual_, std::span<const D>(x), std::span<D>(dx));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) J(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = dx[i].d[k];
  }

  Phase phase = Phase::touching;

 private:
  template <class S, class M>
  void rate(const M& model, std::span<const S> q, std::span<S> dq) const {
    if constexpr (has_phases)
      model.rate(q, static_cast<typename M::Phase>(phase), dq);
    else
      model.rate(q, dq);
  }

  const Model<double>& model_;
  Model<D> dual_{};
};

/// One run of either model.
template <template <class> class Model>
class Run {
 public:
  Run(const Model<double>& model, State start, State sizes, const FroudeOptions& options)
      : model_(model), options_(options), field_(model), x_(std::move(start)), stepper_(weights(std::move(sizes))) {}

  FroudeRun go() {
    begin();
    while (result_.status == Status::converged && t_ < options_.duration) step();
    result_.last = x_;
    return std::move(result_);
  }

 private:
  static constexpr bool has_phases = Field<Model>::has_phases;
  static constexpr int probes = 8;  ///< places in a step at which the guards are evaluated

  ErrorWeights weights(State sizes) const {
    for (double& size : sizes) size *= options_.rtol;
    return {options_.rtol, std::move(sizes)};
  }

  void fail(Status status, std::string why) {
    result_.status = status;
    result_.why = std::move(why);
  }

  void begin() {
    if constexpr (has_phases) {
      const auto meeting = model_.meet(x_, Phase::apart);
      field_.phase = meeting.penetration < 0.0 ? Phase::apart : Phase::touching;
      energy_ = model_.energy(x_) - x_[Clearance::work];
      swing_ = std::abs(energy_);
    }
    sample(0.0, x_);
    next_row_ = 1;
  }

  void step() {
    if (options_.stop && options_.stop()) return fail(Status::interrupted, "interrupted");
    if (++result_.steps > options_.max_steps) return fail(Status::max_iterations, "the step budget ran out");
    dt_ = std::min(dt_, options_.duration - t_);
    if (field_.phase == Phase::apart) dt_ = std::min(dt_, 1e-3);  // the sleeve crosses its play in some milliseconds
    const auto system = std::pair(std::cref(field_), [this](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
      field_.jacobian(x, J, t, dfdt);
    });
    const double before = t_;
    double t = t_;
    while (stepper_.try_step(system, x_, t, new_x_, dt_) != ControlledRodas5p::Result::success)
      if (t_ + dt_ == t_) return fail(Status::stalled, "the step size fell below rounding");
    if (!is_finite(new_x_)) return fail(Status::not_finite, "the state left the range of numbers");
    if (options_.duration - t < 1e-12 * options_.duration) t = options_.duration;
    if constexpr (has_phases) {
      if (const int fired = switched(t - before); fired >= 0) return land(fired, t - before, system);
    }
    accept(before, t);
  }

  void accept(double before, double t) {
    stepper_.interpolant(segment_);
    rows_until(t);
    t_ = t;
    x_ = new_x_;
    if constexpr (has_phases) {
      if (field_.phase != Phase::touching) result_.time_apart += t - before;
      const double defect = std::abs(model_.energy(x_) - x_[Clearance::work] - energy_);
      result_.energy_error = std::max(result_.energy_error, defect / swing_);
    }
  }

  double guard(int k, const State& x) const {
    double g[2];
    model_.guard(x, field_.phase, g);
    return g[k];
  }

  /// The guard that turns negative first in the last step, or -1; `reach_` is then its place.
  int switched(double h) {
    stepper_.interpolant(segment_);
    for (int i = 1; i <= probes; ++i) {
      const double at = h * i / probes;
      if (i == probes)
        probe_ = new_x_;
      else
        segment_.at(segment_.start() + at, probe_);
      for (int k = 0; k < 2; ++k)
        if (guard(k, probe_) < 0.0) {
          reach_ = at;
          return k;
        }
    }
    return -1;
  }

  /// Repeats the step up to the switch (bisection on the length of the step, then the side after the switch).
  template <class System>
  void land(int fired, double h, System& system) {
    const double before = t_;
    double low = 0.0, high = std::min(reach_, h);
    State error;
    for (int i = 0; i < 60 && high - low > 1e-16 + 1e-15 * t_; ++i) {
      const double mid = 0.5 * (low + high);
      stepper_.stepper().repeat_step(system, probe_, mid, error);
      (guard(fired, probe_) < 0.0 ? high : low) = mid;
    }
    stepper_.stepper().repeat_step(system, new_x_, high, error);
    stuck_ = high < 1e-14 ? stuck_ + 1 : 0;
    if (stuck_ > 20) return fail(Status::chattering, "the contact chatters");
    accept(before, before + high);
    const Phase next = model_.next(field_.phase, fired);
    if (field_.phase == Phase::touching) ++result_.losses;
    field_.phase = next;
    if (next != Phase::touching) x_[Clearance::bristle] = 0.0;
    stepper_.reset();
    dt_ = std::min(dt_, 1e-5);
  }

  void rows_until(double t) {
    for (; static_cast<double>(next_row_) * options_.sample <= t * (1.0 + 1e-14); ++next_row_) {
      const double at = static_cast<double>(next_row_) * options_.sample;
      if (at >= t)
        sample(at, new_x_);
      else {
        segment_.at(std::clamp(at, segment_.start(), segment_.end()), probe_);
        sample(at, probe_);
      }
    }
  }

  void sample(double t, const State& x) {
    FroudeTrace& trace = result_.trace;
    trace.t.push_back(t);
    if constexpr (has_phases) {
      const auto meeting = model_.meet(x, field_.phase);
      trace.angle.push_back(x[Clearance::angle]);
      trace.rubbing.push_back(meeting.rubbing);
      trace.normal.push_back(meeting.normal);
      trace.eccentricity.push_back(meeting.e);
    } else {
      trace.angle.push_back(x[0]);
      trace.rubbing.push_back(model_.rubbing(x));
      trace.normal.push_back(model_.normal(x));
      trace.eccentricity.push_back(0.0);
    }
  }

  const Model<double>& model_;
  const FroudeOptions& options_;
  Field<Model> field_;
  State x_, new_x_, probe_;
  ControlledRodas5p stepper_;
  DenseSegment segment_;
  FroudeRun result_;
  double t_ = 0.0, dt_ = 1e-5, reach_ = 0.0, energy_ = 0.0, swing_ = 1.0;
  long next_row_ = 0;
  int stuck_ = 0;
};

double penetration_at_rest(const FroudeClearance<double>& model) {
  return std::pow(model.load() / model.contact.stiffness, 1.0 / model.contact.exponent);
}

}  // namespace

State resting_sleeve(const FroudeClearance<double>& model, double angle, double angle_rate, double z) {
  const double e = model.pendulum.clearance + penetration_at_rest(model);
  // The sleeve hangs on the shaft: its centre is displaced along the arm.
  State q(FroudeClearance<double>::states, 0.0);
  q[Clearance::x] = e * std::sin(angle);
  q[Clearance::y] = -e * std::cos(angle);
  q[Clearance::x_rate] = e * std::cos(angle) * angle_rate;
  q[Clearance::y_rate] = e * std::sin(angle) * angle_rate;
  q[Clearance::angle] = angle;
  q[Clearance::angle_rate] = angle_rate;
  q[Clearance::bristle] = z;
  return q;
}

FroudeRun march_froude(const FroudeClearance<double>& model, State start, const FroudeOptions& options) {
  check(options);
  if (const auto broken = model.validate()) throw std::invalid_argument(broken->key + ": " + broken->rule);
  if (!(model.pendulum.clearance > 0.0))
    throw std::invalid_argument("loop.plant.clearance must be > 0 with a contact, got " +
                                std::to_string(model.pendulum.clearance));
  const double d = penetration_at_rest(model), fast = std::sqrt(model.pendulum.gravity / d);
  const double swing = model.load() * model.pendulum.arm;
  return Run<FroudeClearance>(model, std::move(start),
                              {d, d, 1.0, d * fast, d * fast, 1.0, model.law.state_scale(0), swing}, options)
      .go();
}

FroudeRun march_froude(const FroudeRigid<double>& model, State start, const FroudeOptions& options) {
  check(options);
  return Run<FroudeRigid>(model, std::move(start), {1.0, 1.0, model.law.state_scale(0)}, options).go();
}

}  // namespace limcycle
