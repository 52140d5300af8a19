#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace limcycle {

ControlledRodas5p::ControlledRodas5p(ErrorWeights weights, double max_dt)
    : weights_(std::move(weights)), max_dt_(max_dt) {
  weights_.require_valid();
  if (!(max_dt >= 0 && std::isfinite(max_dt)))
    throw std::invalid_argument("longest step must be finite and at least 0, got " + std::to_string(max_dt));
}

void ControlledRodas5p::reset() {
  failed_ = false;
  step_size_.reset();
}

double ControlledRodas5p::admit(const State& x, double dt) const {
  if (dt == 0 || !std::isfinite(dt)) throw std::invalid_argument("a step cannot have length " + std::to_string(dt));
  weights_.require_size(x.size());
  return max_dt_ > 0 && std::abs(dt) > max_dt_ ? std::copysign(max_dt_, dt) : dt;
}

bool ControlledRodas5p::retries(const State& x, double t) const {
  // The stepper is accessible to its user, who may have taken other steps since: hence the comparison.
  return failed_ && t == stepper_.start_time() && x == stepper_.start_state();
}

ControlledRodas5p::Result ControlledRodas5p::judge(const State& x, double& t, double& dt) {
  last_error_ = weights_.norm(x, new_x_, error_);
  // A step that does not advance the time is useless, however small its error.
  failed_ = !(last_error_ <= 1) || t + dt == t;
  if (failed_) {
    dt = step_size_.after_failure(dt, last_error_);
    return Result::fail;
  }
  t += dt;
  dt = step_size_.after_success(dt, last_error_);
  return Result::success;
}

}  // namespace limcycle
