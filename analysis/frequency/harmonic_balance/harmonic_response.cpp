#include "limcycle/analysis/frequency/harmonic_balance/harmonic_response.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/argument_error.hpp"
#include "limcycle/analysis/frequency/describing_function/df_undefined.hpp"
#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/analysis/frequency/march/response_derivative.hpp"

namespace limcycle {

static_assert(ElementHarmonics::finest + 1 == static_cast<int>(quadrature_meshes.size()));

namespace {

/// Harmonics 0..orders from the sums over a pass.
HarmonicResponse collect(const HarmonicSums& sums, int orders, const PeriodicState& periodic, bool half_wave) {
  HarmonicResponse result;
  result.status = periodic.status;
  if (periodic.status != Status::converged) return result;
  result.symmetric = periodic.symmetric;
  if (half_wave && !periodic.symmetric) result.status = Status::no_cycle;
  result.harmonics.resize(orders + 1);
  result.harmonics(0) = {0.0, sums.mean(periodic.symmetric)};
  for (int n = 1; n <= orders; ++n) result.harmonics(n) = sums.harmonic(n, periodic.symmetric);
  if (!result.harmonics.allFinite()) result.status = Status::not_finite;
  return result;
}

}  // namespace

HarmonicResponse ElementHarmonics::on_mesh(const PrescribedHarmonics& motion, int orders, int level, double tolerance,
                                           Eigen::MatrixXd* derivative) {
  MeshSettings settings = quadrature_meshes[static_cast<std::size_t>(level)];
  settings.harmonics = orders;
  if (undefined_under(element_, motion.least_speed(), motion.mean_rate())) {
    HarmonicResponse none;
    none.status = Status::undefined;
    return none;
  }
  const PeriodMesh mesh = graded_mesh(motion, element_.scales(), settings);
  ElementMarch<PrescribedHarmonics> march(element_, motion, settings.stages);
  PeriodicStateSearch<PrescribedHarmonics> search(march, mesh, motion.half_wave() && element_.odd(), tolerance);
  RecordedSums recorded(orders);
  HarmonicSums plain(orders);
  const auto find = [&](const PeriodicState* guess) {
    return derivative == nullptr ? search.find(plain, guess) : search.find(recorded, guess);
  };
  PeriodicState periodic = find(has_guess_ ? &guess_ : nullptr);
  if (has_guess_ && (periodic.status != Status::converged || periodic.symmetric != motion.half_wave()))
    periodic = find(nullptr);
  HarmonicResponse result = collect(derivative == nullptr ? plain : recorded, orders, periodic, motion.half_wave());
  result.evaluations = march.evaluations();
  has_guess_ = result.status == Status::converged;
  if (!has_guess_) return result;
  if (derivative != nullptr) {
    std::vector<int> input_orders, output_orders;
    for (int n = 1; n <= orders; n += motion.half_wave() ? 2 : 1) input_orders.push_back(n);
    if (!motion.half_wave()) output_orders.push_back(0);
    output_orders.insert(output_orders.end(), input_orders.begin(), input_orders.end());
    ResponseDerivative response(element_, motion.frequency(), motion.mean_rate(), settings.stages, input_orders);
    *derivative = response.of(recorded.steps(), periodic.symmetric, output_orders);
  }
  guess_ = std::move(periodic);
  return result;
}

HarmonicResponse ElementHarmonics::operator()(const PrescribedHarmonics& motion, int orders, int level,
                                              double tolerance) {
  return on_mesh(motion, orders, level, tolerance, nullptr);
}

HarmonicResponse ElementHarmonics::with_derivative(const PrescribedHarmonics& motion, int orders, int level,
                                                   double tolerance, Eigen::MatrixXd& derivative) {
  return on_mesh(motion, orders, level, tolerance, &derivative);
}

HarmonicResponse harmonic_response(const Element& element, const Eigen::VectorXcd& input, double frequency,
                                   const HarmonicResponseOptions& options) {
  if (options.harmonics < 1 || options.harmonics > 1000)
    refuse("harmonic response", "harmonics", options.harmonics, "must lie in 1..1000");
  if (!(options.accuracy >= 1e-13 && options.accuracy <= 0.1))
    refuse("harmonic response", "accuracy", options.accuracy, "must lie in 1e-13..0.1");
  const PrescribedHarmonics motion(input, frequency, options.mean_rate, options.half_wave);
  ElementHarmonics harmonics(element);
  HarmonicResponse best;
  const int first = options.accuracy >= 1e-7 ? 0 : options.accuracy >= 1e-10 ? 1 : 2;
  for (int level = first; level <= ElementHarmonics::finest; ++level) {
    HarmonicResponse now = harmonics(motion, options.harmonics, level, 1e-4 * options.accuracy);
    now.evaluations += best.evaluations;
    if (now.status != Status::converged) return now;
    if (level > first) {
      const double size = now.harmonics.cwiseAbs().maxCoeff();
      now.error = 2.0 * (now.harmonics - best.harmonics).cwiseAbs().maxCoeff() + 2e-15 * size;
      if (now.error <= options.accuracy * size) return now;
    }
    best = std::move(now);
  }
  best.status = Status::incomplete;
  return best;
}

}  // namespace limcycle
