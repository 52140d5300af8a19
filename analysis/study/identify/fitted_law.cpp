#include "limcycle/analysis/study/identify/fitted_law.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limcycle/analysis/study/identify/bounded_fit.hpp"
#include "limcycle/analysis/study/identify/held_out.hpp"
#include "limcycle/analysis/study/identify/huber_loss.hpp"
#include "limcycle/analysis/study/identify/intervals.hpp"
#include "limcycle/analysis/study/identify/starts.hpp"
#include "limcycle/models/median.hpp"

namespace limcycle {
namespace {

/// Standard deviation by the median, which half of the rows may leave as it is.
double deviation_by_median(const Eigen::VectorXd& left) {
  constexpr double of_normal = 0.6744897501960817;
  std::vector<double> sizes(static_cast<std::size_t>(left.size()));
  std::ranges::transform(left, sizes.begin(), [](double one) { return std::abs(one); });
  return median(std::move(sizes)) / of_normal;
}

/// Root mean square of the entries of each record, in the unit of what was measured; by the median for Huber's loss.
std::vector<double> errors_of(const Misfit& misfit, const Eigen::VectorXd& entries) {
  std::vector<double> errors;
  for (std::size_t r = 0; r < misfit.records().size(); ++r) {
    if (misfit.records()[r].huber) {
      errors.push_back(misfit.noise()[r] * deviation_by_median(misfit.differences(r, entries)));
      continue;
    }
    const auto rows = std::ssize(misfit.records()[r].compared);
    errors.push_back(misfit.noise()[r] * entries.segment(misfit.first_of(r), rows).norm() /
                     std::sqrt(static_cast<double>(rows)));
  }
  return errors;
}

/// Standard deviation of what was measured in each record, as the fit leaves it. Records with few rows for the numbers
/// of the law might be fitted exactly; they count as no more precise, for their size, than all others together.
std::vector<double> noise_left(const Misfit& misfit, const Eigen::VectorXd& entries) {
  constexpr Eigen::Index fewest_rows_a_number = 5;
  const auto& records = misfit.records();
  auto noise = errors_of(misfit, entries);
  std::vector<bool> few;
  few.reserve(records.size());
  for (const auto& record : records)
    few.push_back(std::ssize(record.compared) < fewest_rows_a_number * misfit.space().size());
  const bool all_few = std::ranges::find(few, false) == few.end();
  double sum = 0.0, rows = 0.0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (few[r] && !all_few) continue;
    const auto n = static_cast<double>(records[r].compared.size());
    sum += n * std::pow(noise[r] / records[r].size, 2);
    rows += n;
  }
  for (std::size_t r = 0; r < records.size(); ++r) {
    const double march_error = records[r].motion ? 1e-6 : 1e-9;
    noise[r] = std::max(noise[r], records[r].size * std::max(march_error, few[r] ? std::sqrt(sum / rows) : 0.0));
  }
  return noise;
}

/// Parallel elements in the order in which they yield: the records do not tell them apart otherwise.
Eigen::VectorXd in_order_of_yield(const ParameterSpace& space, const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> k, share;
  for (std::size_t i = 0; i < space.numbers().size(); ++i) {
    if (space.numbers()[i].name.starts_with("k[")) k.push_back(static_cast<Eigen::Index>(i));
    if (space.is_share_of_sum(i)) share.push_back(static_cast<Eigen::Index>(i));
  }
  Eigen::VectorXd sorted = values;
  if (k.empty() || k.size() != share.size()) return sorted;
  std::vector<std::size_t> order(k.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values(share[i]) / values(k[i]); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted(k[i]) = values(k[order[i]]);
    sorted(share[i]) = values(share[order[i]]);
  }
  return sorted;
}

void note_outliers(const PreparedRecord& record, const Eigen::VectorXd& differences, IdentifiedLaw& into) {
  constexpr double surely = 4.0;
  const auto count = (differences.array().abs() > surely).count();
  if (count > 0)
    into.notes.push_back(std::to_string(count) + " of " + std::to_string(differences.size()) + " rows of " +
                         record.name + (count == 1 ? " lies" : " lie") +
                         " more than four deviations off: outliers, which Huber's loss hardly counts");
}

void add_records(const Misfit& misfit, const Eigen::VectorXd& u, IdentifiedLaw& into) {
  Eigen::VectorXd entries, finer;
  if (!misfit.at(u, entries, nullptr)) return;
  into.march_error = misfit.at(u, finer, nullptr, 2.0) ? (finer - entries).cwiseAbs().maxCoeff() : NAN;
  const auto errors = errors_of(misfit, entries);
  double rows = 0.0;
  into.start_states = static_cast<std::size_t>(misfit.start_states());
  into.bic = 0.0;
  for (std::size_t r = 0; r < misfit.records().size(); ++r) {
    const auto& record = misfit.records()[r];
    RecordFit result;
    result.error = errors[r];
    std::vector<std::size_t> order(record.compared.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (record.kind == RecordKind::steady_velocity)
      std::ranges::stable_sort(order, {}, [&](std::size_t i) { return record.compared[i].v; });
    std::vector<double> left;
    left.reserve(order.size());
    const Eigen::VectorXd differences = misfit.noise()[r] * misfit.differences(r, entries);
    for (std::size_t i = 0; i < record.compared.size(); ++i)
      result.fitted.push_back(record.compared[i].measured +
                              differences(static_cast<Eigen::Index>(i)) / record.compared[i].weight);
    const double most = record.huber ? huber_limit * misfit.noise()[r] : infinite;  // else outliers are all that shows
    for (const auto i : order) left.push_back(std::clamp(differences(static_cast<Eigen::Index>(i)), -most, most));
    if (record.huber) note_outliers(record, differences / misfit.noise()[r], into);
    // Below the error of the simulation nothing is noise.
    if (!record.motion || errors[r] > 0.5 * misfit.noise()[r]) result.whiteness = whiteness(left);
    const double n = static_cast<double>(record.compared.size()), noise = misfit.noise()[r];
    into.bic += n * (2.0 * std::log(noise) + std::pow(errors[r] / noise, 2) - 1.0);
    rows += n;
    into.records.push_back(std::move(result));
  }
  into.bic += static_cast<double>(into.fitted + into.start_states) * std::log(rows);
}

}  // namespace

LawFit::LawFit(const Element& kind, const std::vector<PreparedRecord>& records, const FreeChoice& choice,
               std::function<bool()> stop)
    : stop_(std::move(stop)), space_(kind, records, choice), records_(records), result_{.law = kind} {
  result_.fitted = static_cast<std::size_t>(space_.size());
  for (const auto& record : records_) noise_.push_back(0.01 * record.size);
  if (const Misfit misfit(space_, records_, noise_); misfit.size() <= space_.size() + misfit.start_states()) {
    result_.status = Status::undefined;
    result_.notes.emplace_back("has more numbers than there are rows");
    return;
  }
  // In several short runs a law that is far off still follows the motion; in one run only a law that is nearly right.
  const bool long_motion =
      std::ranges::any_of(records_, [](const auto& one) { return one.motion && one.motion->pieces.size() > 1; });
  auto& [single, multiple] = fits_;
  if (long_motion) multiple = fit_with_noise(Shooting::multiple, {});
  single = fit_with_noise(Shooting::single, multiple);
}

Misfit LawFit::misfit_now() const {
  Misfit misfit(space_, records_, noise_, shooting_, stop_);
  misfit.start_from(best_.u);
  return misfit;
}

double LawFit::error_of_motion(Shooting shooting) const {
  const auto& from = fits_[static_cast<std::size_t>(shooting)];
  double sum = 0.0, rows = 0.0;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    if (!records_[r].motion) continue;
    if (!from) return infinite;
    const auto n = static_cast<double>(records_[r].compared.size());
    sum += n * std::pow(from->noise[r] / records_[r].size, 2);
    rows += n;
  }
  return rows > 0.0 ? std::sqrt(sum / rows) : 0.0;
}

void LawFit::settle(Shooting shooting) {
  if (result_.status == Status::undefined) return;
  const auto& chosen = fits_[static_cast<std::size_t>(shooting)];
  shooting_ = shooting;
  if (!chosen) {
    result_.status = stopped() ? Status::interrupted : Status::not_finite;
    return;
  }
  best_ = chosen->fit;
  noise_ = chosen->noise;
  answered_ = true;
  refit();
}

std::optional<LawFit::Noisy> LawFit::fit_with_noise(Shooting shooting, const std::optional<Noisy>& from) {
  constexpr int most_rounds = 4;
  Eigen::VectorXd entries;
  Noisy result{from ? from->fit : Fit{}, from ? from->noise : noise_};
  for (int round = 0; round < most_rounds; ++round) {
    Misfit misfit(space_, records_, result.noise, shooting, stop_);
    if (round > 0 || from) misfit.start_from(result.fit.u);
    result.fit = round == 0 && !from
                     ? fit_from_starts(misfit, stop_)
                     : fit_within(misfit, result.fit, felt_coordinates(misfit, result.fit.u), 60, stop_);
    if (misfit.start_states() > 0 && round == 0) result.fit = begun_off_levels(misfit, result.fit, stop_);
    result_.evaluations += misfit.evaluations();
    if (!std::isfinite(result.fit.sum_of_squares) || stopped() || !misfit.at(result.fit.u, entries, nullptr)) break;
    const auto noise = noise_left(misfit, entries);
    double change = 0.0;
    for (std::size_t r = 0; r < noise.size(); ++r)
      change = std::max(change, std::abs(std::log(noise[r] / result.noise[r])));
    result.noise = noise;
    if (change < 1e-3) break;
  }
  if (!std::isfinite(result.fit.sum_of_squares)) return std::nullopt;
  result.fit.u = space_.coordinates(in_order_of_yield(space_, space_.values(result.fit.u)));
  return result;
}

void LawFit::refit() {
  const Misfit misfit = misfit_now();
  if (!stopped()) best_ = fit_within(misfit, best_, felt_coordinates(misfit, best_.u), 60, stop_);
  result_.notes.clear();
  result_.records.clear();
  const auto bounds = space_.bounds();
  for (const auto b : best_.held) result_.notes.push_back(bounds[b].note);
  result_.status = stopped() ? Status::interrupted : best_.status;
  result_.law = space_.law(space_.values(best_.u));
  if (const auto broken = result_.law.validate()) {
    result_.status = Status::stalled;
    result_.notes.push_back("is no law with these numbers: " + std::string(broken->key) + " " + broken->rule);
  }
  add_records(misfit, best_.u, result_);
  result_.held_out = held_out_error(misfit, best_);
  result_.evaluations += misfit.evaluations();
}

IdentifiedLaw LawFit::with_intervals(bool profiled) {
  constexpr int most_rounds = 4;
  for (int round = 0; answered_; ++round) {
    const Misfit misfit = misfit_now();
    std::optional<Fit> better;
    if (const auto at = with_slopes(misfit, best_)) {
      add_numbers(*at, profiled, result_, better, stop_);
      add_directions(*at, result_);
    }
    result_.evaluations += misfit.evaluations();
    if (!better || stopped()) break;
    if (round + 1 == most_rounds) {
      result_.status = Status::stalled;
      result_.notes.emplace_back("a better fit turned up with each profile, the last time too");
      break;
    }
    best_ = *better;
    refit();
  }
  if (stopped()) result_.status = Status::interrupted;
  if (answered_ && !profiled)
    result_.notes.emplace_back(stopped()
                                   ? "its intervals are linear ones, since the work was stopped"
                                   : "its intervals are linear ones, since another law fits these records far better");
  return result_;
}

}  // namespace limcycle
