#include "limcycle/analysis/frequency/roots/root_polish.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multiroots.h>

#include <Eigen/LU>
#include <cmath>
#include <exception>
#include <memory>

namespace limcycle {
namespace {

using Complex = std::complex<double>;

// The equations in units of the cell: x = (p - guess.p) / scale_p, and so on.
class ScaledEquations {
 public:
  ScaledEquations(const PlaneFunction& f, const RootGuess& guess, double step) : f_(f), guess_(guess), step_(step) {}

  Eigen::Vector2d value(const Eigen::Vector2d& x) const {
    const Complex f = f_(p(x), q(x));
    return {f.real(), f.imag()};
  }
  Eigen::Matrix2d jacobian(const Eigen::Vector2d& x) const {
    Eigen::Matrix2d out;
    for (Eigen::Index k = 0; k < 2; ++k) {
      const Eigen::Vector2d h = step_ * Eigen::Vector2d::Unit(k);
      out.col(k) = (value(x + h) - value(x - h)) / (2.0 * step_);
    }
    return out;
  }
  double p(const Eigen::Vector2d& x) const { return guess_.p + x[0] * guess_.scale_p; }
  double q(const Eigen::Vector2d& x) const { return guess_.q + x[1] * guess_.scale_q; }

  std::exception_ptr thrown;  // an exception must not pass through GSL, which is C

 private:
  const PlaneFunction& f_;
  RootGuess guess_;
  double step_;  // of the differences
};

int evaluate(const gsl_vector* x, void* parameters, gsl_vector* f, gsl_matrix* jacobian) {
  auto& equations = *static_cast<ScaledEquations*>(parameters);
  try {
    const Eigen::Vector2d at(gsl_vector_get(x, 0), gsl_vector_get(x, 1));
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() > 8.0) return GSL_EBADFUNC;
    bool finite = true;
    if (f != nullptr) {
      const Eigen::Vector2d value = equations.value(at);
      finite = value.allFinite();
      gsl_vector_set(f, 0, value[0]);
      gsl_vector_set(f, 1, value[1]);
    }
    if (finite && jacobian != nullptr) {
      const Eigen::Matrix2d j = equations.jacobian(at);
      finite = j.allFinite();
      for (std::size_t k = 0; k < 4; ++k) {
        gsl_matrix_set(jacobian, k / 2, k % 2, j(static_cast<Eigen::Index>(k / 2), static_cast<Eigen::Index>(k % 2)));
      }
    }
    return finite ? GSL_SUCCESS : GSL_EBADFUNC;
  } catch (...) {
    equations.thrown = std::current_exception();
    return GSL_EBADFUNC;
  }
}

int evaluate_f(const gsl_vector* x, void* parameters, gsl_vector* f) { return evaluate(x, parameters, f, nullptr); }
int evaluate_df(const gsl_vector* x, void* parameters, gsl_matrix* j) { return evaluate(x, parameters, nullptr, j); }
int evaluate_fdf(const gsl_vector* x, void* parameters, gsl_vector* f, gsl_matrix* j) {
  return evaluate(x, parameters, f, j);
}

// Powell's hybrid iteration from x = 0; returns nothing if it meets NaN, diverges or stops far from a zero.
std::optional<Eigen::Vector2d> hybrid(ScaledEquations& equations) {
  static const bool handler_off = [] {
    gsl_set_error_handler_off();
    return true;
  }();
  static_cast<void>(handler_off);
  using Solver = std::unique_ptr<gsl_multiroot_fdfsolver, decltype(&gsl_multiroot_fdfsolver_free)>;
  using Vector = std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)>;
  const Solver solver(gsl_multiroot_fdfsolver_alloc(gsl_multiroot_fdfsolver_hybridsj, 2), gsl_multiroot_fdfsolver_free);
  const Vector start(gsl_vector_calloc(2), gsl_vector_free);
  gsl_multiroot_function_fdf system = {evaluate_f, evaluate_df, evaluate_fdf, 2, &equations};
  int status = gsl_multiroot_fdfsolver_set(solver.get(), &system, start.get());
  for (int k = 0; k < 40 && status == GSL_SUCCESS; ++k) {
    status = gsl_multiroot_fdfsolver_iterate(solver.get());
    // the last digits are left to Newton's steps, whose Jacobian is needed anyway
    if (status == GSL_SUCCESS && gsl_multiroot_test_delta(solver->dx, solver->x, 1e-7, 0.0) == GSL_SUCCESS) break;
  }
  if (equations.thrown) std::rethrow_exception(equations.thrown);
  if (status == GSL_EBADFUNC) return std::nullopt;
  return Eigen::Vector2d(gsl_vector_get(solver->x, 0), gsl_vector_get(solver->x, 1));
}

// One attempt, with a given step of the differences (in units of the cell).
std::optional<PolishedRoot> attempt(const PlaneFunction& f, const RootGuess& guess, double noise, double step) {
  ScaledEquations equations(f, guess, step);
  const auto found = hybrid(equations);
  if (!found || !(found->cwiseAbs().maxCoeff() <= 2.0)) return std::nullopt;
  Eigen::Vector2d x = *found;
  const Eigen::Matrix2d jacobian = equations.jacobian(x);
  const double determinant = jacobian.determinant();
  const double uncertainty = noise / step * (jacobian.col(0).norm() + jacobian.col(1).norm());
  if (!(std::abs(determinant) > 2.0 * uncertainty)) return std::nullopt;
  const Eigen::Matrix2d inverse = jacobian.inverse();
  if (noise * inverse.cwiseAbs().rowwise().sum().maxCoeff() > 0.5) return std::nullopt;
  Eigen::Vector2d value = equations.value(x), newton = inverse * value;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Vector2d next = x - newton, next_value = equations.value(next);
    if (!(next_value.norm() < value.norm())) break;
    x = next;
    value = next_value;
    newton = inverse * value;
  }
  const Eigen::Vector2d scale(guess.scale_p, guess.scale_q);
  const bool settled = newton.cwiseAbs().maxCoeff() <= 0.1 && newton.cwiseProduct(scale).cwiseAbs().maxCoeff() <= 1e-6;
  if (!settled) return std::nullopt;
  return PolishedRoot{equations.p(x), equations.q(x), jacobian * scale.cwiseInverse().asDiagonal()};
}

}  // namespace

std::optional<PolishedRoot> polish_root(const PlaneFunction& f, const RootGuess& guess, double noise) {
  const auto precise = attempt(f, guess, noise, 1e-3);
  return precise ? precise : attempt(f, guess, noise, 0.3);
}

}  // namespace limcycle
