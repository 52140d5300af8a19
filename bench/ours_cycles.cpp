/// @file
/// limcycle finds and follows limit cycles; errors of the periods, its own and those of AUTO-07p.
///   ours_cycles AUTO_POINTS SERVO_CASE VAN_DER_POL_CASE      AUTO_POINTS as auto_cycles.py writes it
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "limcycle/analysis/orbit/branch/continuation.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/bench/measure.hpp"
#include "limcycle/cases/loader/case.hpp"

namespace {

using limcycle::Cycle;
using limcycle::Loop;

/// A cycle followed over one parameter from the value in its case.
struct Family {
  std::string name;
  limcycle::LoopFamily loop;
  double begin;
};

Family servo(const std::string& file) {
  return {"servo over kd",
          [parts = limcycle::need_loop(limcycle::load_case(file))](double kd) -> std::optional<Loop> {
            auto changed = parts;
            std::get<limcycle::Pid>(changed.controller).kd = kd;
            return limcycle::build_loop(changed);
          },
          6.0};
}

Family van_der_pol(const std::string& file) {
  return {"van-der-pol over mu",
          [parts = limcycle::need_loop(limcycle::load_case(file))](double mu) -> std::optional<Loop> {
            auto changed = parts;
            auto& plant = std::get<limcycle::TransferFunction>(changed.plant);
            plant.numerator = {mu, 0.0};
            plant.denominator = {1.0, -mu, 1.0};
            return limcycle::build_loop(changed);
          },
          5.0};
}

/// As `predict` does from one start: simulates from y(0) = 1 until the motion is periodic, then shoots. The
/// multipliers, which show that the cycle is stable, are needed to about 1e-6 only.
Cycle cold(const Loop& loop, double accuracy) {
  limcycle::SettleOptions options;
  options.shooting.accuracy = accuracy;
  options.shooting.rtol = std::clamp(accuracy, 1e-13, 1e-8);
  options.shooting.tolerance = 0.1 * options.shooting.rtol;
  options.shooting.derivative_rtol = 1e-7;
  const auto settled = limcycle::settle(loop, limcycle::displaced(loop, 1.0), options);
  if (!settled.shot) throw std::runtime_error("no cycle: " + settled.why);
  return settled.shot->cycle;
}

/// Periods to about 1e-12 by shooting, each from the one before: to be called in the order of the branch.
class Truth {
 public:
  explicit Truth(const Family& family) : family_(family), at_(family.begin), cycle_(cold(*family.loop(at_), 1e-10)) {
    first_ = cycle_;
  }
  double period(double parameter) {
    const auto known = periods_.find(parameter);
    if (known != periods_.end()) return known->second;
    if (std::abs(parameter - family_.begin) < std::abs(parameter - at_)) cycle_ = first_;
    at_ = parameter;
    const Loop loop = *family_.loop(parameter);
    limcycle::ShootingOptions options;
    options.rtol = 1e-13;
    options.tolerance = 3e-12;
    const auto from = [&](const Cycle& guess) {
      return limcycle::shoot(loop, guess.start, limcycle::choose_section(loop, guess.trace), guess.half_wave_symmetric,
                             options);
    };
    auto shot = from(cycle_);
    if (shot.status != limcycle::Status::converged) shot = from(cold(loop, 1e-8));
    if (shot.status != limcycle::Status::converged) throw std::runtime_error("no reference: " + shot.why);
    cycle_ = shot.cycle;
    return periods_[parameter] = shot.cycle.period;
  }

 private:
  const Family& family_;
  double at_;
  Cycle cycle_, first_;
  std::map<double, double> periods_;
};

struct AutoPoint {
  std::string problem, contender, setting;
  double seconds, parameter, period;
};

std::vector<AutoPoint> read_auto(const char* file) {
  std::ifstream in(file);
  std::vector<AutoPoint> all;
  AutoPoint point;
  while (in >> point.problem >> point.contender >> point.setting >> point.seconds >> point.parameter >> point.period) {
    for (char& letter : point.problem)
      if (letter == '_') letter = ' ';
    all.push_back(point);
  }
  return all;
}

/// One row a mesh; returns the end of AUTO's longest branch. Its first three points are not assessed: they still have
/// the mesh of the start orbit.
double judge_auto(const Family& family, Truth& truth, const std::vector<AutoPoint>& points) {
  std::vector<bench::Row> rows;  // in the order of the meshes
  double end = family.begin;
  for (const auto& point : points) {
    if (point.problem != family.name) continue;
    if (rows.empty() || rows.back().setting != point.setting)
      rows.push_back({"cycles", family.name, point.contender, point.setting, 0.0, point.seconds});
    auto& row = rows.back();
    if (++row.evaluations > 3)
      row.error = std::max(row.error, std::abs(point.period / truth.period(point.parameter) - 1.0));
    end = std::max(end, point.parameter);
  }
  for (const auto& row : rows) bench::print(row);
  return end;
}

void measure_cold(const Family& family, Truth& truth) {
  const Loop loop = *family.loop(family.begin);
  for (const double accuracy : {1e-4, 1e-6, 1e-8, 1e-10}) {
    bench::Row row{"cycles", family.name + " cold start", "limcycle", "accuracy " + bench::short_power(accuracy)};
    Cycle cycle;
    row.seconds = bench::least_cpu_seconds([&] { cycle = cold(loop, accuracy); });
    row.error = std::abs(cycle.period / truth.period(family.begin) - 1.0);
    bench::print(row);
  }
}

void measure_continuation(const Family& family, Truth& truth, double end, int points) {
  const Cycle start = cold(*family.loop(family.begin), 1e-10);
  for (const double accuracy : {1e-4, 1e-6, 1e-8, 1e-10}) {
    limcycle::ContinuationOptions options;
    options.from = family.begin;
    options.to = end;
    options.accuracy = accuracy;
    options.downwards = false;
    options.first_step = options.max_step = limcycle::ParameterScale::length / points;
    bench::Row row{"cycles", family.name, "limcycle", "accuracy " + bench::short_power(accuracy)};
    limcycle::Branch branch;
    row.seconds =
        bench::least_cpu_seconds([&] { branch = limcycle::continue_cycle(family.loop, start, family.begin, options); });
    if (branch.points.size() < 2) {
      row.status = "failed: " + branch.why;
      bench::print(row);
      continue;
    }
    row.seconds /= static_cast<double>(branch.points.size());
    row.evaluations = static_cast<long>(branch.points.size());
    for (const auto& point : branch.points)
      row.error = std::max(row.error, std::abs(point.cycle.period / truth.period(point.parameter) - 1.0));
    bench::print(row);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const auto by_auto = read_auto(arguments[1]);
  for (const auto& [family, points] : {std::pair{servo(arguments[2]), 24}, std::pair{van_der_pol(arguments[3]), 40}}) {
    Truth truth(family);
    const double end = judge_auto(family, truth, by_auto);
    measure_cold(family, truth);
    measure_continuation(family, truth, end, points);
  }
}
