#include "limcycle/analysis/study/tune/squared_error.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace limcycle;

namespace {

/// exp(-d t) cos(w t) sampled at `points` intervals.
Trace decay(double d, double w, double duration, int points) {
  Trace run;
  for (int i = 0; i <= points; ++i) {
    const double t = duration * i / points, e = std::exp(-d * t);
    run.t.push_back(t);
    run.y.push_back(e * std::cos(w * t));
    run.rate.push_back(-e * (d * std::cos(w * t) + w * std::sin(w * t)));
  }
  return run;
}

/// Integral of its square from 0 to T: the cosine squared is (1 + cos 2wt)/2.
double closed_form(double d, double w, double T) {
  const double decayed = std::exp(-2.0 * d * T), c = std::cos(2.0 * w * T), s = std::sin(2.0 * w * T);
  return 0.5 * (1.0 - decayed) / (2.0 * d) +
         0.5 * (2.0 * d + decayed * (2.0 * w * s - 2.0 * d * c)) / (4.0 * d * d + 4.0 * w * w);
}

}  // namespace

TEST_CASE("squared error: a decaying oscillation in closed form, of fourth order, within its error") {
  const double d = 0.3, w = 4.0, T = 7.3, exact = closed_form(d, w, T);
  double before = 0.0;
  for (const int points : {100, 200, 400}) {
    const SquaredError found = squared_error(decay(d, w, T, points), 0.0, T);
    const double error = std::abs(found.value - exact);
    INFO(points << " intervals: " << error << ", estimated " << found.error);
    CHECK(error < 3.0 * found.error);
    CHECK(error > 0.1 * found.error);
    if (before > 0.0) CHECK(std::log2(before / error) == Approx(4.0).margin(0.3));
    before = error;
  }
}

TEST_CASE("squared error: a horizon within a step, one beyond the end, and a reference") {
  const Trace run = decay(0.3, 4.0, 10.0, 1000);
  for (const double T : {0.004, 1.23456, 9.999})
    CHECK(squared_error(run, 0.0, T).value == Approx(closed_form(0.3, 4.0, T)).epsilon(1e-6));
  Trace still;  // y stays where it is, 0.5 beside the origin of the trace
  still.t = {2.0, 3.0};
  still.y = {0.5, 0.5};
  still.rate = {0.0, 0.0};
  still.y_origin = 10.0;
  CHECK(squared_error(still, 12.0, 100.0).value == Approx(1.5 * 1.5 * 100.0).epsilon(1e-12));
  CHECK(squared_error(Trace{}, 1.0, 1.0).value == 0.0);
  CHECK(squared_error(still, 12.0, 0.0).value == 0.0);
}
