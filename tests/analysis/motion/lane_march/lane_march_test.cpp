#include "limcycle/analysis/motion/lane_march/lane_march.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <new>
#include <random>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/lane_march/lane_loop.hpp"
#include "limcycle/analysis/motion/steppers/rodas5p.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

const LaneKernels& kernels_of(Isa isa) {
  return isa == Isa::avx512 ? avx512_lane_kernels : isa == Isa::avx2 ? avx2_lane_kernels : scalar_lane_kernels;
}

struct Case {
  Loop loop;
  State start;
};

/// A loop of n linear states with random numbers, of which a third is 0.
Case random_case(std::mt19937_64& bits, int n) {
  const auto number = [&bits] {
    return bits() % 3 == 0 ? 0.0 : std::uniform_real_distribution<double>(-3.0, 3.0)(bits);
  };
  Case made;
  Loop& loop = made.loop;
  loop.A = Eigen::MatrixXd::NullaryExpr(n, n, number);
  loop.A_delayed.setZero(n, n);
  loop.B = Eigen::MatrixXd::NullaryExpr(n, 1, number);
  loop.E = Eigen::Matrix<double, Eigen::Dynamic, 4>::NullaryExpr(n, 4, number);
  loop.C_y = Eigen::RowVectorXd::NullaryExpr(n, number);
  loop.external << 1.0, number(), number(), number();
  loop.elements.emplace_back(test::lugre());
  Port port;
  port.C = port.C_delayed = Eigen::RowVectorXd::Zero(n);
  port.D = port.D_v = Eigen::RowVectorXd::Zero(1);
  port.C_v = -loop.B.transpose();  // friction brakes
  port.c.setZero();
  port.c_v << number(), 0.0, 0.0, 0.0;
  port.rubs = true;
  loop.ports.push_back(port);
  for (int i = 0; i < n; ++i) made.start.push_back(number());
  made.start.push_back(1e-5 * number());
  return made;
}

/// One step of length h in lanes, one case per lane, for any error.
std::vector<State> step_in_lanes(Isa isa, const std::vector<Case>& cases, double h) {
  const LaneKernels& kernels = kernels_of(isa);
  const int n = static_cast<int>(cases[0].loop.states()), lanes = kernels.lanes;
  const LaneRows at{n};
  const auto size = sizeof(double) * static_cast<std::size_t>(at.count() * lanes);
  auto* rows = static_cast<double*>(::operator new(size, std::align_val_t(64)));
  for (int lane = 0; lane < lanes; ++lane) {
    const Case& one = cases[static_cast<std::size_t>(lane)];
    write_lane(one.loop, {1e-6, State(one.start.size(), 1e12)}, one.start, rows + lane, lanes);
    const auto put = [&](int row, double value) { rows[row * lanes + lane] = value; };
    put(LaneRows::step, h);
    put(LaneRows::end, infinite);
    put(LaneRows::ceiling, infinite);
    put(LaneRows::level, infinite);
    put(LaneRows::most_steps, 1.0);  // an event after one step
    put(LaneRows::active, 1.0);
  }
  LaneBatch batch{rows, 0, true};
  kernel_for(kernels, *lane_shape(cases[0].loop))(batch);
  std::vector<State> ends(static_cast<std::size_t>(lanes));
  for (int lane = 0; lane < lanes; ++lane) {
    CHECK(rows[LaneRows::time * lanes + lane] == h);
    CHECK((static_cast<int>(rows[LaneRows::event * lanes + lane]) & lane_budget) != 0);
    const auto i = static_cast<std::size_t>(lane);
    read_lane(cases[i].loop, rows + lane, lanes, at.state(), ends[i]);
  }
  CHECK(batch.attempts == 1);
  ::operator delete(rows, std::align_val_t(64));
  return ends;
}

State step_alone(const Case& one, double h) {
  LoopField field(one.loop);
  State end;
  Rodas5p().do_step(
      std::pair([&](const State& x, State& dx, double t) { field.rate(x, dx, t); },
                [&](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) { field.jacobian(x, J, t, dfdt); }),
      one.start, 0.0, end, h);
  return end;
}

void check_steps(Isa isa, const std::vector<Case>& cases, double h) {
  const auto ends = step_in_lanes(isa, cases, h);
  for (std::size_t lane = 0; lane < ends.size(); ++lane) {
    const State expected = step_alone(cases[lane], h);
    double largest = 1.0;  // of the linear states
    for (std::size_t i = 0; i + 1 < expected.size(); ++i) largest = std::max(largest, std::abs(expected[i]));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CAPTURE(static_cast<int>(isa), lane, i, h);
      const double size = i + 1 < expected.size() ? largest : 1e-5 + std::abs(expected[i]);
      CHECK(std::abs(ends[lane][i] - expected[i]) < 1e-9 * size);
    }
  }
}

}  // namespace

TEST_CASE("A step in lanes is a step of RODAS5P, whatever the loop") {
  std::mt19937_64 bits(3);
  for (const Isa isa : all_isas()) {
    if (!is_available(isa)) continue;
    for (int n = LaneKernels::fewest_states; n <= LaneKernels::most_states; ++n)
      for (const double h : {1e-6, 1e-4, 2e-3}) {
        std::vector<Case> cases;
        cases.reserve(static_cast<std::size_t>(kernels_of(isa).lanes));
        for (int lane = 0; lane < kernels_of(isa).lanes; ++lane) cases.push_back(random_case(bits, n));
        check_steps(isa, cases, h);
      }
  }
}

TEST_CASE("Every lane chooses its own pivots: one that vanishes in some lanes does no harm") {
  std::mt19937_64 bits(4);
  const double h = 0.01, diagonal = 1.0 / (rodas5p::gamma * h);
  for (const Isa isa : all_isas()) {
    if (!is_available(isa)) continue;
    std::vector<Case> cases;
    for (int lane = 0; lane < kernels_of(isa).lanes; ++lane) {
      cases.push_back(random_case(bits, 3));
      Loop& loop = cases.back().loop;
      loop.ports[0].C_v.setZero();  // the matrix is I/(gamma h) - A
      loop.ports[0].c_v.setZero();
      if (lane % 2 == 1) continue;
      loop.A(0, 0) = diagonal;  // no pivot at all in the first place
      loop.A(0, 1) = loop.A(1, 0) = diagonal;
    }
    check_steps(isa, cases, h);
  }
}
