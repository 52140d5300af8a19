/// @file
/// Reference positions of the hunting servo in long double: Odeint's rosenbrock4 at a tolerance of 1e-15 for every
/// stiffness, checked against itself at 1e-13 and, as far as an explicit method is able, against fehlberg78 (order 8).
///   stepping_reference FILE      writes the file, prints the agreement of the runs
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_dense_output.hpp>
#include <cstdio>

#include "limcycle/bench/servo.hpp"
#include "limcycle/bench/stepping.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
namespace ublas = boost::numeric::ublas;
using Real = long double;

/// Steps to every sample, without interpolation.
template <class Stepper, class System, class State>
std::vector<double> land_on_samples(Stepper stepper, System system, State y, Real first) {
  std::vector<double> x;
  Real dt = first;
  for (int k = 1; k <= bench::stepping_samples; ++k) {
    const Real from = bench::sample_time(k - 1), to = bench::sample_time(k);
    odeint::integrate_adaptive(stepper, system, y, from, to, dt);
    x.push_back(static_cast<double>(y[1]));
  }
  return x;
}

std::vector<double> rosenbrock(double sigma0, Real tolerance) {
  using Vector = ublas::vector<Real>;
  using Matrix = ublas::matrix<Real>;
  bench::Servo<Real> servo(static_cast<Real>(sigma0));
  servo.most_evaluations = 1L << 60;
  Vector y(4);
  for (std::size_t i = 0; i < 4; ++i) y[i] = bench::Servo<Real>::start[i];
  odeint::rosenbrock4_controller<odeint::rosenbrock4<Real>> stepper(tolerance, tolerance);
  return land_on_samples(stepper, bench::stiff_system<Vector, Matrix>(servo), y, Real(1e-6));
}

std::vector<double> fehlberg(double sigma0, Real tolerance) {
  using State = std::array<Real, 4>;
  bench::Servo<Real> servo(static_cast<Real>(sigma0));
  servo.most_evaluations = 1L << 60;
  const auto rate = [&](const State& y, State& d, Real) { servo.rate(y, d); };
  State y{};
  for (std::size_t i = 0; i < 4; ++i) y[i] = bench::Servo<Real>::start[i];
  const auto stepper =
      odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State, Real, State, Real>());
  return land_on_samples(stepper, rate, y, Real(1e-6));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr) return 2;
  for (const double sigma0 : bench::stiffnesses) {
    const auto x = rosenbrock(sigma0, 1e-15L);
    const double own = bench::largest_difference(rosenbrock(sigma0, 1e-13L), x);
    std::printf("reference,sigma0=%.0e,rosenbrock4 long double 1e-13 against 1e-15,%.2e\n", sigma0, own);
    if (sigma0 < 2e6)
      std::printf("reference,sigma0=%.0e,fehlberg78 long double 1e-16 against rosenbrock4,%.2e\n", sigma0,
                  bench::largest_difference(fehlberg(sigma0, 1e-16L), x));
    std::fflush(stdout);
    std::fprintf(file, "%.17g %.3e\n", sigma0, own);
    for (const double value : x) std::fprintf(file, "%.17g\n", value);
  }
  return std::fclose(file) == 0 ? 0 : 2;
}
