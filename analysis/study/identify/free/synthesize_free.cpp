#include "limcycle/analysis/study/identify/free/synthesize_free.hpp"

#include <gsl/gsl_cdf.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "limcycle/analysis/study/identify/free/free_march.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

namespace limcycle {
namespace {

/// State with that y and dy/dt.
Eigen::Vector2d state_at(const PlantModel& plant, double y, double rate) {
  Eigen::Matrix2d rows;
  rows.row(0) = plant.C_y;
  rows.row(1) = plant.C_y * plant.A;
  return rows.inverse() * Eigen::Vector2d(y, rate);
}

/// The force on the contact that the spring and gravity exert at rest, N.
double pull_at(const FreeRig& rig, double y) {
  const auto& plant = rig.plant;
  const Eigen::Vector2d x = state_at(plant, y, 0.0);
  Eigen::Vector2d f = plant.A * x + plant.B_u * rig.load;
  if (plant.gravity) f -= plant.B_gravity * plant.gravity->output({plant.C_gravity.dot(x), 0.0, 0.0}, {}, {});
  return plant.C_v.dot(f) / plant.C_v.dot(plant.B_F);
}

/// A record of the motion under a law, from `start` at the first row. `sizes`: a first guess of the ranges of the
/// states.
FrictionRecord moved(const Element& law, FrictionRecord record, const FreeRig& rig, const Eigen::Vector2d& start,
                     Eigen::Vector2d sizes) {
  FreeMotion motion;
  motion.rig = rig;
  for (std::size_t i = 0; i < record.t.size(); ++i)
    motion.stops.push_back(
        {record.t[i], rig.load + (record.F.empty() ? 0.0 : record.F[i]), static_cast<std::ptrdiff_t>(i)});
  const auto speed = [&](double rate) { return std::abs(rig.plant.C_v.dot(state_at(rig.plant, 0.0, rate))); };
  const bool sliding = std::abs(rig.plant.C_v.dot(start) + rig.plant.v0) > 0.0;
  FreeRun run;
  for (int pass = 0; pass < 2; ++pass) {  // the second with the sizes that the first shows
    motion.state_sizes = sizes;
    motion.rubbing_speed = speed((rig.plant.C_y * rig.plant.A).dot(sizes)) + std::abs(rig.plant.v0);
    if (!FreeMarch(motion, law, nullptr, 2.0).run({0, motion.stops.size() - 1, start, sliding}, start, run))
      throw std::invalid_argument("the free motion of the rig could not be computed");
    const auto [y_low, y_high] = std::ranges::minmax(run.y);
    const auto [rate_low, rate_high] = std::ranges::minmax(run.rate);
    if (y_high > y_low) sizes = state_at(rig.plant, y_high - y_low, rate_high - rate_low).cwiseAbs();
  }
  record.x = run.y;
  record.v = run.rate;
  return record;
}

FrictionRecord rows_until(RecordKind kind, double duration, std::size_t rows) {
  FrictionRecord record{kind, std::string(to_string(kind)), {}, {}, {}, {}, 0.0};
  for (std::size_t i = 0; i < rows; ++i)
    record.t.push_back(duration * static_cast<double>(i) / static_cast<double>(rows - 1));
  return record;
}

FrictionRecord driven(const Element& law, const FreeRig& rig, double force, double velocity, std::size_t rows) {
  constexpr double periods = 8.0;
  const auto& plant = rig.plant;
  const double mobility = plant.C_v.dot(plant.B_F), w = 0.05 * force * mobility / velocity;
  FrictionRecord record = rows_until(RecordKind::free, periods * 2.0 * std::numbers::pi / w, rows);
  const double by_input = force * mobility / plant.C_v.dot(plant.B_u);
  for (const double t : record.t) record.F.push_back(by_input * (0.6 + 1.6 * t / record.t.back()) * std::sin(w * t));
  const double speed = 10.0 * velocity / plant.C_v.dot(state_at(plant, 0.0, 1.0));
  const Eigen::Vector2d sizes = state_at(plant, std::abs(speed) / w, std::abs(speed)).cwiseAbs();
  return moved(law, std::move(record), rig, Eigen::Vector2d::Zero(), sizes);
}

FrictionRecord let_go(const Element& law, const FreeRig& rig, double force, double velocity, std::size_t rows) {
  const auto& plant = rig.plant;
  const double mobility = plant.C_v.dot(plant.B_F), to_speed = plant.C_v.dot(state_at(plant, 0.0, 1.0));
  const double small = 1e-6, stiffness = -(pull_at(rig, small) - pull_at(rig, -small)) / (2.0 * small);
  if (!(stiffness * to_speed > 0.0)) {  // nothing draws it back
    const double v = 30.0 * velocity, duration = 1.5 * v / (force * mobility);
    const Eigen::Vector2d start = state_at(plant, 0.0, v / to_speed);
    return moved(law, rows_until(RecordKind::free_decay, duration, rows), rig, start,
                 state_at(plant, v * duration / to_speed, v / to_speed).cwiseAbs());
  }
  const double wanted = 10.0 * force / std::abs(stiffness), y = plant.gravity ? std::min(wanted, 1.0) : wanted;
  const double ratio = std::abs(pull_at(rig, y) - pull_at(rig, 0.0)) / force;
  if (ratio < 2.0) throw std::invalid_argument("its friction holds the rig wherever it is let go");
  const double w = std::sqrt(stiffness * mobility / to_speed);
  const double duration = (0.25 * ratio + 1.5) * 2.0 * std::numbers::pi / w;
  return moved(law, rows_until(RecordKind::free_decay, duration, rows), rig, state_at(plant, y, 0.0),
               state_at(plant, 2.0 * y, 2.0 * w * y).cwiseAbs());
}

void add_noise(std::vector<double>& values, double share, RandomStream& random) {
  double largest = 0.0;
  for (const double one : values) largest = std::max(largest, std::abs(one - values.front()));
  for (double& one : values) one += share * largest * gsl_cdf_ugaussian_Pinv(random.uniform());
}

}  // namespace

std::vector<FrictionRecord> synthesize_free(const Element& law, const FreeRig& rig, const RigFaults& faults,
                                            std::uint64_t seed, std::size_t rows) {
  if (const auto why = why_no_free_rig(rig.plant)) throw std::invalid_argument("the plant " + *why);
  const Scales own = law.scales();
  const double velocity = std::isfinite(own.velocity) ? own.velocity : 1e-3;
  std::vector<FrictionRecord> records{driven(law, rig, own.output, velocity, rows),
                                      let_go(law, rig, own.output, velocity, rows)};
  for (std::size_t i = 0; i < records.size(); ++i) {
    RandomStream random{seed, "synthesize-free", i};
    add_noise(records[i].x, faults.noise, random);
    add_noise(records[i].v, faults.noise, random);
    if (!(faults.quantum > 0.0)) continue;
    for (double& x : records[i].x) x = faults.quantum * std::round(x / faults.quantum);
    records[i].v.clear();
  }
  return records;
}

}  // namespace limcycle
