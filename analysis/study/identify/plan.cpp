#include "limcycle/analysis/study/identify/plan.hpp"

#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/identify/fit.hpp"
#include "limcycle/analysis/study/identify/profile.hpp"
#include "limcycle/analysis/study/identify/record/synthesize.hpp"

namespace limcycle {
namespace {

constexpr double usual_noise = 0.01;

/// Standard deviation of measured forces as a share of the largest of their record; nothing without any.
std::optional<double> share_of_noise(const Misfit& misfit) {
  double sum = 0.0, rows = 0.0;
  for (std::size_t r = 0; r < misfit.records().size(); ++r) {
    const PreparedRecord& record = misfit.records()[r];
    if (record.quantity != MeasuredQuantity::force || !(record.size > 0.0)) continue;
    const auto n = static_cast<double>(record.compared.size());
    sum += n * std::pow(misfit.noise()[r] / record.size, 2);
    rows += n;
  }
  return rows > 0.0 ? std::optional(std::sqrt(sum / rows)) : std::nullopt;
}

std::vector<double> half_widths(const ParameterSpace& space, const Eigen::VectorXd& u, const Eigen::MatrixXd& slopes) {
  constexpr double deviations = 1.959964;
  const LinearCovariance linear = linear_covariance(slopes);
  const Eigen::MatrixXd chain = space.chain(space.values(u));
  std::vector<double> widths;
  for (Eigen::Index i = 0; i < chain.rows(); ++i) {
    bool determined = true;
    for (Eigen::Index k = 0; k < chain.cols(); ++k)
      determined = determined && (chain(i, k) == 0.0 || std::isfinite(linear.deviation(k)));
    const Eigen::RowVectorXd row = chain.row(i);
    widths.push_back(determined ? deviations * std::sqrt((row * linear.covariance * row.transpose()).value())
                                : infinite);
  }
  return widths;
}

Eigen::MatrixXd below(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  Eigen::MatrixXd both(first.rows() + second.rows(), first.cols());
  both << first, second;
  return both;
}

}  // namespace

std::optional<IdentifyPlan> plan_records(const Misfit& misfit, const Eigen::VectorXd& u,
                                         const std::function<bool()>& stop) {
  const ParameterSpace& space = misfit.space();
  Eigen::VectorXd entries;
  Eigen::MatrixXd slopes;
  if (!misfit.at(u, entries, &slopes)) return std::nullopt;
  const auto noise = share_of_noise(misfit);
  const Eigen::VectorXd values = space.values(u);
  IdentifyPlan plan{.noise = noise.value_or(usual_noise),
                    .noise_is_assumed = !noise,
                    .values = {values.begin(), values.end()},
                    .half_width = half_widths(space, u, slopes),
                    .records = {}};
  try {
    const Element law = space.law(values);
    for (const FrictionRecord& record : synthesize(law, {.noise = 0.0}, 0, stop)) {
      const std::vector<PreparedRecord> more{prepare(record, law.may_stick())};
      const Misfit one(space, more, {plan.noise * more.front().size});
      Eigen::MatrixXd added;
      if (!one.at(u, entries, &added)) return std::nullopt;
      plan.records.push_back({record.kind, more.front().compared.size(), half_widths(space, u, below(slopes, added))});
    }
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return plan.records.empty() ? std::nullopt : std::optional(std::move(plan));
}

}  // namespace limcycle
