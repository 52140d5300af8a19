/// @file
/// Boost.Odeint on the hunting servo. C++17: uBLAS of Boost 1.74, under rosenbrock4, does not compile as C++20.
///   stepping_odeint REFERENCE
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_dense_output.hpp>

#include "limcycle/bench/servo.hpp"
#include "limcycle/bench/stepping.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
namespace ublas = boost::numeric::ublas;
using bench::Positions;
using Servo = bench::Servo<double>;
using State = std::array<double, 4>;

std::vector<double> sample_times() {
  std::vector<double> times;
  for (int k = 0; k <= bench::stepping_samples; ++k) times.push_back(bench::sample_time(k));
  return times;
}

/// Odeint's own integrate function: dense steppers interpolate at the samples, controlled ones step to them.
template <class Stepper, class System, class Vector>
std::vector<double> at_samples(Stepper stepper, System system, Vector y) {
  static const std::vector<double> times = sample_times();
  std::vector<double> x;
  x.reserve(times.size());
  odeint::integrate_times(stepper, system, y, times.begin(), times.end(), 1e-6,
                          [&](const Vector& state, double) { x.push_back(state[1]); });
  x.erase(x.begin());
  return x;
}

template <class Make>
Positions explicit_run(double sigma0, Make&& make) {
  Servo servo(sigma0);
  State y{};
  std::copy(std::begin(Servo::start), std::end(Servo::start), y.begin());
  const auto rate = [&](const State& state, State& d, double) { servo.rate(state, d); };
  Positions run;
  run.x = at_samples(make(), rate, y);
  run.evaluations = servo.evaluations;
  return run;
}

Positions rosenbrock(double sigma0, double tolerance) {
  using Vector = ublas::vector<double>;
  using Matrix = ublas::matrix<double>;
  Servo servo(sigma0);
  Vector y(4);
  std::copy(std::begin(Servo::start), std::end(Servo::start), y.begin());
  Positions run;
  run.x = at_samples(odeint::make_dense_output<odeint::rosenbrock4<double>>(tolerance, tolerance),
                     bench::stiff_system<Vector, Matrix>(servo), y);
  run.evaluations = servo.evaluations;
  return run;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  for (const auto& [sigma0, reference] : bench::read_reference(arguments[1])) {
    const auto ladder = [&, s = sigma0, &x = reference](const char* name, double least, auto&& make) {
      bench::stepping_ladder(name, s, x, least, [&](double stiffness, double tolerance) {
        return explicit_run(stiffness, [&] { return make(tolerance); });
      });
    };
    bench::stepping_ladder("odeint rosenbrock4", sigma0, reference, 1e-12, rosenbrock);
    ladder("odeint dopri5 dense", 1e-11, [](double tolerance) {
      return odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<State>());
    });
    ladder("odeint dopri5 controlled", 1e-11, [](double tolerance) {
      return odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<State>());
    });
    ladder("odeint fehlberg78", 1e-11, [](double tolerance) {
      return odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>());
    });
    ladder("odeint bulirsch_stoer", 1e-11,
           [](double tolerance) { return odeint::bulirsch_stoer<State>(tolerance, tolerance); });
  }
}
