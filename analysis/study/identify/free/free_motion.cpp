#include "limcycle/analysis/study/identify/free/free_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

/// y and its rate for a state: the rows C_y and C_y A.
Eigen::Matrix2d reading_of(const PlantModel& plant) {
  Eigen::Matrix2d rows;
  rows.row(0) = plant.C_y;
  rows.row(1) = plant.C_y * plant.A;
  return rows;
}

/// Value and first two derivatives of a least-squares parabola at the time of a row.
struct LocalParabola {
  double value = 0.0, slope = 0.0, bend = 0.0;
};

/// Through the rows from `first` to `last` (three at least), about row i.
LocalParabola parabola_about(const std::vector<double>& t, const std::vector<double>& values, std::size_t i,
                             std::size_t first, std::size_t last) {
  const double scale = std::max(t[last] - t[i], t[i] - t[first]);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t k = first; k <= last; ++k) {
    const double s = (t[k] - t[i]) / scale;
    const Eigen::Vector3d powers(1.0, s, s * s);
    normal += powers * powers.transpose();
    right += powers * (values[k] - values[i]);
  }
  const Eigen::Vector3d at = normal.inverse() * right;
  return {values[i] + at(0), at(1) / scale, 2.0 * at(2) / (scale * scale)};
}

std::vector<LocalParabola> smoothed(const std::vector<double>& t, const std::vector<double>& values, std::size_t half) {
  std::vector<LocalParabola> result;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::size_t first = std::min(i < half ? 0 : i - half, t.size() - 3);
    result.push_back(parabola_about(t, values, i, first, std::max(std::min(i + half, t.size() - 1), first + 2)));
  }
  return result;
}

/// How often the rig turns: sign changes of a rate between values beyond a fifth of the largest.
std::size_t turns_of(const std::vector<double>& rates) {
  double largest = 0.0;
  for (const double one : rates) largest = std::max(largest, std::abs(one));
  std::size_t turns = 0;
  double last = 0.0;
  for (const double one : rates) {
    if (std::abs(one) < 0.2 * largest) continue;
    if (one * last < 0.0) ++turns;
    last = one;
  }
  return turns;
}

/// Position with velocity and acceleration, read off the rows.
struct Reading {
  std::vector<double> y, rate, acceleration;
};

Reading with_half_width(const FrictionRecord& record, std::size_t half) {
  Reading result;
  if (!record.x.empty())
    for (const auto& one : smoothed(record.t, record.x, half)) {
      result.y.push_back(one.value);
      result.rate.push_back(one.slope);
      result.acceleration.push_back(one.bend);
    }
  if (record.v.empty()) return result;
  const auto rates = smoothed(record.t, record.v, half);
  result.rate.clear();
  result.acceleration.clear();
  for (const auto& one : rates) {
    result.rate.push_back(one.value);
    result.acceleration.push_back(one.slope);
  }
  for (std::size_t i = 0; record.x.empty() && i < rates.size(); ++i)
    result.y.push_back(
        i == 0 ? 0.0 : result.y.back() + 0.5 * (record.t[i] - record.t[i - 1]) * (result.rate[i] + result.rate[i - 1]));
  return result;
}

Reading reading_off(const FrictionRecord& record) {
  constexpr std::size_t narrow = 2, wide = 200, parts_of_a_swing = 8;
  const std::size_t n = record.t.size();
  const std::size_t turns = turns_of(with_half_width(record, std::clamp(n / 50, narrow, wide)).rate);
  const std::size_t half = std::min(n / 20, n / (2 * parts_of_a_swing * (turns + 1)));
  return with_half_width(record, std::clamp(half, narrow, wide));
}

double gravity_of(const PlantModel& plant, const Eigen::Vector2d& state) {
  if (!plant.gravity) return 0.0;
  return plant.gravity->output({plant.C_gravity.dot(state), 0.0, 0.0}, {}, {});
}

/// The friction force that the equation of motion leaves at each row, and the velocity of rubbing.
struct LeftOver {
  std::vector<double> force, speed;
};

LeftOver left_over(const FreeRig& rig, const FrictionRecord& record, const Reading& reading) {
  const auto& plant = rig.plant;
  const Eigen::Matrix2d to_state = reading_of(plant).inverse();
  LeftOver found;
  for (std::size_t i = 0; i < reading.y.size(); ++i) {
    const Eigen::Vector2d x = to_state * Eigen::Vector2d(reading.y[i], reading.rate[i]);
    const Eigen::Vector2d rate = to_state * Eigen::Vector2d(reading.rate[i], reading.acceleration[i]);
    const double u = rig.load + (record.F.empty() ? 0.0 : record.F[i]);
    Eigen::Vector2d own = plant.A * x + plant.B_u * u;
    if (plant.gravity) own -= plant.B_gravity * gravity_of(plant, x);
    found.force.push_back(plant.C_v.dot(own - rate) / plant.C_v.dot(plant.B_F));
    found.speed.push_back(plant.C_v.dot(x) + plant.v0);
  }
  return found;
}

/// Root mean square of the friction force.
double friction_size(const FreeRig& rig, const FrictionRecord& record, const Reading& reading) {
  double sum = 0.0;
  for (const double force : left_over(rig, record, reading).force) sum += force * force;
  return std::sqrt(sum / static_cast<double>(reading.y.size()));
}

/// What is left of a friction force at rest: the constant part of its least-squares fit by that, a level in the
/// direction of motion and a slope, over the rows at which the body moves.
double force_at_rest(const LeftOver& all) {
  constexpr double moves = 0.05;
  double fastest = 0.0;
  for (const double v : all.speed) fastest = std::max(fastest, std::abs(v));
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < all.force.size(); ++i) {
    const double v = all.speed[i] / fastest;
    if (!(std::abs(v) > moves)) continue;
    const Eigen::Vector3d terms(1.0, v < 0.0 ? -1.0 : 1.0, v);
    normal += terms * terms.transpose();
    right += terms * all.force[i];
  }
  return normal.fullPivLu().solve(right)(0);
}

/// Positions that were only integrated from velocities begin anywhere: moves them to where no friction force is left at
/// rest. A body without a spring or a weight has no such place, and needs none.
void place(Reading& reading, const FreeRig& rig, const FrictionRecord& record) {
  constexpr int iterations = 4;  // a weight bends the force
  constexpr double nothing = 1e-9;
  const auto moved_by = [&](double shift) {
    Reading moved = reading;
    for (double& y : moved.y) y += shift;
    return moved;
  };
  const auto [low, high] = std::ranges::minmax(reading.y);
  double step = high - low;
  for (int i = 0; i < iterations && step > 0.0; ++i, step *= 0.1) {
    const double here = force_at_rest(left_over(rig, record, reading)),
                 there = force_at_rest(left_over(rig, record, moved_by(step)));
    if (!(std::abs(there - here) > nothing * friction_size(rig, record, reading))) return;
    reading = moved_by(-here * step / (there - here));
  }
}

/// Cuts the motion into windows of about that many samples, each of which begins at the fastest stop near the equal
/// share. Windows have no sample in common.
std::vector<FreeWindow> cut(const FreeMotion& motion, std::size_t count) {
  const auto& plant = motion.rig.plant;
  const auto speed = [&](std::size_t i) { return std::abs(plant.C_v.dot(motion.states[i]) + plant.v0); };
  const std::size_t n = motion.stops.size();
  std::vector<std::size_t> starts{0};
  for (std::size_t k = 1; k < count; ++k) {
    const std::size_t nominal = k * n / count, reach = n / (4 * count);
    std::size_t best = nominal;
    for (std::size_t i = nominal - reach; i <= nominal + reach; ++i)
      if (speed(i) > speed(best)) best = i;
    starts.push_back(best);
  }
  std::vector<FreeWindow> windows;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    FreeWindow window;
    window.first = starts[k];
    window.last = (k + 1 < starts.size() ? starts[k + 1] : n) - 1;
    window.start = motion.states[window.first];
    window.sliding = speed(window.first) > 0.02 * motion.rubbing_speed;
    windows.push_back(window);
  }
  return windows;
}

std::shared_ptr<const FreeMotion> motion_of(const FrictionRecord& record, const FreeRig& rig, const Reading& reading,
                                            std::size_t every) {
  auto motion = std::make_shared<FreeMotion>();
  motion->rig = rig;
  motion->holds_force = record.holds_force;
  const Eigen::Matrix2d to_state = reading_of(rig.plant).inverse();
  std::size_t usable = 0;
  std::ptrdiff_t sample = 0;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(infinite), high = -low;
  for (std::size_t i = 0; i < record.t.size(); ++i) {
    FreeStop stop{record.t[i] - record.t.front(), rig.load + (record.F.empty() ? 0.0 : record.F[i]), -1};
    if (stop.t >= record.skip && !is_weightless(record, i) && usable++ % every == 0) stop.sample = sample++;
    const bool bends = !record.F.empty() || i == 0;
    if (stop.sample < 0 && !bends) continue;
    motion->stops.push_back(stop);
    motion->states.emplace_back(to_state * Eigen::Vector2d(reading.y[i], reading.rate[i]));
    low = low.cwiseMin(motion->states.back());
    high = high.cwiseMax(motion->states.back());
    motion->rubbing_speed =
        std::max(motion->rubbing_speed, std::abs(rig.plant.C_v.dot(motion->states.back()) + rig.plant.v0));
  }
  motion->state_sizes = high - low;
  constexpr std::size_t samples_a_window = 40, most_windows = 25;
  motion->whole = cut(*motion, 1);
  motion->pieces = cut(*motion, std::clamp<std::size_t>(motion->samples() / samples_a_window, 1, most_windows));
  return motion;
}

PreparedRecord series_of(const FrictionRecord& record, MeasuredQuantity quantity,
                         const std::shared_ptr<const FreeMotion>& motion) {
  PreparedRecord result;
  result.kind = record.kind;
  result.name = record.name;
  result.quantity = quantity;
  result.motion = motion;
  const auto& plant = motion->rig.plant;
  const auto& values = quantity == MeasuredQuantity::position ? record.x : record.v;
  for (std::size_t i = 0, k = 0; k < motion->stops.size(); ++i) {
    const auto& stop = motion->stops[k];
    if (record.t[i] - record.t.front() < stop.t) continue;
    const double x = plant.C_x.dot(motion->states[k] - motion->states.front());
    const double v = plant.C_v.dot(motion->states[k]) + plant.v0;
    ++k;
    if (stop.sample < 0) continue;
    result.compared.push_back({i, v, values[i], stop.t, x});
    const double size = quantity == MeasuredQuantity::position ? values[i] - values.front() : values[i];
    result.size = std::max(result.size, std::abs(size));
    result.displacement = std::max(result.displacement, std::abs(x));
    if (v == 0.0) continue;
    result.slowest = result.slowest == 0.0 ? std::abs(v) : std::min(result.slowest, std::abs(v));
    result.fastest = std::max(result.fastest, std::abs(v));
  }
  result.duration = record.t.back() - record.t.front();
  weigh_rows(record, result.compared);
  return result;
}

}  // namespace

std::size_t FreeMotion::samples() const {
  return static_cast<std::size_t>(std::ranges::count_if(stops, [](const FreeStop& one) { return one.sample >= 0; }));
}

std::optional<std::string> why_no_free_rig(const PlantModel& plant) {
  if (plant.measured) return "is known by its frequency response only; free motions need a plant with equations";
  if (plant.delay > 0.0) return "has a dead time, with which free motions are not fitted";
  if (plant.A.rows() != 2)
    return "has " + std::to_string(plant.A.rows()) +
           " states; free motions are fitted for plants with two, which a measured position determines";
  if (plant.B_F.size() == 0 || !(plant.C_v.dot(plant.B_F) > 0.0)) return "has no body that rubs";
  const double size = plant.C_y.norm() * plant.B_u.norm();
  if (std::abs(plant.C_y.dot(plant.B_u)) > 1e-12 * size || std::abs(plant.C_y.dot(plant.B_F)) > 1e-12 * size)
    return "moves y at once under a force; free motions need a body with a mass";
  const Eigen::Matrix2d rows = reading_of(plant);
  if (std::abs(rows.determinant()) < 1e-12 * rows.row(0).norm() * rows.row(1).norm())
    return "has a state that y and dy/dt do not show";
  return std::nullopt;
}

std::vector<PreparedRecord> prepare_free(const FrictionRecord& record, const FreeRig& rig) {
  check_in_time(record, record.t.size());
  constexpr std::size_t most_rows = 100'000;
  if (record.t.size() > most_rows)
    refuse_record(record, "has " + std::to_string(record.t.size()) +
                              " rows; a free motion, which is simulated many times, may have 100000: keep every n-th");
  if (record.kind == RecordKind::free && record.F.empty()) refuse_record(record, "needs a force column");
  Reading reading = reading_off(record);
  if (record.x.empty()) place(reading, rig, record);
  std::size_t skipped = 0;
  for (const double t : record.t) skipped += t - record.t.front() < record.skip ? 1 : 0;
  const std::size_t usable = record.t.size() - skipped, every = (usable + most_compared - 1) / most_compared;
  if (usable < 10) refuse_record(record, "has fewer than ten rows after skip");
  const auto motion = motion_of(record, rig, reading, every);
  std::vector<PreparedRecord> result;
  if (!record.x.empty()) result.push_back(series_of(record, MeasuredQuantity::position, motion));
  if (!record.v.empty()) result.push_back(series_of(record, MeasuredQuantity::velocity, motion));
  for (auto& series : result) {
    if (series.size == 0.0) refuse_record(record, "the body does not move");
    series.largest_force = friction_size(rig, record, reading);
  }
  if (!(motion->rubbing_speed > 0.0)) refuse_record(record, "the body does not move");
  if (skipped > 0)
    result.front().notes.push_back(std::to_string(skipped) + (skipped == 1 ? " row was" : " rows were") +
                                   " left out: within skip");
  if (every > 1)
    result.front().notes.push_back("of " + std::to_string(usable) + " rows every " + std::to_string(every) +
                                   "th is compared; the force of all of them moves the rig");
  return result;
}

}  // namespace limcycle
