#include "limcycle/analysis/study/precision/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace limcycle {
namespace {

Quality judge(const Attempt& attempt) {
  if (attempt.gave_up) return Quality::too_slow;
  if (!attempt.answered) return Quality::failed;
  if (attempt.of_another_kind) return Quality::wrong;
  if (!std::isfinite(attempt.error)) return Quality::failed;
  return attempt.error <= right_within ? Quality::right : Quality::biased;
}

WorkPoint point_of(const WorkMethod& method, std::size_t setting, const Attempt& attempt) {
  WorkPoint point;
  point.method = method.name;
  point.setting = method.settings[setting];
  point.quality = judge(attempt);
  point.status = attempt.status;
  if (attempt.answered && std::isfinite(attempt.error)) point.error = attempt.error;
  if (attempt.answered && std::isfinite(attempt.state_error)) point.state_error = attempt.state_error;
  point.evaluations = attempt.evaluations;
  point.unit = method.unit;
  point.why = attempt.why;
  if (point.why.empty() && point.quality == Quality::failed)
    point.why = "ended with status " + std::string(to_string(attempt.status));
  return point;
}

}  // namespace

std::string_view to_string(Quality quality) {
  switch (quality) {
    case Quality::right:
      return "right";
    case Quality::biased:
      return "biased";
    case Quality::wrong:
      return "wrong";
    case Quality::too_slow:
      return "too slow";
    default:
      return "failed";
  }
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<WorkPoint> run_method(const WorkMethod& method, const WorkOptions& options) {
  const auto stopped = [&] { return options.stop && options.stop(); };
  std::vector<WorkPoint> points;
  for (std::size_t i = 0; i < method.settings.size() && !stopped(); ++i) {
    double least = std::numeric_limits<double>::infinity(), together = 0.0;
    Attempt first;
    for (int k = 0; k < std::max(1, options.repeats) && (k == 0 || (together < options.repeat_within && !stopped()));
         ++k) {
      const double begin = cpu_seconds();
      Attempt attempt = method.attempt(i);
      const double passed = cpu_seconds() - begin;
      together += passed;
      if (attempt.status == Status::interrupted) break;
      least = std::min(least, std::max(0.0, passed - attempt.measuring));
      if (k == 0) first = std::move(attempt);
    }
    if (!std::isfinite(least)) break;  // interrupted in its first run
    points.push_back(point_of(method, i, first));
    points.back().seconds = least;
    if (options.done) options.done();
  }
  return points;
}

std::vector<std::size_t> pareto_front(const std::vector<WorkPoint>& points, double floor) {
  const auto error = [&](std::size_t i) { return std::max(points[i].error, floor); };
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].charted()) order.push_back(i);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return points[a].seconds != points[b].seconds ? points[a].seconds < points[b].seconds : error(a) < error(b);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || error(i) < error(front.back())) front.push_back(i);
  return front;
}

std::size_t cheapest(const std::vector<WorkPoint>& points, double error) {
  std::size_t best = points.size();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].charted() && points[i].error <= error &&
        (best == points.size() || points[i].seconds < points[best].seconds))
      best = i;
  return best;
}

}  // namespace limcycle
