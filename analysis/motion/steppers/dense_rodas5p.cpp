#include "limcycle/analysis/motion/steppers/dense_rodas5p.hpp"

#include <boost/numeric/odeint/util/odeint_error.hpp>
#include <string>

namespace limcycle {

void DenseRodas5p::initialize(const State& x0, double t0, double dt0) {
  x_ = x0;  // x0 may be our own current state: Odeint restarts that way to hit the end of an interval
  t_ = t0;
  dt_ = dt0;
  stepper_.reset();
  segment_.start_ = segment_.end_ = t0;
  segment_.first_ = x_;
  segment_.last_ = x_;
  for (State& bend : segment_.bend_) bend.assign(x_.size(), 0.0);
}

void DenseRodas5p::require_progress(double t, double dt) {
  if (t + dt != t) return;
  throw boost::numeric::odeint::step_adjustment_error("no step from t = " + std::to_string(t) +
                                                      " is good enough, however short");
}

std::pair<double, double> DenseRodas5p::accept(double t, double dt) {
  stepper_.interpolant(segment_);
  segment_.end_ = t;
  x_ = new_x_;
  t_ = t;
  dt_ = dt;
  return {segment_.start_, t_};
}

}  // namespace limcycle
