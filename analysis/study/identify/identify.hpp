#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/identify/free/free_response.hpp"
#include "limcycle/analysis/study/identify/parameter_space.hpp"
#include "limcycle/analysis/study/identify/plan.hpp"
#include "limcycle/analysis/study/identify/residuals.hpp"

namespace limcycle {

/// Laws to be fitted to records.
struct IdentifyRequest {
  std::vector<Element> laws;  ///< their numbers are not used
  std::vector<FrictionRecord> records;
  FreeChoice choice;
  std::optional<FreeRig> rig = {};  ///< what moves in free motions
  bool plan = false;                ///< say what one more record would tell
};

struct IdentifyOptions {
  std::function<bool()> stop;
  std::function<void(double, const std::string&)> progress;
};

/// A number of a fitted law, with its 95 % interval.
struct IdentifiedNumber {
  std::string name;  ///< "Fs", "k[0]"
  std::string unit;
  double value = 0.0;
  std::optional<double> low, high;                ///< by profile likelihood
  std::optional<double> linear_low, linear_high;  ///< by the derivatives at the fit
  bool identifiable = false;
  double searched_low = 0.0, searched_high = 0.0;  ///< where fits began
};

/// How a law fits one record.
struct RecordFit {
  /// Root of the weighted mean square of what is left over, in the unit of what was measured; with Huber's loss 1.48
  /// times the median.
  double error = 0.0;
  Whiteness whiteness;
  std::vector<double> fitted;  ///< by the law, at the compared rows
};

/// A combination of numbers that the records do not determine: a weight for each, in the coordinates.
struct Undetermined {
  std::vector<std::pair<std::string, double>> direction;
  bool powers = true;           ///< all coordinates are logarithms: the weights are powers in a product
  double deviation = infinite;  ///< standard deviation along it, in the coordinates
};

struct IdentifiedLaw {
  Element law;
  std::vector<IdentifiedNumber> numbers = {};
  std::size_t fitted = 0;             ///< free numbers
  std::size_t start_states = 0;       ///< fitted besides, of free motions
  double bic = NAN;                   ///< see identify(); less is better
  double held_out = NAN;              ///< see held_out_error()
  Eigen::MatrixXd correlations = {};  ///< of the numbers with a coordinate, by derivatives; NaN where not determined
  std::vector<std::string> correlated = {};  ///< their names
  std::vector<Undetermined> undetermined = {};
  std::vector<RecordFit> records = {};
  double march_error = NAN;  ///< largest change of an entry when the steps are halved, over its record's noise
  std::optional<IdentifyPlan> plan = {};  ///< of the chosen law, if it was asked for
  long evaluations = 0;
  Status status = Status::converged;
  std::vector<std::string> notes = {};
};

struct IdentifyReport {
  std::vector<PreparedRecord> records;
  std::optional<Shooting> shooting;  ///< of the free motions, if there are any
  std::vector<IdentifiedLaw> laws;   ///< in the order of the request
  std::optional<std::size_t> chosen;
  Status status = Status::converged;
};

/// Fits each law to all records, by maximum likelihood for independent normal errors of the force, whose deviation is
/// that of each record (pooled for records with fewer than five rows a number). Fits keep to the bounds of the laws,
/// numbers >= 0 and Fs >= Fc. Chosen, once all laws are fitted: of the converged ones whose held-out error is within
/// 1 % of the least, the one with the fewest fitted numbers; of two with as many, the one of the lesser BIC: the sum
/// over records of n (ln s^2 + m/s^2 - 1), with the mean square m and the deviation s of the n errors, plus
/// fitted ln(rows), with the states at starts among the fitted ones. Laws that need as many numbers as there are rows
/// are not fitted, with a note.
///
/// Rows may have weights, each 1 over its variance as far as that differs within a record. With Huber's loss
/// (huber_loss.hpp) rows far off pull no harder than those 1.345 deviations off; the intervals are those of that
/// estimate, and the mean square of the BIC is that of the deviation by the median.
///
/// Free motions are simulated under each law, and the errors are those of position and velocity. Each is first fitted
/// in several runs, then in one; all laws keep to several if no law leaves less than 1.3 times the error in one. Throws
/// std::invalid_argument for a record that cannot be used, a free one without a rig, or a key of the choice that none
/// of the laws has.
IdentifyReport identify(const IdentifyRequest& request, const IdentifyOptions& options = {});

}  // namespace limcycle
