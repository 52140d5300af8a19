/// @file
/// SUNDIALS on the hunting servo: CVODE (BDF and Adams) and ARKODE (implicit Runge-Kutta of order 5), dense solver,
/// analytic Jacobian.
///   stepping_sundials REFERENCE
#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "limcycle/bench/servo.hpp"
#include "limcycle/bench/stepping.hpp"

namespace {

using bench::Positions;
using Servo = bench::Servo<double>;

int rate(realtype, N_Vector y, N_Vector d, void* servo) {
  try {
    static_cast<Servo*>(servo)->rate(N_VGetArrayPointer(y), N_VGetArrayPointer(d));
    return 0;
  } catch (const bench::GaveUp&) {
    return -1;
  }
}

int jacobian(realtype, N_Vector y, N_Vector, SUNMatrix J, void* servo, N_Vector, N_Vector, N_Vector) {
  SUNMatZero(J);
  static_cast<Servo*>(servo)->jacobian(N_VGetArrayPointer(y),
                                       [&](int i, int j, double value) { SM_ELEMENT_D(J, i, j) = value; });
  return 0;
}

void require(int flag, const char* call, const Servo& servo) {
  if (servo.evaluations > servo.most_evaluations) throw bench::GaveUp(servo.most_evaluations);
  if (flag < 0) throw std::runtime_error(std::string("failed: ") + call + " " + std::to_string(flag));
}

/// Vectors, matrix and solvers of one run.
struct Workspace {
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  SUNNonlinearSolver fixed_point = nullptr;

  Workspace() {
    SUNContext_Create(nullptr, &context);
    y = N_VNew_Serial(4, context);
    std::copy(std::begin(Servo::start), std::end(Servo::start), N_VGetArrayPointer(y));
    matrix = SUNDenseMatrix(4, 4, context);
    linear = SUNLinSol_Dense(y, matrix, context);
    fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
  }
  ~Workspace() {
    SUNNonlinSolFree(fixed_point);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(y);
    SUNContext_Free(&context);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
};

/// `advance(t, y)` -> flag integrates to t.
template <class Advance>
Positions sampled(Servo& servo, N_Vector y, const char* call, Advance&& advance) {
  Positions run;
  for (int k = 1; k <= bench::stepping_samples; ++k) {
    require(advance(bench::sample_time(k)), call, servo);
    run.x.push_back(N_VGetArrayPointer(y)[1]);
  }
  run.evaluations = servo.evaluations;
  return run;
}

Positions cvode(int method, double sigma0, double tolerance) {
  Servo servo(sigma0);
  Workspace work;
  struct Solver {
    void* memory;
    ~Solver() { CVodeFree(&memory); }
  } solver{CVodeCreate(method, work.context)};
  CVodeSetErrFile(solver.memory, nullptr);
  CVodeInit(solver.memory, rate, 0.0, work.y);
  CVodeSStolerances(solver.memory, tolerance, tolerance);
  CVodeSetUserData(solver.memory, &servo);
  CVodeSetMaxNumSteps(solver.memory, 1L << 40);
  CVodeSetMaxErrTestFails(solver.memory, 50);
  CVodeSetMaxConvFails(solver.memory, 50);
  if (method == CV_BDF) {
    CVodeSetLinearSolver(solver.memory, work.linear, work.matrix);
    CVodeSetJacFn(solver.memory, jacobian);
    CVodeSetJacEvalFrequency(solver.memory, 1);  // a new Jacobian for every factorisation saves up to a fifth here
  } else {
    CVodeSetNonlinearSolver(solver.memory, work.fixed_point);
  }
  return sampled(servo, work.y, "CVode", [&](double until) {
    double t = 0.0;
    return CVode(solver.memory, until, work.y, &t, CV_NORMAL);
  });
}

/// Newton's method needs a tight tolerance and a new Jacobian: with the defaults the error stays at 1e-4.
Positions arkode(double sigma0, double tolerance) {
  Servo servo(sigma0);
  Workspace work;
  struct Solver {
    void* memory;
    ~Solver() { ARKStepFree(&memory); }
  } solver{ARKStepCreate(nullptr, rate, 0.0, work.y, work.context)};
  ARKStepSetErrFile(solver.memory, nullptr);
  ARKStepSStolerances(solver.memory, tolerance, tolerance);
  ARKStepSetUserData(solver.memory, &servo);
  ARKStepSetMaxNumSteps(solver.memory, 1L << 40);
  ARKStepSetMaxErrTestFails(solver.memory, 50);
  ARKStepSetMaxConvFails(solver.memory, 50);
  ARKStepSetOrder(solver.memory, 5);
  ARKStepSetLinearSolver(solver.memory, work.linear, work.matrix);
  ARKStepSetJacFn(solver.memory, jacobian);
  ARKStepSetJacEvalFrequency(solver.memory, 1);
  ARKStepSetLSetupFrequency(solver.memory, 1);
  ARKStepSetNonlinConvCoef(solver.memory, 1e-2);
  return sampled(servo, work.y, "ARKStepEvolve", [&](double until) {
    double t = 0.0;
    return ARKStepEvolve(solver.memory, until, work.y, &t, ARK_NORMAL);
  });
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  for (const auto& [sigma0, reference] : bench::read_reference(arguments[1])) {
    bench::stepping_ladder("cvode bdf", sigma0, reference, 1e-12,
                           [](double s, double tolerance) { return cvode(CV_BDF, s, tolerance); });
    bench::stepping_ladder("cvode adams", sigma0, reference, 1e-11,
                           [](double s, double tolerance) { return cvode(CV_ADAMS, s, tolerance); });
    bench::stepping_ladder("arkode dirk5", sigma0, reference, 1e-12, arkode);
  }
}
