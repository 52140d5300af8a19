#include "limcycle/analysis/study/tune/squared_error.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

/// y of the run at a share of the way from sample i to sample k.
double cubic_between(const Trace& run, std::size_t i, std::size_t k, double share) {
  const double h = run.t[k] - run.t[i], s = share, rest = 1.0 - share;
  return rest * rest * ((1.0 + 2.0 * s) * run.y[i] + s * h * run.rate[i]) +
         s * s * ((1.0 + 2.0 * rest) * run.y[k] - rest * h * run.rate[k]);
}

/// From the first sample to `horizon`, over every `stride`-th sample and the last one.
double integral_over(const Trace& run, double reference, double horizon, std::size_t stride) {
  // Gauss' rule with four points is exact for the square of a cubic.
  constexpr double places[] = {0.8611363115940526, 0.3399810435848563};
  constexpr double weights[] = {0.3478548451374538, 0.6521451548625461};
  const double target = reference - run.y_origin, end = run.t.front() + horizon;
  double sum = 0.0;
  const std::size_t last = run.t.size() - 1;
  for (std::size_t i = 0; i < last && run.t[i] < end;) {
    const std::size_t k = std::min(i + stride, last);
    const double h = run.t[k] - run.t[i], used = std::min(h, end - run.t[i]);
    if (h > 0.0) {
      const double part = 0.5 * used / h;
      for (std::size_t j = 0; j < std::size(places); ++j)
        for (const double side : {-1.0, 1.0}) {
          const double e = target - cubic_between(run, i, k, part * (1.0 + side * places[j]));
          sum += 0.5 * used * weights[j] * e * e;
        }
    }
    i = k;
  }
  const double stays = target - run.y.back();
  return sum + std::max(end - run.t.back(), 0.0) * stays * stays;
}

}  // namespace

SquaredError squared_error(const Trace& run, double reference, double horizon) {
  if (run.t.empty() || !(horizon > 0.0)) return {};
  const double fine = integral_over(run, reference, horizon, 1), coarse = integral_over(run, reference, horizon, 2);
  return {fine, std::abs(fine - coarse) / 15.0};
}

}  // namespace limcycle
