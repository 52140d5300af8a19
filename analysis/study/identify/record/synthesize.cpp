#include "limcycle/analysis/study/identify/record/synthesize.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"
#include "limcycle/analysis/study/identify/record/friction_response.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;

/// Rows over the times of a smooth motion.
FrictionRecord along(RecordKind kind, double duration, std::size_t rows, const std::function<double(double)>& x,
                     const std::function<double(double)>& v) {
  FrictionRecord record{kind, std::string(to_string(kind)), {}, {}, {}, std::vector<double>(rows, 1.0), 0.0};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = duration * static_cast<double>(i) / static_cast<double>(rows - 1);
    record.t.push_back(t);
    record.x.push_back(x(t));
    record.v.push_back(v(t));
  }
  return record;
}

/// Replaces the forces by those of the law.
void set_forces(const Element& law, FrictionRecord& record) {
  const PreparedRecord prepared = prepare(record, false);
  std::vector<double> forces;
  if (!response_of(law, {})->run(law, prepared, forces, nullptr, 4.0))
    throw std::invalid_argument("the law could not be driven through the motion of a record");
  for (std::size_t k = 0; k < forces.size(); ++k) record.F[prepared.compared[k].row] = forces[k];
}

struct RigScales {
  double velocity, displacement, force;
};

/// Displacement over which the force rises from 0 to sliding: doubled until more of it changes the force by 5 % at
/// most.
double distance_to_sliding(const Element& law, double first, double velocity) {
  for (double x = first;; x *= 2.0) {
    const double T = 2.0 * x / velocity;
    FrictionRecord ramp = along(
        RecordKind::pre_sliding, T, 21, [&](double t) { return velocity * t; }, [&](double) { return velocity; });
    set_forces(law, ramp);
    if (std::abs(ramp.F[20] - ramp.F[10]) <= 0.05 * std::abs(ramp.F[20]) || x > 1e3 * first) return x;
  }
}

RigScales scales_of(const Element& law) {
  const Scales own = law.scales();
  RigScales result{own.velocity, own.displacement, own.output};
  if (!std::isfinite(result.velocity)) result.velocity = 1e-3;
  if (!std::isfinite(result.displacement)) {
    result.displacement = 1e-5;
    return result;
  }
  result.displacement = distance_to_sliding(law, result.displacement, 0.05 * result.velocity);
  return result;
}

FrictionRecord steady_velocities(const RigScales& rig) {
  FrictionRecord record{RecordKind::steady_velocity, "steady-velocity", {}, {}, {}, {}, 0.0};
  constexpr int each_way = 30;
  for (const double sign : {1.0, -1.0})
    for (int i = 0; i < each_way; ++i)
      record.v.push_back(sign * 0.05 * rig.velocity * std::pow(600.0, i / (each_way - 1.0)));
  record.F.assign(record.v.size(), 1.0);
  return record;
}

FrictionRecord varying_velocity(const RigScales& rig) {
  const double w = rig.velocity / rig.displacement, mean = 2.0 * rig.velocity, swing = 1.8 * rig.velocity;
  return along(
      RecordKind::lag, 4.0 * 2.0 * pi / w, 801,
      [=](double t) { return mean * t + swing / w * (1.0 - std::cos(w * t)); },
      [=](double t) { return mean + swing * std::sin(w * t); });
}

FrictionRecord growing_oscillation(const RigScales& rig) {
  constexpr double periods = 5.0;
  const double largest = 1.5 * rig.displacement, w = 0.5 * rig.velocity / largest, T = periods * 2.0 * pi / w;
  const auto amplitude = [=](double t) { return largest * (0.1 + 0.9 * t / T); };
  return along(
      RecordKind::pre_sliding, T, 1001, [=](double t) { return amplitude(t) * std::sin(w * t); },
      [=](double t) { return amplitude(t) * w * std::cos(w * t) + 0.9 * largest / T * std::sin(w * t); });
}

/// Nothing if it is stopped.
std::optional<FrictionRecord> force_ramp(const Element& law, const RigScales& rig, const std::function<bool()>& stop) {
  constexpr std::size_t rows = 601;
  const double T = 20.0 * rig.displacement / rig.velocity, duration = 2.0 * T;
  ForcedOptions options;
  options.mass = 0.05 * rig.force * T / rig.velocity;
  options.duration = duration;
  options.rtol = 1e-8;
  options.stop = stop;
  for (std::size_t i = 0; i < rows; ++i)
    options.samples.push_back(duration * static_cast<double>(i) / static_cast<double>(rows - 1));
  const ForcedRun run = run_forced(law, signal_through({0.0, duration}, {0.0, 2.0 * rig.force}), options);
  if (run.status == Status::interrupted) return std::nullopt;
  if (run.status != Status::converged) throw std::invalid_argument("the run to break-away could not be computed");
  FrictionRecord record{RecordKind::break_away, "break-away", {}, {}, {}, {}, 0.0};
  const bool sticks = law.may_stick();
  for (const double t : options.samples) {
    const std::size_t i = run.at(t * (1.0 + 1e-12));
    if (std::abs(run.v[i]) > 6.0 * rig.velocity) break;
    record.t.push_back(t);
    record.x.push_back(run.x[i]);
    record.v.push_back(sticks && std::abs(run.v[i]) < 1e-9 * rig.velocity ? 0.0 : run.v[i]);
    record.F.push_back(run.F[i]);
  }
  return record;
}

double normal(RandomStream& random) { return gsl_cdf_ugaussian_Pinv(random.uniform()); }

/// Takes the rows a little later or earlier than they say; velocity and force are straight lines from row to row.
void add_jitter(FrictionRecord& record, double jitter, RandomStream& random) {
  const FrictionRecord clean = record;
  const std::size_t last = clean.t.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double late = jitter * std::clamp(normal(random), -2.0, 2.0);  // in rows
    const std::size_t k = late < 0.0 ? std::max<std::size_t>(i, 1) - 1 : std::min(i + 1, last);
    record.v[i] = std::lerp(clean.v[i], clean.v[k], std::abs(late));
    record.F[i] = std::lerp(clean.F[i], clean.F[k], std::abs(late));
    record.x[i] += std::abs(late) * (clean.t[k] - clean.t[i]) * 0.5 * (clean.v[i] + record.v[i]);
  }
}

void add_faults(FrictionRecord& record, const RigFaults& faults, RandomStream random) {
  double largest = 0.0;
  for (const double F : record.F) largest = std::max(largest, std::abs(F));
  const bool moving = !record.t.empty();
  if (moving && faults.jitter > 0.0) add_jitter(record, faults.jitter, random);
  const auto n = static_cast<double>(record.F.size());
  const auto path = moving ? std::ranges::minmax(record.x) : std::ranges::minmax_result<double>{0.0, 0.0};
  for (std::size_t i = 0; i < record.F.size(); ++i) {
    double share = faults.noise * normal(random);
    if (moving) share += faults.drift * static_cast<double>(i) / n;
    if (moving && path.max > path.min)
      share += faults.ripple * std::sin(40.0 * pi * (record.x[i] - path.min) / (path.max - path.min));
    record.F[i] += largest * share;
  }
  if (moving && faults.quantum > 0.0) {
    for (double& x : record.x) x = faults.quantum * std::round(x / faults.quantum);
    record.v.clear();
  }
}

}  // namespace

std::vector<FrictionRecord> synthesize(const Element& law, const RigFaults& faults, std::uint64_t seed,
                                       const std::function<bool()>& stop) {
  response_of(law, {});  // refuses other kinds
  const RigScales rig = scales_of(law);
  std::vector<FrictionRecord> records{steady_velocities(rig), varying_velocity(rig), growing_oscillation(rig)};
  for (auto& record : records) set_forces(law, record);
  auto ramp = force_ramp(law, rig, stop);
  if (!ramp) return {};
  records.push_back(std::move(*ramp));
  for (std::size_t i = 0; i < records.size(); ++i) add_faults(records[i], faults, {seed, "synthesize", i});
  return records;
}

}  // namespace limcycle
