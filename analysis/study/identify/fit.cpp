#include "limcycle/analysis/study/identify/fit.hpp"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "limcycle/analysis/study/identify/huber_loss.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

Misfit::Misfit(const ParameterSpace& space, const std::vector<PreparedRecord>& records, std::vector<double> noise,
               Shooting shooting, std::function<bool()> stop)
    : space_(space),
      records_(records),
      noise_(std::move(noise)),
      response_(response_of(space.kind(), space.places(), space.own_rows())),
      free_(space.kind(), space.places(), space.own_rows(), shooting, std::move(stop)) {
  for (const auto& record : records_) {
    first_.push_back(size_);
    size_ += std::ssize(record.compared);
  }
  first_.push_back(size_);
  if (space.kind().may_stick())
    for (const auto& record : records_) size_ += std::ssize(record.break_aways);
}

void Misfit::add_break_aways(const Element& law, Eigen::VectorXd& entries, Eigen::MatrixXd* by_values) const {
  const auto forward = space_.source_of("Fs"), backward = space_.source_of("Fs_minus");
  Eigen::Index entry = first_.back();
  for (std::size_t r = 0; r < records_.size(); ++r)
    for (const auto& event : records_[r].break_aways) {
      const double weight = uses(r) ? event.weight / noise_[r] : 0.0, sign = event.forward ? 1.0 : -1.0;
      const double level = law.number(event.forward ? "Fs" : "Fs_minus").value();
      entries(entry) = weight * (sign * level - event.F);
      const auto& column = event.forward ? forward : backward;
      if (by_values != nullptr && column) (*by_values)(entry, static_cast<Eigen::Index>(*column)) = sign * weight;
      ++entry;
    }
}

bool Misfit::add_forces(const Element& law, std::size_t record, Eigen::VectorXd& entries, Eigen::MatrixXd* by_values,
                        double fineness) const {
  const auto& compared = records_[record].compared;
  if (!response_->run(law, records_[record], forces_, by_values != nullptr ? &by_numbers_ : nullptr, fineness))
    return false;
  for (std::size_t i = 0; i < compared.size(); ++i)
    entries(first_[record] + static_cast<Eigen::Index>(i)) =
        (forces_[i] - compared[i].measured) * compared[i].weight / noise_[record];
  if (by_values != nullptr) by_values->middleRows(first_[record], std::ssize(compared)) = by_numbers_ / noise_[record];
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const Eigen::Index row = first_[record] + static_cast<Eigen::Index>(i);
    const HuberEntry by_loss = records_[record].huber ? huber_entry(entries(row)) : HuberEntry{entries(row), 1.0};
    entries(row) = by_loss.entry;
    const double factor = compared[i].weight * by_loss.slope;
    if (by_values != nullptr && factor != 1.0) by_values->row(row) *= factor;
  }
  return true;
}

Eigen::VectorXd Misfit::differences(std::size_t record, const Eigen::VectorXd& entries) const {
  const auto own = entries.segment(first_[record], std::ssize(records_[record].compared));
  return records_[record].huber ? Eigen::VectorXd(own.unaryExpr(&huber_difference)) : Eigen::VectorXd(own);
}

double Misfit::spread(const Eigen::VectorXd& entries) const {
  double sum = entries.squaredNorm();
  for (std::size_t r = 0; r < records_.size(); ++r) {
    if (!records_[r].huber) continue;
    const Eigen::VectorXd left = differences(r, entries);
    const auto pulling = static_cast<double>((left.array().abs() <= huber_limit).count());
    const double pulls = left.cwiseAbs().cwiseMin(huber_limit).squaredNorm();
    sum += pulls * static_cast<double>(left.size()) / std::max(pulling, 1.0) -
           entries.segment(first_[r], left.size()).squaredNorm();
  }
  return sum;
}

/// `first`: of the records of one motion.
bool Misfit::add_motion(const Element& law, std::size_t first, Eigen::VectorXd& entries, Eigen::MatrixXd* by_values,
                        double fineness, const Eigen::VectorXd* known) const {
  std::vector<FreeResponse::Series> series;
  for (std::size_t r = first; r < records_.size() && records_[r].motion == records_[first].motion; ++r)
    series.push_back({&records_[r], noise_[r], first_[r]});
  return free_.run(law, series, known, entries, by_values, fineness);
}

bool Misfit::at(const Eigen::VectorXd& u, Eigen::VectorXd& entries, Eigen::MatrixXd* slopes, double fineness,
                const Eigen::VectorXd* known) const {
  if (start_states() == 0 || fineness != 1.0 || known != nullptr) return evaluate(u, entries, slopes, fineness, known);
  if (last_.u.size() != u.size() || last_.u != u) {
    last_.u = u;
    last_.known = evaluate(u, last_.entries, &last_.slopes, fineness, known);
  }
  entries = last_.entries;
  if (slopes != nullptr) *slopes = last_.slopes;
  return last_.known;
}

void Misfit::start_from(const Eigen::VectorXd& u) {
  Eigen::VectorXd entries;
  if (start_states() > 0 && at(u, entries, nullptr)) free_.keep_starts();
  last_ = {};
}

bool Misfit::evaluate(const Eigen::VectorXd& u, Eigen::VectorXd& entries, Eigen::MatrixXd* slopes, double fineness,
                      const Eigen::VectorXd* known) const {
  ++evaluations_;
  const Eigen::VectorXd values = space_.values(u);
  if (!space_.inside(values)) return false;
  const Element law = space_.law(values);
  entries.setZero(size_);
  Eigen::MatrixXd by_values;
  if (slopes != nullptr) by_values.setZero(size_, values.size());
  Eigen::MatrixXd* const wanted = slopes != nullptr ? &by_values : nullptr;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    if (!uses(r)) continue;
    const auto& motion = records_[r].motion;
    if (!motion && !add_forces(law, r, entries, wanted, fineness)) return false;
    const bool is_first = r == 0 || records_[r - 1].motion != motion;
    if (motion && is_first && !add_motion(law, r, entries, wanted, fineness, known)) return false;
  }
  if (has_break_aways()) add_break_aways(law, entries, wanted);
  if (slopes != nullptr) {
    slopes->noalias() = by_values * space_.chain(values);
    if (!slopes->allFinite()) return false;
  }
  return entries.allFinite();
}

Eigen::Index Misfit::start_states() const {
  Eigen::Index count = 0;
  for (std::size_t r = 0; r < records_.size(); ++r)
    if (records_[r].motion && (r == 0 || records_[r - 1].motion != records_[r].motion))
      count += free_.start_states(*records_[r].motion);
  return count;
}

Groups each_by_itself(const std::vector<Eigen::Index>& coordinates) {
  Groups groups;
  for (const auto k : coordinates) groups.push_back({k});
  return groups;
}

namespace {

/// Entries where the law has no answer, far worse than any law: such a step is rejected.
constexpr double far_off = 1e9;

struct GslProblem {
  const Misfit& misfit;
  Eigen::VectorXd u;
  const Groups& groups;
  Eigen::VectorXd entries;
  Eigen::MatrixXd slopes;

  void take(const gsl_vector* x) {
    for (std::size_t k = 0; k < groups.size(); ++k)
      for (const auto i : groups[k]) u(i) = gsl_vector_get(x, k);
  }
};

int gsl_entries(const gsl_vector* x, void* data, gsl_vector* f) {
  auto& problem = *static_cast<GslProblem*>(data);
  problem.take(x);
  const bool known = problem.misfit.at(problem.u, problem.entries, nullptr);
  for (std::size_t i = 0; i < f->size; ++i)
    gsl_vector_set(f, i, known ? problem.entries(static_cast<Eigen::Index>(i)) : far_off);
  return GSL_SUCCESS;
}

int gsl_slopes(const gsl_vector* x, void* data, gsl_matrix* J) {
  auto& problem = *static_cast<GslProblem*>(data);
  problem.take(x);
  if (!problem.misfit.at(problem.u, problem.entries, &problem.slopes)) return GSL_EDOM;
  for (std::size_t k = 0; k < problem.groups.size(); ++k)
    for (std::size_t i = 0; i < J->size1; ++i) {
      double sum = 0.0;
      for (const auto column : problem.groups[k]) sum += problem.slopes(static_cast<Eigen::Index>(i), column);
      gsl_matrix_set(J, i, k, sum);
    }
  return GSL_SUCCESS;
}

/// How much a Gauss-Newton step would lower the sum of squares: the square of the part of the entries in the span of
/// the slopes. Directions that change the entries 10^4 times less than others, once all columns have one length, do not
/// count.
double possible_decrease(const gsl_multifit_nlinear_workspace& at) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto index = [](std::size_t n) { return static_cast<Eigen::Index>(n); };
  const Eigen::Map<const RowMajor, 0, Eigen::OuterStride<>> J(at.J->data, index(at.J->size1), index(at.J->size2),
                                                              Eigen::OuterStride<>(index(at.J->tda)));
  const Eigen::Map<const Eigen::VectorXd> f(at.f->data, index(at.f->size));
  Eigen::VectorXd size = J.colwise().norm().transpose();
  for (double& one : size)
    if (one == 0.0) one = 1.0;
  const Eigen::MatrixXd unit = J * size.cwiseInverse().asDiagonal();
  const auto gram = singular_values(Eigen::MatrixXd(unit.transpose() * unit));
  const Eigen::VectorXd along = gram.U.transpose() * (unit.transpose() * f);
  double decrease = 0.0;
  for (Eigen::Index k = 0; k < along.size(); ++k)
    if (gram.values(k) > 1e-8 * gram.values(0)) decrease += along(k) * along(k) / gram.values(k);
  return decrease;
}

/// Iterates GSL's method to its end.
void iterate(gsl_multifit_nlinear_workspace& work, const GslProblem& problem, int most_iterations,
             const std::function<bool()>& stop, Fit& result) {
  constexpr int most_slow = 15;
  for (int slow = 0; result.iterations < most_iterations;) {
    if (stop && stop()) {
      result.status = Status::interrupted;
      return;
    }
    const int moved = gsl_multifit_nlinear_iterate(&work);
    ++result.iterations;
    const double before = result.sum_of_squares, now = std::pow(gsl_blas_dnrm2(work.f), 2);
    if (now < before) {
      for (std::size_t k = 0; k < problem.groups.size(); ++k)
        for (const auto i : problem.groups[k]) result.u(i) = gsl_vector_get(work.x, k);
      result.sum_of_squares = now;
    }
    slow = before - now > 1e-4 ? 0 : slow + 1;
    if (moved == GSL_SUCCESS && slow == 0) continue;
    // Where no step lowers the sum it may be rough: steps and switches of the march change their number.
    const double immaterial = moved == GSL_SUCCESS ? 1e-4 : 0.04;
    result.possible_decrease = possible_decrease(work);
    if (result.possible_decrease < immaterial) {
      result.status = Status::converged;
      return;
    }
    if (moved != GSL_SUCCESS || slow == most_slow) {
      result.status = Status::stalled;
      return;
    }
  }
}

template <class T>
T* allocated(T* from_gsl) {
  if (from_gsl == nullptr) throw std::bad_alloc();
  return from_gsl;
}

}  // namespace

Fit fit(const Misfit& misfit, const Eigen::VectorXd& start, const Groups& groups, int most_iterations,
        const std::function<bool()>& stop) {
  [[maybe_unused]] static const auto handler_off = gsl_set_error_handler_off();
  Fit result;
  result.u = start;
  GslProblem problem{misfit, start, groups, {}, {}};
  if (groups.empty() || misfit.size() < std::ssize(groups)) {
    const bool known = misfit.at(start, problem.entries, nullptr);
    if (known) result.sum_of_squares = problem.entries.squaredNorm();
    result.status = !known ? Status::not_finite : groups.empty() ? Status::converged : Status::stalled;
    return result;
  }
  const auto rows = static_cast<std::size_t>(misfit.size());
  auto settings = gsl_multifit_nlinear_default_parameters();
  settings.solver = gsl_multifit_nlinear_solver_qr;
  const std::unique_ptr<gsl_multifit_nlinear_workspace, decltype(&gsl_multifit_nlinear_free)> work(
      allocated(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &settings, rows, groups.size())),
      gsl_multifit_nlinear_free);
  const std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)> x(allocated(gsl_vector_alloc(groups.size())),
                                                                  gsl_vector_free);
  for (std::size_t k = 0; k < groups.size(); ++k) gsl_vector_set(x.get(), k, start(groups[k].front()));
  gsl_multifit_nlinear_fdf system{gsl_entries, gsl_slopes, nullptr, rows, groups.size(), &problem, 0, 0, 0};
  if (gsl_multifit_nlinear_init(x.get(), &system, work.get()) != GSL_SUCCESS) {
    result.status = Status::not_finite;
    return result;
  }
  result.sum_of_squares = std::pow(gsl_blas_dnrm2(work->f), 2);
  iterate(*work, problem, most_iterations, stop, result);
  return result;
}

}  // namespace limcycle
