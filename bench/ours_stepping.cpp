/// @file
/// limcycle on the hunting servo, integrated as in `limcycle simulate`.
///   ours_stepping REFERENCE CASE
#include <string>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/bench/stepping.hpp"
#include "limcycle/cases/loader/case.hpp"

namespace {

/// The case with another bristle stiffness, damped as in the case.
limcycle::Loop servo(const char* file, double sigma0) {
  const auto set = [](const char* key, double value) {
    char text[80];
    std::snprintf(text, sizeof text, "loop.friction.%s=%.17g", key, value);
    return std::string(text);
  };
  const auto given = limcycle::load_case(file, {set("sigma0", sigma0), set("sigma1", std::sqrt(sigma0))});
  return limcycle::build_loop(limcycle::need_loop(given));
}

/// The default stepper with the tolerances of `limcycle simulate`; as there, its steps end at the samples.
bench::Positions march(const limcycle::Loop& loop, limcycle::StepperKind kind, double rtol) {
  limcycle::LoopField field(loop);
  limcycle::State x(field.size(), 0.0);
  // y = 1 at rest: the state whose output is the measured position.
  for (Eigen::Index i = 0; i < loop.states(); ++i) x[static_cast<std::size_t>(i)] = loop.C_y(i);
  field.start(x, 0.0);
  limcycle::March march(field, kind, limcycle::loop_weights(loop, rtol));
  march.begin(x, 0.0);
  bench::Positions run;
  for (int k = 1; k <= bench::stepping_samples; ++k) {
    const double until = bench::sample_time(k);
    while (march.t() < until) {
      const auto status = march.step(until);
      if (status != limcycle::Status::converged)
        throw std::runtime_error("failed: " + std::string(limcycle::to_string(status)));
    }
    run.x.push_back(field.y(march.x()));
  }
  run.evaluations = 8 * march.steps();  // of the stiff stepper; rejected tries are not counted
  return run;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  for (const auto& [sigma0, reference] : bench::read_reference(arguments[1])) {
    const auto loop = servo(arguments[2], sigma0);
    bench::stepping_ladder("limcycle", sigma0, reference, 1e-12,
                           [&](double, double rtol) { return march(loop, limcycle::StepperKind::automatic, rtol); });
  }
}
