#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "limcycle/analysis/study/identify/record/record.hpp"

namespace limcycle {

class Misfit;

/// Half-widths of the 95 % intervals of the numbers of a law if one more record of a kind were made.
struct PlannedRecord {
  RecordKind kind = RecordKind::steady_velocity;
  std::size_t rows = 0;
  std::vector<double> half_width;  ///< in the unit of each number; infinite if it stays undetermined
};

/// What one more record would tell.
struct IdentifyPlan {
  double noise = 0.0;              ///< of its force, as a share of the largest force of the record
  bool noise_is_assumed = false;   ///< no force was measured so far
  std::vector<double> values;      ///< of the numbers
  std::vector<double> half_width;  ///< with the records so far
  std::vector<PlannedRecord> records;
};

/// Plans with the law at coordinates u, for one record of each kind that synthesize() makes, with the noise of the
/// records so far. The Fisher information of independent normal errors is J^T J, with the derivatives J of the
/// weighted entries by the coordinates, and that of two records is the sum (L. Ljung, System Identification, 2nd ed.
/// 1999, 7.4 and 13.3): the covariance of both is that of the rows of both J. Half-widths are 1.96 standard deviations,
/// carried over to the numbers by their derivatives. Nothing if the law has no answer, or cannot be driven through such
/// records. Cost: one evaluation with derivatives of each record.
std::optional<IdentifyPlan> plan_records(const Misfit& misfit, const Eigen::VectorXd& u,
                                         const std::function<bool()>& stop);

}  // namespace limcycle
