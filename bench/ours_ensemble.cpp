/// @file
/// limcycle on the random servos: in lanes with every instruction set of this machine, in one lane, and one at a time.
///   ours_ensemble REFERENCE CASE
#include <algorithm>
#include <fstream>
#include <string>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/simulate/ensemble.hpp"
#include "limcycle/bench/ensemble.hpp"
#include "limcycle/bench/measure.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace {

using limcycle::Loop;

Loop loop_of(const bench::Servo<double>& servo, limcycle::LoopParts parts) {
  auto& controller = std::get<limcycle::Pid>(parts.controller);
  controller.kp = servo.kp;
  controller.ki = servo.ki;
  controller.kd = servo.kd;
  auto& law = law_of<limcycle::LuGre<double>>(*parts.friction);
  law.Fs = law.Fs_minus = servo.Fs;
  law.vs = servo.vs;
  law.sigma0 = servo.sigma0;
  law.sigma1 = servo.sigma1;
  return limcycle::build_loop(parts);
}

limcycle::LoopState start_of(const Loop& loop) {
  limcycle::LoopField field(loop);
  limcycle::LoopState start{limcycle::State(field.size(), 0.0), {}};
  for (Eigen::Index i = 0; i < loop.states(); ++i) start.x[static_cast<std::size_t>(i)] = loop.C_y(i);
  field.start(start.x, 0.0);
  start.modes = field.modes();
  return start;
}

double final_position(const Loop& loop, double rtol) {
  limcycle::LoopField field(loop);
  const auto start = start_of(loop);
  field.modes() = start.modes;
  limcycle::March march(field, limcycle::StepperKind::automatic, limcycle::loop_weights(loop, rtol));
  march.begin(start.x, 0.0);
  while (march.t() < bench::ensemble_duration)
    if (march.step(bench::ensemble_duration) != limcycle::Status::converged) return NAN;
  return field.y(march.x());
}

using Positions = std::vector<double>;

Positions one_by_one(const std::vector<Loop>& loops, double rtol) {
  Positions found;
  for (const Loop& loop : loops) found.push_back(final_position(loop, rtol));
  return found;
}

Positions in_lanes(const std::vector<Loop>& loops, double rtol, limcycle::Isa isa, int lanes) {
  std::vector<limcycle::EnsembleMember> members;
  for (const Loop& loop : loops) members.push_back({&loop, start_of(loop)});
  limcycle::EnsembleOptions options;
  options.rtol = rtol;
  options.duration = bench::ensemble_duration;
  options.max_steps = 1000000;
  options.until_decided = false;
  options.isa = isa;
  options.lanes = lanes;
  const auto run = limcycle::run_ensemble(members, options);
  Positions found;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const Eigen::Map<const Eigen::RowVectorXd> x(run.members[i].state.x.data(), loops[i].states());
    found.push_back(run.members[i].status == limcycle::Status::converged ? loops[i].C_y.dot(x) : NAN);
  }
  return found;
}

template <class Run>
void measure(const std::string& contender, const std::vector<double>& reference, Run&& run) {
  for (const double rtol : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    bench::Row row{"ensembles", "random servos", contender, bench::short_power(rtol), 0.0};
    const double begin = bench::cpu_seconds();
    const Positions found = run(rtol);
    row.seconds = (bench::cpu_seconds() - begin) / static_cast<double>(found.size());
    for (std::size_t i = 0; i < std::min(found.size(), reference.size()); ++i) {
      const double error = std::abs(found[i] - reference[i]);
      if (!(error <= row.error)) row.error = error;
    }
    bench::print(row);
  }
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
  for (const limcycle::Isa isa : limcycle::all_isas()) {
    if (!limcycle::is_available(isa)) continue;
    std::string contender = "limcycle";
    if (isa != limcycle::best_isa()) contender += " " + std::string(limcycle::to_string(isa));
    measure(contender, reference, [&](double rtol) { return in_lanes(loops, rtol, isa, 0); });
  }
  measure("limcycle one lane", reference, [&](double rtol) { return in_lanes(loops, rtol, limcycle::Isa::scalar, 1); });
  measure("limcycle one by one", reference, [&](double rtol) { return one_by_one(loops, rtol); });
}
