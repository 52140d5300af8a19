/// @file
/// GSL odeiv2 on the hunting servo, with its driver and a tolerance for each component.
///   stepping_gsl REFERENCE
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <memory>

#include "limcycle/bench/servo.hpp"
#include "limcycle/bench/stepping.hpp"

namespace {

using bench::Positions;
using Servo = bench::Servo<double>;

int rate(double, const double y[], double d[], void* servo) {
  try {
    static_cast<Servo*>(servo)->rate(y, d);
    return GSL_SUCCESS;
  } catch (const bench::GaveUp&) {
    return GSL_EBADFUNC;  // stops the driver; an exception must not pass through C
  }
}

int jacobian(double, const double y[], double* J, double dfdt[], void* servo) {
  std::fill(J, J + 16, 0.0);
  std::fill(dfdt, dfdt + 4, 0.0);
  static_cast<Servo*>(servo)->jacobian(y, [&](int i, int j, double value) { J[4 * i + j] = value; });
  return GSL_SUCCESS;
}

Positions march(const gsl_odeiv2_step_type* type, double sigma0, double tolerance) {
  Servo servo(sigma0);
  gsl_odeiv2_system system{rate, jacobian, 4, &servo};
  const std::unique_ptr<gsl_odeiv2_driver, void (*)(gsl_odeiv2_driver*)> driver(
      gsl_odeiv2_driver_alloc_y_new(&system, type, 1e-6, tolerance, tolerance), gsl_odeiv2_driver_free);
  double y[4], t = 0.0;
  std::copy(std::begin(Servo::start), std::end(Servo::start), y);
  Positions run;
  for (int k = 1; k <= bench::stepping_samples; ++k) {
    const int status = gsl_odeiv2_driver_apply(driver.get(), &t, bench::sample_time(k), y);
    if (servo.evaluations > servo.most_evaluations) throw bench::GaveUp(servo.most_evaluations);
    if (status != GSL_SUCCESS) throw std::runtime_error(std::string("failed: ") + gsl_strerror(status));
    run.x.push_back(y[1]);
  }
  run.evaluations = servo.evaluations;
  return run;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  gsl_set_error_handler_off();
  for (const auto& [sigma0, reference] : bench::read_reference(arguments[1])) {
    const auto ladder = [&, s = sigma0, &x = reference](const char* name, const gsl_odeiv2_step_type* type,
                                                        double least) {
      bench::stepping_ladder(name, s, x, least,
                             [type](double stiffness, double tolerance) { return march(type, stiffness, tolerance); });
    };
    ladder("gsl msbdf", gsl_odeiv2_step_msbdf, 1e-13);
    ladder("gsl bsimp", gsl_odeiv2_step_bsimp, 1e-11);
    ladder("gsl rk8pd", gsl_odeiv2_step_rk8pd, 1e-11);
  }
}
