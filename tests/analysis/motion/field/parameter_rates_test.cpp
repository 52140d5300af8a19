#include "limcycle/analysis/motion/field/parameter_rates.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/steppers/transition.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Loop belt_at(double speed, Element friction) {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, speed};
  parts.friction = std::move(friction);
  return build_loop(parts);
}

}  // namespace

TEST_CASE("rates of the equations by a parameter of the law: closed form") {
  // m v' = -k y - F, F = sigma0 z + sigma1 z' + sigma2 v, z' = v - sigma0 |v| z/g: by sigma0.
  const auto law = [](double sigma0) {
    auto made = lugre();
    made.sigma0 = sigma0;
    return made;
  };
  const double sigma0 = 1e5, step = 0.1, v = 2e-3, z = 8e-6;
  const Loop loop = servo(law(sigma0));
  const std::vector<ParameterNeighbours> pairs{{servo(law(sigma0 - step)), servo(law(sigma0 + step)), step, sigma0}};
  ParameterRates rates(loop, pairs);
  LoopField field(loop);
  State x(field.size(), 0.0), dx, time;
  const auto& port = loop.ports.back();
  Eigen::Index speed = 0;
  REQUIRE(port.C_v.cwiseAbs().maxCoeff(&speed) == 1.0);
  x[static_cast<std::size_t>(speed)] = v;
  x[field.first_state(0)] = z;
  Eigen::MatrixXd J, columns;
  field.rate(x, dx, 0.0);
  field.jacobian(x, J, 0.0, time);
  rates.rates(field, x, J, 0.0, columns);
  REQUIRE(columns.cols() == 1);
  const double g = 1.0 + 0.5 * std::exp(-4.0), of_bristle = -v * z / g;
  const double of_force = z + std::sqrt(1e5) * of_bristle;
  CHECK(columns(static_cast<Eigen::Index>(field.first_state(0)), 0) == Approx(of_bristle).epsilon(1e-8));
  CHECK(columns(speed, 0) == Approx(-of_force).epsilon(1e-8));
}

TEST_CASE("rates of the equations by the speed of a belt: each side of the kink at v = 0 keeps to itself") {
  // z' = w - sigma0 |w| z/g(w), w = v - V: d/dV = -1 + sigma0 sgn(w) z/g + ..., however small w is.
  const double V = 0.1, step = 1e-7, z = 5e-6;
  const Loop loop = belt_at(V, lugre());
  const std::vector<ParameterNeighbours> pairs{{belt_at(V - step, lugre()), belt_at(V + step, lugre()), step, V}};
  ParameterRates rates(loop, pairs);
  LoopField field(loop);
  for (const double w : {1e-12, -1e-12, 1e-9, -1e-9}) {
    State x(field.size(), 0.0), dx, time;
    Eigen::Index speed = 0;
    loop.ports.back().C_v.cwiseAbs().maxCoeff(&speed);
    x[static_cast<std::size_t>(speed)] = V + w;
    x[field.first_state(0)] = z;
    Eigen::MatrixXd J, columns;
    field.jacobian(x, J, 0.0, time);
    field.rate(x, dx, 0.0);
    rates.rates(field, x, J, 0.0, columns);
    const double expected = -1.0 + 1e5 * (w > 0.0 ? 1.0 : -1.0) * z / 1.5;
    CAPTURE(w);
    CHECK(columns(static_cast<Eigen::Index>(field.first_state(0)), 0) == Approx(expected).epsilon(1e-7));
    const auto rub = rates.rubbing(field, x, 0.0);
    REQUIRE(rub);
    CHECK(rub->velocity == Approx(w).margin(1e-16));
    CHECK(rub->by_parameters(0) == Approx(-1.0).epsilon(1e-8));
  }
}

TEST_CASE("a switch by a parameter: break-away waits for the level, and the body starts with what is beyond Fc") {
  const auto parts = [](double Fs, double Fc) { return servo(coulomb(Fs, Fc, 0.4)); };
  const double step = 1e-6;
  const Loop loop = parts(1.5, 1.0);
  const std::vector<ParameterNeighbours> pairs{{parts(1.5 - step, 1.0), parts(1.5 + step, 1.0), step, 1.5},
                                               {parts(1.5, 1.0 - step), parts(1.5, 1.0 + step), step, 1.0}};
  ParameterRates rates(loop, pairs);
  LoopField field(loop);
  // At rest at y with the drive Fs: kp y + ki int = -1.5 in the sign of the loop. Scaled to that from any state.
  State x(field.size(), 0.0), dx;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (loop.ports[0].C_v(static_cast<Eigen::Index>(i)) == 0.0) x[i] = 0.01;
  field.start(x, 0.0);
  field.rate(x, dx, 0.0);
  const double scale = 1.5 / std::abs(field.output(0));
  for (double& value : x) value *= scale;
  field.rate(x, dx, 0.0);
  REQUIRE(std::abs(field.output(0)) == Approx(1.5));
  std::vector<double> guards;
  field.guards(x, 0.0, guards);
  const auto fired = static_cast<std::size_t>(std::ranges::min_element(guards) - guards.begin());
  const auto before = field.modes();
  State after = x;
  SwitchSlopes slopes;
  REQUIRE(field.fire(after, 0.0, fired, slopes));
  const auto modes = field.modes();
  field.modes() = before;
  field.rate(x, dx, 0.0);
  const auto at = rates.at_switch(field, x, 0.0, fired, slopes, modes);
  REQUIRE(at);
  CHECK(at->guard(0) == Approx(1.0).epsilon(1e-8));  // the guard is Fs less the drive
  CHECK(std::abs(at->guard(1)) < 1e-8);
  // A later start by 1/(guard rate) at the acceleration (Fs - Fc)/m: the velocity missing then.
  Eigen::Index speed = 0;
  loop.ports[0].C_v.cwiseAbs().maxCoeff(&speed);
  const double acceleration = slopes.after(speed);
  CHECK(std::abs(acceleration) == Approx(0.5));
  CHECK(at->jump(speed, 0) == Approx(acceleration / slopes.crossing).epsilon(1e-8));
  CHECK(std::abs(at->jump(speed, 1)) < 1e-8);
}

TEST_CASE("a forcing along a step: columns beside the transition, of order 5 for a constant Jacobian") {
  // s' = J s + b, s(0) = 0: s(h) = J^-1 (exp(J h) - 1) b, by a step of half the length for the order.
  const Loop loop = forward(saturation(100.0), {1.0}, {1.0, 0.6, 2.0});
  LoopField field(loop);
  State x(field.size(), 0.1);
  field.start(x, 0.0);
  const auto n = static_cast<Eigen::Index>(field.size());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  Eigen::MatrixXd J;
  State time, dx;
  field.jacobian(x, J, 0.0, time);
  field.rate(x, dx, 0.0);
  const auto error = [&](double h) {
    Step step;
    step.t1 = h;
    step.x0 = step.x1 = x;
    step.dx0 = step.dx1 = dx;
    const Eigen::MatrixXd both =
        transition(field, step, 1, [&](const State&, const Eigen::MatrixXd&, double, Eigen::MatrixXd& c) { c = b; });
    REQUIRE(both.cols() == n + 1);
    CHECK(both.leftCols(n) == transition(field, step));
    Eigen::MatrixXd term = h * Eigen::MatrixXd::Identity(n, n), sum = term;
    for (int k = 2; k < 40; ++k) {
      term = (term * J * (h / k)).eval();
      sum += term;
    }
    return (both.col(n) - sum * b).norm();
  };
  const double coarse = error(0.4), fine = error(0.2);
  CHECK(coarse < 1e-3);
  CHECK(coarse > 25.0 * fine);
}

TEST_CASE("neighbours in a parameter that do not fit are refused, and a corner of the linear part is seen") {
  const Loop loop = servo(lugre());
  const auto made = [&](double step) {
    const std::vector<ParameterNeighbours> pairs{{loop, loop, step, 1.0}};
    return ParameterRates(loop, pairs).count();
  };
  CHECK(made(1e-6) == 1);
  CHECK_THROWS_AS(made(0.0), std::invalid_argument);
  CHECK_THROWS_AS(made(INFINITY), std::invalid_argument);
  const std::vector<ParameterNeighbours> other{{servo(coulomb(1.5, 1.0)), loop, 1e-6, 1.0}};
  CHECK_THROWS_AS(ParameterRates(loop, other), std::invalid_argument);

  const auto lag = [](double a) { return forward(saturation(1.0), {1.0}, {1.0, a, 1.0}); };
  for (const auto& [a, least, most] : {std::tuple(1.0, 0.1, 1.5), {0.7, 0.0, 1e-4}, {1.3, 0.0, 1e-4}}) {
    const Loop here = lag(a);
    const std::vector<ParameterNeighbours> pairs{{lag(a - 1e-6), lag(a + 1e-6), 1e-6, a}};
    const double bend = ParameterRates(here, pairs).bend(0);
    CAPTURE(a);
    CHECK(bend >= least);
    CHECK(bend <= most);
  }
}
