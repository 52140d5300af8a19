#pragma once
#include <complex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/derivatives/threshold_derivatives.hpp"
#include "limcycle/analysis/study/map/ensemble_outcomes.hpp"
#include "limcycle/analysis/study/map/hunting_map.hpp"
#include "limcycle/analysis/study/sensitivity/global/morris.hpp"
#include "limcycle/analysis/study/sensitivity/global/probability_estimate.hpp"
#include "limcycle/analysis/study/sensitivity/global/sobol.hpp"
#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"
#include "limcycle/analysis/study/sensitivity/prediction_derivatives.hpp"

namespace limcycle {

/// Sensitivity of a cycle to one number of the case: derivatives, and elasticities, which are the percentage change of
/// the quantity per 1 % of the number.
struct LocalSensitivity {
  std::string path, unit;
  double value = 0.0;
  double amplitude = 0.0, period = 0.0;           ///< derivatives; NaN if unknown
  std::vector<std::complex<double>> multipliers;  ///< derivatives, in the order of the cycle's
  double error = 0.0;                         ///< estimated, of the derivatives relative to themselves; NaN if unknown
  std::string why;                            ///< reason why they are unknown; else empty
  double first_harmonic = 0.0, offset = 0.0;  ///< derivatives; NaN if unknown
  double first_harmonic_error = 0.0, offset_error = 0.0;  ///< absolute
  double amplitude_error = 0.0, period_error = 0.0;       ///< absolute; `error` is the larger of the two relative ones
};

/// Sensitivity to one number of the case of an oscillation that the describing function predicts.
struct PredictedSensitivity {
  std::string path, unit;
  double value = 0.0;
  PredictionDerivative by;
  std::string why;  ///< reason why it is unknown; else empty
};

/// A predicted oscillation.
struct PredictedOscillation {
  PredictionDerivatives found;  ///< its `by` is given in `numbers`
  std::vector<PredictedSensitivity> numbers;
};

/// Derivative of a threshold by one number of the case.
struct ThresholdNumber {
  std::string path, unit;
  double value = 0.0;
  ThresholdDerivative by;
  std::string why;  ///< reason why it is unknown; else empty
};

/// The value of one number at which hunting ends or begins, on the nearer side, and its derivatives by all others.
struct ThresholdSensitivity {
  std::string path, unit;
  double value = 0.0;            ///< own, of the case
  bool known = false;            ///< there is a threshold
  bool begins = false;           ///< hunting begins there; otherwise it ends
  double at = 0.0, error = 0.0;  ///< the threshold; relative error, NaN if unknown
  std::string why;               ///< the event there, or the reason why there is no threshold
  std::vector<ThresholdNumber> numbers;
};

/// Behaviour after a change of one number, with all others unchanged.
struct ParameterChange {
  std::string path, unit;
  double factor = 1.0, value = 0.0;
  MapPoint found;
};

/// Quantiles of an output over the loops that have an answer.
struct OutputBand {
  double low = 0.0, median = 0.0, high = 0.0;  ///< at 2.5, 50 and 97.5 %
  std::size_t answers = 0;
};

/// The least number of answers that show the ends of a band.
inline constexpr std::size_t answers_of_a_band = 80;

/// Global indices of one output; without Morris's and Sobol's if the parameters are correlated.
struct OutputSensitivity {
  std::string output;  ///< "hunts", "amplitude", "period"
  double share_without_answer = 0.0;
  std::optional<OutputBand> band;  ///< of amplitude and period, from Sobol's points A and B
  MorrisResult morris;
  SobolIndices sobol;
  std::vector<SobolIndices> convergence;
};

/// The rows of a global study: first those of Morris, then those of Sobol. Row k is one point of the spread. If
/// parameters are correlated, no share of a variance belongs to one of them, and the rows are Sobol's A and B alone.
class GlobalPlan {
 public:
  GlobalPlan(const ParameterSpread& spread, std::size_t trajectories, std::size_t samples, bool second_order);

  std::size_t size() const { return joint_.correlated() ? fair_rows() : morris_.rows() + sobol_.rows(); }
  /// Values of the parameters, in the order of the spread. Throws std::out_of_range.
  std::vector<double> values(std::size_t row) const;

  bool correlated() const { return joint_.correlated(); }
  /// Rows that are a fair sample of the spread, Sobol's A and B, and the number of each.
  std::size_t fair_rows() const { return 2 * sobol_.samples(); }
  std::size_t fair_row(std::size_t k) const;

  const ParameterSpread& spread() const { return spread_; }
  const MorrisDesign& morris() const { return morris_; }
  const SobolDesign& sobol() const { return sobol_; }

 private:
  std::size_t fair_row_of_sobol(std::size_t k) const;

  ParameterSpread spread_;
  JointSpread joint_;
  MorrisDesign morris_;
  SobolDesign sobol_;
};

/// Results of a study of the whole spread.
struct GlobalSensitivity {
  std::vector<OutputSensitivity> outputs;   ///< in the order of EnsembleOutcome::names
  Probability hunting;                      ///< that the loop hunts, from Sobol's points A and B that are valid
  std::size_t not_valid = 0;                ///< points A and B whose values are no valid case
  std::optional<std::size_t> matters_most;  ///< parameter with the largest total index for "hunts"
};

/// Indices from the answers to all rows of a plan, empty where not computed. `noise`: relative error of amplitudes and
/// periods. `is_valid`: tells a row without an answer whose values are a valid case; empty: all are.
GlobalSensitivity global_sensitivity(const GlobalPlan& plan, std::span<const std::optional<EnsembleOutcome>> answers,
                                     double noise, const std::function<bool(std::size_t row)>& is_valid = {});

/// Results of `sensitivity`.
struct SensitivityReport {
  std::optional<Cycle> cycle;  ///< the stable one with the largest swing, to which the derivatives refer
  std::vector<LocalSensitivity> local;
  std::vector<PredictedOscillation> predicted;
  std::vector<ThresholdSensitivity> thresholds;
  std::vector<ParameterChange> one_at_a_time;
  ParameterSpread spread;
  bool spread_is_default = false;
  std::optional<GlobalSensitivity> global;
  std::vector<std::vector<double>> sample;  ///< values and answers of the fair sample, for figures
  std::vector<std::string> notes;
};

}  // namespace limcycle
