#include "limcycle/analysis/orbit/cycle/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// y at a time within the run: the cubic through values and rates.
class Curve {
 public:
  explicit Curve(const Trace& trace) : trace_(trace) {}

  double operator()(double t) const {
    const auto after = std::ranges::upper_bound(trace_.t, t);
    const auto i = static_cast<std::size_t>(after - trace_.t.begin());
    if (i == 0) return trace_.y.front();
    if (i == trace_.t.size()) return trace_.y.back();
    const OutputStep step = piece(i - 1);
    return step.value((t - step.t) / step.h);
  }

  /// y at the turning point next to a sample, in a step before or after it; at the first and the last sample y itself.
  double turn_near(std::size_t i) const {
    if (i == 0 || i + 1 == trace_.t.size()) return trace_.y[i];
    for (const std::size_t k : {i - 1, i})
      if (trace_.rate[k] * trace_.rate[k + 1] < 0.0 && trace_.t[k + 1] > trace_.t[k]) return piece(k).turning().y;
    return trace_.y[i];
  }

  /// Time between samples `from` and `to` at which y first reaches `level`.
  double reaches(double level, std::size_t from, std::size_t to) const {
    for (std::size_t i = from; i < to; ++i)
      if ((trace_.y[i] - level) * (trace_.y[i + 1] - level) <= 0.0) return piece(i).crossing(level);
    return trace_.t[to];
  }

 private:
  OutputStep piece(std::size_t i) const {
    return OutputStep::through(trace_.t[i], trace_.t[i + 1], trace_.y[i], trace_.y[i + 1], trace_.rate[i],
                               trace_.rate[i + 1]);
  }

  const Trace& trace_;
};

/// The times at which y is halfway from one turning point to the next; reversals by less than `least` do not count.
std::vector<double> middles(const Trace& trace, double least) {
  std::vector<std::size_t> turns{0};
  std::size_t high = 0, low = 0;
  int direction = 0;
  for (std::size_t i = 1; i < trace.y.size(); ++i) {
    if (trace.y[i] > trace.y[high]) high = i;
    if (trace.y[i] < trace.y[low]) low = i;
    if (direction >= 0 && trace.y[high] - trace.y[i] > least) {
      if (direction > 0) turns.push_back(high);
      direction = -1;
      low = i;
    } else if (direction <= 0 && trace.y[i] - trace.y[low] > least) {
      if (direction < 0) turns.push_back(low);
      direction = 1;
      high = i;
    }
  }
  const Curve curve(trace);
  std::vector<double> times;
  for (std::size_t k = 0; k + 1 < turns.size(); ++k)
    times.push_back(
        curve.reaches(0.5 * (curve.turn_near(turns[k]) + curve.turn_near(turns[k + 1])), turns[k], turns[k + 1]));
  return times;
}

/// Delay of the second motion, as a function of the time of the first one.
class Shift {
 public:
  Shift(std::vector<double> first, const std::vector<double>& second) : times_(std::move(first)) {
    times_.resize(std::min(times_.size(), second.size()));
    for (std::size_t k = 0; k < times_.size(); ++k) late_.push_back(second[k] - times_[k]);
    times_.insert(times_.begin(), 0.0);
    late_.insert(late_.begin(), 0.0);
  }

  double operator()(double t) const {
    const auto i = static_cast<std::size_t>(std::ranges::upper_bound(times_, t) - times_.begin());
    if (i == 0) return late_.front();
    if (i == times_.size()) return late_.back();
    const double part = (t - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return (1.0 - part) * late_[i - 1] + part * late_[i];
  }

  double largest() const {
    double found = 0.0;
    for (const double late : late_) found = std::max(found, std::abs(late));
    return found;
  }

 private:
  std::vector<double> times_, late_;
};

double range(const Trace& trace) {
  const auto [low, high] = std::ranges::minmax(trace.y);
  return high - low;
}

/// Change of y below the resolution of a run's absolute tolerances.
double blur(const Loop& loop, double rtol) {
  const State atol = loop_weights(loop, rtol).atol;
  double sum = 0.0;
  for (Eigen::Index i = 0; i < loop.C_y.size(); ++i) sum += std::abs(loop.C_y(i)) * atol[static_cast<std::size_t>(i)];
  return sum;
}

void compare_motions(Agreement& found, const Trace& one, const Trace& two, double size) {
  const double least = 2.0 * alike * size;
  const Shift late(middles(one, least), middles(two, least));
  const Curve second(two);
  const double end = std::min(one.t.back(), two.t.back());
  found.phase_drift = late.largest();
  found.end_difference = std::abs(Curve(one)(end) - second(end)) / size;
  for (std::size_t i = 0; i < one.t.size(); ++i) {
    const double t = one.t[i] + late(one.t[i]);
    if (t > end) break;
    const double difference = std::abs(one.y[i] - second(t)) / size;
    found.position_difference = std::max(found.position_difference, difference);
    if (difference > alike && std::isnan(found.parted)) found.parted = one.t[i];
  }
}

/// Contradiction between the outcomes of the runs, as a sentence; empty if there is none. An undecided outcome
/// contradicts none.
std::string other_verdict(const Agreement& found, const Simulation& run) {
  if (run.outcome == Outcome::undecided || found.outcome == Outcome::undecided) return {};
  if (run.outcome != found.outcome)
    return "this run comes to " + std::string(to_string(run.outcome)) + ", the second one to " +
           std::string(to_string(found.outcome));
  if (found.period_difference > same_cycle || found.amplitude_difference > same_cycle)
    return "the cycles differ by " + short_number(100.0 * found.period_difference, 2) + " % in period and " +
           short_number(100.0 * found.amplitude_difference, 2) + " % in amplitude";
  return {};
}

void judge(Agreement& found, const Simulation& run) {
  found.why = other_verdict(found, run);
  found.verdict_agrees = found.why.empty();
  if (found.status != Status::converged)
    found.why = "the second run ended with status " + std::string(to_string(found.status));
  else if (!std::isnan(found.parted) && found.why.empty())
    found.why = "y parts from that of the second run at t = " + short_number(found.parted) + " s";
  found.agrees = found.why.empty();
}

}  // namespace

double other_tolerance(double rtol) { return rtol >= 1e-10 ? std::min(0.01 * rtol, 1e-7) : 100.0 * rtol; }

Agreement agreement(const Loop& loop, SimulateOptions options, const Simulation& run, double rtol) {
  const double told = std::exchange(options.rtol, rtol);
  options.watch = {};
  options.delay_band *= 2.0;
  const Simulation second = simulate(loop, options);
  Agreement found;
  found.rtol = rtol;
  found.steps = second.steps;
  found.status = second.status;
  found.outcome = second.outcome;
  found.period_difference = found.amplitude_difference = found.parted = missing;
  if (run.outcome == Outcome::cycle && second.outcome == Outcome::cycle) {
    found.period_difference = std::abs(second.period / run.period - 1.0);
    found.amplitude_difference = std::abs(second.amplitude / run.amplitude - 1.0);
  }
  // A body that hardly moves: deviations within the tolerances do not count.
  const double size = std::max(range(run.trace), 1e3 * blur(loop, std::max(told, rtol)));
  compare_motions(found, run.trace, second.trace, size);
  judge(found, run);
  return found;
}

Agreement agreement(const Loop& loop, const SimulateOptions& options, const Simulation& run) {
  return agreement(loop, options, run, other_tolerance(options.rtol));
}

}  // namespace limcycle
