#include "limcycle/reports/figures/drawing/decimate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;

TEST_CASE("a thinned trace keeps ends, extremes and corners") {
  const Trace trace = sample::stick_slip_trace(1.0, 24.0, 40001);
  const Decimated kept = decimate(trace, 500);
  CHECK(kept.whole);
  CHECK(kept.index.size() <= 510);
  CHECK(kept.index.size() >= 400);
  CHECK(kept.index.front() == 0);
  CHECK(kept.index.back() == trace.t.size() - 1);
  CHECK(std::is_sorted(kept.index.begin(), kept.index.end()));
  const auto greatest = [&](const std::vector<double>& column) {
    double out = 0.0;
    for (const auto i : kept.index) out = std::max(out, column[i]);
    return out / *std::max_element(column.begin(), column.end());
  };
  CHECK(greatest(trace.y) > 0.995);
  CHECK(greatest(trace.rate) > 0.995);
  CHECK(greatest(trace.output) > 0.99);
  // Linear interpolation between the kept samples reproduces the others.
  double worst = 0.0;
  for (std::size_t k = 0; k + 1 < kept.index.size(); ++k) {
    const auto a = kept.index[k], b = kept.index[k + 1];
    for (auto i = a; i <= b; ++i) {
      const double share = (trace.t[i] - trace.t[a]) / (trace.t[b] - trace.t[a]);
      worst = std::max(worst, std::abs(trace.y[i] - (trace.y[a] + share * (trace.y[b] - trace.y[a]))));
    }
  }
  CHECK(worst < 0.01);
}

TEST_CASE("a short trace is kept as it is, an empty one is nothing") {
  const Trace trace = sample::stick_slip_trace(1.0, 1.0, 5);
  CHECK(decimate(trace, 100, {}, 10.0).index == std::vector<std::size_t>{0, 1, 2, 3, 4});
  CHECK(decimate(Trace{}, 100).index.empty());
}

TEST_CASE("of a scribble only the first part is drawn") {
  Trace trace;
  for (int i = 0; i < 100001; ++i) {
    const double t = 0.01 * i;
    trace.t.push_back(t);
    trace.y.push_back(std::sin(t));
    trace.rate.push_back(std::cos(t));
    trace.output.push_back(std::sin(t));
  }
  const Decimated kept = decimate(trace, 1000);
  CHECK_FALSE(kept.whole);
  CHECK(kept.index.size() <= 1001);
  CHECK(kept.index.size() >= 900);
  CHECK(kept.index.back() < trace.t.size() / 2);
}

TEST_CASE("stuck samples last the wanted share of time and are those at rest") {
  const Trace trace = sample::stick_slip_trace(1.0, 8.0, 8001);
  const auto stuck = stuck_samples(trace, 0.5);
  double time = 0.0;
  for (std::size_t i = 0; i + 1 < trace.t.size(); ++i) {
    if (stuck[i] && stuck[i + 1]) time += trace.t[i + 1] - trace.t[i];
    if (stuck[i]) REQUIRE(std::abs(trace.velocity[i]) < 0.01);
  }
  CHECK(time == Approx(4.0).epsilon(0.01));
  const auto none = stuck_samples(trace, 0.0);
  CHECK(std::none_of(none.begin(), none.end(), [](bool one) { return one; }));
}

TEST_CASE("changes that must be kept are kept") {
  const Trace trace = sample::stick_slip_trace(1.0, 8.0, 8001);
  std::vector<bool> marks(8001, false);
  marks[3333] = true;
  const auto kept = decimate(trace, 50, marks, 10.0).index;
  for (const std::size_t i : {3332u, 3333u, 3334u}) CHECK(std::find(kept.begin(), kept.end(), i) != kept.end());
}

TEST_CASE("y is named by where a trace measures it from") {
  Trace trace;
  CHECK(name_of_y(trace) == "y");
  trace.y_origin = 0.3;
  CHECK(name_of_y(trace) == "y - 0.3");
  trace.y_origin = -1250.0;
  CHECK(name_of_y(trace) == "y + 1250");
}
