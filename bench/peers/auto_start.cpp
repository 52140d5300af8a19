/// @file
/// Start orbits for AUTO-07p, converged: one period after many, at the variable steps of a tight integration.
///   auto_start servo|van-der-pol      lines "t U(1) ... U(n)" on stdout
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <cstdio>
#include <string>

#include "limcycle/bench/servo.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
namespace ublas = boost::numeric::ublas;
using Vector = ublas::vector<double>;
using Matrix = ublas::matrix<double>;

template <class System>
void print_orbit(System system, Vector y, const Vector& units, double period, int periods) {
  odeint::rosenbrock4_controller<odeint::rosenbrock4<double>> stepper(1e-11, 1e-11);
  odeint::integrate_adaptive(stepper, system, y, 0.0, period * periods, 1e-6);
  odeint::rosenbrock4_controller<odeint::rosenbrock4<double>> last(1e-9, 1e-9);
  odeint::integrate_adaptive(last, system, y, 0.0, period, 1e-6, [&](const Vector& state, double t) {
    std::printf("%.15e", t);
    for (std::size_t i = 0; i < state.size(); ++i) std::printf(" %.15e", state[i] * units[i]);
    std::printf("\n");
  });
}

void servo_orbit() {
  bench::Servo<double> servo(1e5);
  Vector y(4);
  for (std::size_t i = 0; i < 4; ++i) y[i] = bench::Servo<double>::start[i];
  Vector units(4, 1.0);
  units[2] = servo.vs;
  print_orbit(bench::stiff_system<Vector, Matrix>(servo), y, units, 24.436786455993, 12);
}

void van_der_pol_orbit() {
  const double mu = 5.0;
  const auto rate = [&](const Vector& y, Vector& d, double) {
    d[0] = y[1];
    d[1] = mu * (1.0 - y[0] * y[0]) * y[1] - y[0];
  };
  const auto jacobian = [&](const Vector& y, Matrix& J, double, Vector& dfdt) {
    dfdt.clear();
    J(0, 0) = 0.0;
    J(0, 1) = 1.0;
    J(1, 0) = -2.0 * mu * y[0] * y[1] - 1.0;
    J(1, 1) = mu * (1.0 - y[0] * y[0]);
  };
  Vector y(2);
  y[0] = 2.0;
  y[1] = 0.0;
  print_orbit(std::make_pair(rate, jacobian), y, Vector(2, 1.0), 11.612230667713, 6);
}

}  // namespace

int main(int count, char** arguments) {
  const std::string which = count == 2 ? arguments[1] : "";
  if (which == "servo")
    servo_orbit();
  else if (which == "van-der-pol")
    van_der_pol_orbit();
  else
    return 2;
}
