#include "limcycle/analysis/motion/field/froude_clearance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace limcycle;

namespace {

using Model = FroudeClearance<double>;

Model model(double clearance) {
  Model m;
  m.pendulum = {.mass = 5.0, .arm = 0.2, .inertia = 0.25, .damping = 0.005, .shaft_radius = 0.02, .shaft_speed = 4.0};
  m.pendulum.clearance = clearance;
  m.contact = {.stiffness = 1e10, .exponent = 1.5, .dissipation = 2.0};
  m.law.Fs = m.law.Fs_minus = 9.0;
  m.law.Fc = m.law.Fc_minus = 7.4;
  m.law.vs = 0.1;
  m.law.sigma0 = 1e5;
  m.law.sigma1 = 100.0;
  m.law.sigma2 = 10.0;
  return m;
}

FroudeOptions options(double duration, double rtol) {
  FroudeOptions o;
  o.duration = duration;
  o.rtol = rtol;
  return o;
}

}  // namespace

TEST_CASE(
    "pendulum with play: the equations are those of Lagrange about the centre of the sleeve, and keep the energy") {
  const Model m = model(1e-4);
  const auto& p = m.pendulum;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const double e = 1.03e-4, at = 3.0 * unit(random);
    const State q{e * std::cos(at),    e * std::sin(at),   2.0 * unit(random),  0.05 * unit(random),
                  0.05 * unit(random), 5.0 * unit(random), 5e-5 * unit(random), 0.0};
    State dq(8);
    m.rate(q, Model::Phase::touching, dq);
    const auto c = m.meet(q, Model::Phase::touching);
    const double fx = -c.normal * c.nx - c.friction * c.ny, fy = -c.normal * c.ny + c.friction * c.nx;
    const double s = std::sin(q[2]), k = std::cos(q[2]), w = q[5], ml = p.mass * p.arm;
    const double torque = -(p.shaft_radius + c.e) * c.friction - p.damping * w;
    CHECK(p.mass * dq[3] + ml * (k * dq[5] - s * w * w) == Approx(fx).margin(1e-9));
    CHECK(p.mass * (dq[4] + p.gravity) + ml * (s * dq[5] + k * w * w) == Approx(fy).margin(1e-9));
    CHECK(p.inertia * dq[5] + ml * (k * dq[3] + s * (dq[4] + p.gravity)) == Approx(torque).margin(1e-9));
    // The energy changes by the work: its derivative along the motion, by a central difference.
    State up = q, down = q;
    for (std::size_t j = 0; j < 8; ++j) {
      up[j] += 1e-8 * dq[j];
      down[j] -= 1e-8 * dq[j];
    }
    const double power = (m.energy(up) - m.energy(down)) / 2e-8;
    CHECK(power == Approx(dq[7]).epsilon(1e-5).margin(1e-4));
  }
}

TEST_CASE("pendulum with play: an impact of Hunt and Crossley follows its first integral") {
  // Along the arm, without spin or friction: m v dv/dd = -K d^n (1 + D v), so that v/D - ln(1 + D v)/D^2 is the same
  // before and after.
  Model m = model(1e-4);
  m.pendulum.gravity = 1e-12;
  m.pendulum.shaft_speed = 0.0;
  for (const double D : {0.5, 2.0, 20.0}) {
    m.contact.dissipation = D;
    State q(8, 0.0);
    q[Model::y] = 2e-5;
    q[Model::y_rate] = -0.1;
    const auto run = march_froude(m, q, options(3e-3, 1e-10));
    REQUIRE(run.status == Status::converged);
    const double after = run.last[Model::y_rate];
    const auto integral = [D](double v) { return v / D - std::log1p(D * v) / (D * D); };
    CAPTURE(D, after);
    CHECK(after > 0.0);
    CHECK(integral(-after) == Approx(integral(0.1)).epsilon(1e-7));
    CHECK(run.losses == 1);
    CHECK(run.last[Model::x] == 0.0);
    CHECK(run.last[Model::angle] == 0.0);
  }
}

TEST_CASE("pendulum with play: without play left it is the rigid one") {
  // The difference falls with the play: e = clearance + penetration widens the arm of the friction and shifts the
  // centre.
  const FroudeRigid<double> rigid{model(1e-4).pendulum, model(1e-4).law};
  const auto reference = march_froude(rigid, {0.5, 0.0, 0.0}, options(3.0, 1e-9));
  std::vector<double> distance;
  for (const double clearance : {1e-4, 2.5e-5}) {
    const Model m = model(clearance);
    const auto run = march_froude(m, resting_sleeve(m, 0.5, 0.0, 0.0), options(3.0, 1e-8));
    REQUIRE(run.status == Status::converged);
    REQUIRE(run.trace.angle.size() == reference.trace.angle.size());
    double most = 0.0;
    for (std::size_t i = 0; i < run.trace.angle.size(); ++i)
      most = std::max(most, std::abs(run.trace.angle[i] - reference.trace.angle[i]));
    distance.push_back(most);
    CHECK(run.energy_error < 1e-6);
  }
  CHECK(distance[0] < 2e-3);
  CHECK(distance[1] < 0.4 * distance[0]);
}

TEST_CASE("pendulum without play: the force at the sleeve is the one that holds it") {
  // N from the quadratic equation against the acceleration of the centre of mass.
  const FroudeRigid<double> rigid{model(1e-4).pendulum, model(1e-4).law};
  const auto& p = rigid.pendulum;
  const State q{0.7, 2.5, -4e-5};
  State dq(3);
  rigid.rate(q, dq);
  const double along = p.mass * (p.arm * q[1] * q[1] + p.gravity * std::cos(q[0]));
  const double across = p.mass * (p.arm * dq[1] + p.gravity * std::sin(q[0]));
  const double N = rigid.normal(q);
  const std::span<const double> z(q.data() + 2, 1);
  const double F = N / (p.mass * p.gravity) * rigid.law.output({0.0, rigid.rubbing(q), 0.0}, {}, z);
  CHECK(N * N + F * F == Approx(along * along + across * across).epsilon(1e-12));
  CHECK(N > 0.0);
}

TEST_CASE("pendulum with play: a rattling sleeve keeps its energy balance to the tolerance") {
  Model m = model(5e-5);
  m.law.Fs = m.law.Fs_minus = 17.0;
  m.law.sigma2 = 1.0;
  std::vector<double> defect;
  for (const double rtol : {1e-6, 1e-9}) {
    const auto run = march_froude(m, resting_sleeve(m, 0.5, 0.0, 0.0), options(0.5, rtol));
    REQUIRE(run.status == Status::converged);
    CHECK(run.losses > 10);
    CHECK(run.time_apart > 0.0);
    defect.push_back(run.energy_error);
  }
  CHECK(defect[0] < 1e-3);
  CHECK(defect[1] < 1e-2 * defect[0]);
}

TEST_CASE("pendulum with play: what cannot be marched is refused") {
  const Model good = model(1e-4);
  const State start = resting_sleeve(good, 0.5, 0.0, 0.0);
  CHECK_THROWS_AS(march_froude(model(0.0), start, options(1.0, 1e-6)), std::invalid_argument);
  CHECK_THROWS_AS(march_froude(good, start, options(0.0, 1e-6)), std::invalid_argument);
  CHECK_THROWS_AS(march_froude(good, start, options(1.0, 1.0)), std::invalid_argument);
  Model light = good;
  light.pendulum.inertia = 0.2;  // mass arm^2
  CHECK_THROWS_AS(march_froude(light, start, options(1.0, 1e-6)), std::invalid_argument);
  FroudeOptions stopped = options(1.0, 1e-6);
  stopped.stop = [] { return true; };
  CHECK(march_froude(good, start, stopped).status == Status::interrupted);
}
