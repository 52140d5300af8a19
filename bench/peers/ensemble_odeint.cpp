/// @file
/// Random servos, one at a time with Boost.Odeint, and their final positions as a reference.
///   ensemble_odeint FILE      writes the reference
#include <array>
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_dense_output.hpp>

#include "limcycle/bench/ensemble.hpp"
#include "limcycle/bench/measure.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
namespace ublas = boost::numeric::ublas;
using Servo = bench::Servo<double>;

double rosenbrock(Servo servo, double tolerance) {
  using Vector = ublas::vector<double>;
  using Matrix = ublas::matrix<double>;
  Vector y(4);
  for (std::size_t i = 0; i < 4; ++i) y[i] = Servo::start[i];
  odeint::rosenbrock4_controller<odeint::rosenbrock4<double>> stepper(tolerance, tolerance);
  odeint::integrate_adaptive(stepper, bench::stiff_system<Vector, Matrix>(servo), y, 0.0, bench::ensemble_duration,
                             1e-6);
  return y[1];
}

double dopri5(Servo servo, double tolerance) {
  using State = std::array<double, 4>;
  const auto rate = [&](const State& y, State& d, double) { servo.rate(y, d); };
  State y{};
  for (std::size_t i = 0; i < 4; ++i) y[i] = Servo::start[i];
  odeint::integrate_adaptive(odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<State>()), rate,
                             y, 0.0, bench::ensemble_duration, 1e-6);
  return y[1];
}

template <class March>
void measure(const char* name, double tolerance, const std::vector<Servo>& servos, const std::vector<double>& reference,
             March&& march) {
  bench::Row row{"ensembles", "random servos", name, bench::short_power(tolerance), 0.0};
  const double begin = bench::cpu_seconds();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double error = std::abs(march(servos[i], tolerance) - reference[i]);
    if (!(error <= row.error)) row.error = error;
  }
  row.seconds = (bench::cpu_seconds() - begin) / static_cast<double>(reference.size());
  bench::print(row);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const auto servos = bench::random_servos();
  std::vector<double> reference;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr) return 2;
  for (int i = 0; i < bench::ensemble_checked; ++i) {
    reference.push_back(rosenbrock(servos[static_cast<std::size_t>(i)], 1e-12));
    std::fprintf(file, "%.17g\n", reference.back());
  }
  std::fclose(file);
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9})
    measure("odeint rosenbrock4 one by one", tolerance, servos, reference, rosenbrock);
  for (const double tolerance : {1e-6, 1e-8}) measure("odeint dopri5 one by one", tolerance, servos, reference, dopri5);
}
