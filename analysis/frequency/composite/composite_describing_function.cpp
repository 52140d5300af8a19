#include "limcycle/analysis/frequency/composite/composite_describing_function.hpp"

#include <stdexcept>
#include <variant>

#include "limcycle/analysis/frequency/composite/composite_period.hpp"
#include "limcycle/analysis/frequency/describing_function/argument_error.hpp"
#include "limcycle/analysis/frequency/describing_function/df_undefined.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// The solver for one law, behind one virtual call a point.
struct CompositeDescribingFunction::Solver {
  virtual ~Solver() = default;
  virtual CompositeResponse solve(const CompositePoint& point, double relative, int orders,
                                  const CompositeResponse* near) = 0;
  virtual bool tears_loose(double force, double frequency) = 0;
  virtual bool tears_loose(double bias, double force, double frequency, double direction) = 0;
  virtual void stop_with(std::function<bool()> stop) = 0;
  virtual long steps() const = 0;
  virtual bool has_front() const = 0;
  virtual double level() const = 0;
};

namespace {

template <int D>
class SolverOf : public CompositeDescribingFunction::Solver {
 public:
  SolverOf(const Element& law, double mass) : period_(law, mass) {}
  CompositeResponse solve(const CompositePoint& point, double relative, int orders,
                          const CompositeResponse* near) override {
    return period_.solve(point, relative, orders, near);
  }
  bool tears_loose(double force, double frequency) override { return period_.tears_loose(force, frequency); }
  bool tears_loose(double bias, double force, double frequency, double direction) override {
    return period_.tears_loose(bias, force, frequency, direction);
  }
  void stop_with(std::function<bool()> stop) override { period_.stop_with(std::move(stop)); }
  long steps() const override { return period_.steps(); }
  bool has_front() const override { return period_.has_front(); }
  double level() const override { return period_.level(); }

 private:
  CompositePeriod<D> period_;
};

std::unique_ptr<CompositeDescribingFunction::Solver> solver_of(const Element& friction, double mass) {
  if (!friction.is_friction())
    throw std::invalid_argument("composite describing function: " + std::string(friction.kind()) +
                                " is not a friction law");
  if (undefined_under(friction, infinite, 1.0))
    throw std::invalid_argument("composite describing function: a law with a spring of its own is refused");
  if (friction.states() == 0) return std::make_unique<SolverOf<1>>(friction, mass);
  if (friction.states() == 1) return std::make_unique<SolverOf<2>>(friction, mass);
  return std::make_unique<SolverOf<0>>(friction, mass);
}

void check(const CompositePoint& p, const CompositeOptions& o) {
  if (!(p.force > 0.0 && std::isfinite(p.force)))
    refuse("composite describing function", "force", p.force, "must be > 0 and finite");
  if (!(p.frequency > 0.0 && std::isfinite(p.frequency)))
    refuse("composite describing function", "frequency", p.frequency, "must be > 0 and finite");
  if (p.bias && !std::isfinite(*p.bias)) refuse("composite describing function", "bias", *p.bias, "must be finite");
  if (!std::isfinite(p.mean_velocity))
    refuse("composite describing function", "mean velocity", p.mean_velocity, "must be finite");
  if (o.harmonics < 1 || o.harmonics > 64)
    refuse("composite describing function", "harmonics", o.harmonics, "must lie in 1..64");
  if (!(o.accuracy >= 1e-11 && o.accuracy <= 0.1))
    refuse("composite describing function", "accuracy", o.accuracy, "must lie in 1e-11..0.1");
}

}  // namespace

CompositeDescribingFunction::CompositeDescribingFunction(const Element& friction, double mass) {
  if (!(mass > 0.0 && std::isfinite(mass)))
    refuse("composite describing function", "mass", mass, "must be > 0 and finite");
  solver_ = solver_of(friction, mass);
}

CompositeDescribingFunction::~CompositeDescribingFunction() = default;
CompositeDescribingFunction::CompositeDescribingFunction(CompositeDescribingFunction&&) noexcept = default;
CompositeDescribingFunction& CompositeDescribingFunction::operator=(CompositeDescribingFunction&&) noexcept = default;

CompositeResponse CompositeDescribingFunction::operator()(const CompositePoint& point, const CompositeOptions& options,
                                                          const CompositeResponse* near) {
  check(point, options);
  const double relative = 0.1 * options.accuracy;
  if (!options.estimate_error) return solver_->solve(point, relative, options.harmonics, near);
  // The tolerance of a stepper with kinks in its way is no error bound. Compare with a solution ten times looser, whose
  // error makes up most of the difference; half the difference leaves a margin of about five.
  CompositeResponse coarse = solver_->solve(point, 10.0 * relative, 1, near);
  CompositeResponse fine =
      solver_->solve(point, relative, options.harmonics, coarse.status == Status::converged ? &coarse : near);
  fine.maps += coarse.maps;
  fine.steps += coarse.steps;
  if (fine.status != Status::converged) return fine;
  const double size = std::max(std::abs(fine.gain), std::numeric_limits<double>::min());
  fine.error += coarse.status == Status::converged ? 0.5 * std::abs(fine.gain - coarse.gain) / size : 1.0;
  if (fine.error > options.accuracy) fine.status = Status::incomplete;
  return fine;
}

void CompositeDescribingFunction::stop_with(std::function<bool()> stop) { solver_->stop_with(std::move(stop)); }

long CompositeDescribingFunction::steps() const { return solver_->steps(); }

double CompositeDescribingFunction::break_away(double frequency, double relative, double guess) {
  const double level = solver_->level();
  if (!(frequency > 0.0)) refuse("composite describing function", "frequency", frequency, "must be > 0");
  if (!solver_->has_front()) return level;
  double low = guess > 0.0 ? guess : level, high = low, widen = guess > 0.0 ? 3e-4 : 0.01;
  for (int i = 0; i < 60 && solver_->tears_loose(low, frequency); ++i, widen *= 2.0) {
    high = low;
    low *= 1.0 - std::min(widen, 0.5);
  }
  for (int i = 0; i < 60 && high <= low; ++i, widen *= 2.0) {
    const double next = high * (1.0 + std::min(widen, 1.0));
    if (solver_->tears_loose(next, frequency)) {
      high = next;
      break;
    }
    low = high = next;
  }
  while (high > low * (1.0 + relative)) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    (solver_->tears_loose(middle, frequency) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

double CompositeDescribingFunction::break_away_bias(double force, double frequency, double direction, double relative) {
  check({force, frequency}, {});
  const double level = solver_->level(), side = direction < 0.0 ? -1.0 : 1.0;
  const auto loose = [&](double bias) { return solver_->tears_loose(side * bias, force, frequency, side); };
  double width = 0.05 * level, low = level - force, high = low;
  if (loose(low)) {
    for (int i = 0; i < 40 && loose(low); ++i, width *= 2.0) {
      high = low;
      low -= width;
    }
  } else {
    for (int i = 0; i < 40 && !loose(high); ++i, width *= 2.0) {
      low = high;
      high += width;
    }
  }
  while (high - low > relative * level) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;  // no number between: a bracket far out, as an interruption may give
    (loose(middle) ? high : low) = middle;
  }
  return side * 0.5 * (low + high);
}

}  // namespace limcycle
