/// @file
/// limcycle on the random servos, one by one. Marching them in lanes will join here.
///   ours_ensemble REFERENCE CASE
#include <fstream>
#include <string>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/bench/ensemble.hpp"
#include "limcycle/bench/measure.hpp"
#include "limcycle/cases/case.hpp"

namespace {

using limcycle::Loop;

Loop loop_of(const bench::Servo<double>& servo, limcycle::LoopParts parts) {
  auto& controller = std::get<limcycle::Pid>(parts.controller);
  controller.kp = servo.kp;
  controller.ki = servo.ki;
  controller.kd = servo.kd;
  auto& law = std::get<limcycle::LuGre<double>>(*parts.friction);
  law.Fs = law.Fs_minus = servo.Fs;
  law.vs = servo.vs;
  law.sigma0 = servo.sigma0;
  law.sigma1 = servo.sigma1;
  return limcycle::build_loop(parts);
}

double final_position(const Loop& loop, double rtol) {
  limcycle::LoopField field(loop);
  limcycle::State x(field.size(), 0.0);
  for (Eigen::Index i = 0; i < loop.states(); ++i) x[static_cast<std::size_t>(i)] = loop.C_y(i);
  field.start(x, 0.0);
  limcycle::March march(field, limcycle::StepperKind::automatic, limcycle::loop_weights(loop, rtol));
  march.begin(x, 0.0);
  while (march.t() < bench::ensemble_duration)
    if (march.step(bench::ensemble_duration) != limcycle::Status::converged) return NAN;
  return field.y(march.x());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  std::ifstream in(arguments[1]);
  std::vector<double> reference;
  for (double value = 0.0; in >> value;) reference.push_back(value);
  const auto parts = limcycle::need_loop(limcycle::load_case(arguments[2]));
  std::vector<Loop> loops;
  for (const auto& servo : bench::random_servos()) loops.push_back(loop_of(servo, parts));
  for (const double rtol : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    bench::Row row{"ensembles", "random servos", "limcycle", bench::short_power(rtol), 0.0};
    const double begin = bench::cpu_seconds();
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const double position = final_position(loops[i], rtol);
      if (i >= reference.size()) continue;
      const double error = std::abs(position - reference[i]);
      if (!(error <= row.error)) row.error = error;
    }
    row.seconds = (bench::cpu_seconds() - begin) / static_cast<double>(loops.size());
    bench::print(row);
  }
}
