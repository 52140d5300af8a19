#include "limcycle/analysis/study/identify/starts.hpp"

#include <gsl/gsl_qrng.h>

#include <algorithm>
#include <memory>
#include <new>
#include <numeric>

#include "limcycle/analysis/study/identify/bounded_fit.hpp"

namespace limcycle {
namespace {

/// The first points of a Halton sequence.
std::vector<std::vector<double>> halton_points(int points, std::size_t dimensions) {
  if (dimensions == 0) return {{}};
  const std::unique_ptr<gsl_qrng, decltype(&gsl_qrng_free)> sequence(
      gsl_qrng_alloc(gsl_qrng_halton, static_cast<unsigned>(dimensions)), &gsl_qrng_free);
  if (!sequence) throw std::bad_alloc();
  std::vector<std::vector<double>> list(static_cast<std::size_t>(points), std::vector<double>(dimensions));
  for (auto& point : list) gsl_qrng_get(sequence.get(), point.data());
  return list;
}

struct StageSizes {
  int points, refined, few_iterations, iterations;
};

/// Fits over the coordinates in `active` from many points, the others as at `base`; best first.
std::vector<Fit> stage(const Misfit& misfit, const Eigen::VectorXd& base, const std::vector<Eigen::Index>& active,
                       const StageSizes& sizes, const std::function<bool()>& stop) {
  std::vector<Fit> fits;
  Eigen::VectorXd entries;
  for (const auto& shares : halton_points(sizes.points, misfit.space().numbers().size())) {
    if (stop && stop()) break;
    const Eigen::VectorXd point = misfit.space().start(shares);
    Fit candidate;
    candidate.u = base;
    for (const auto k : active) candidate.u(k) = point(k);
    if (misfit.at(candidate.u, entries, nullptr)) candidate.sum_of_squares = entries.squaredNorm();
    fits.push_back(std::move(candidate));
  }
  const auto best_first = [&] { std::ranges::stable_sort(fits, {}, &Fit::sum_of_squares); };
  best_first();
  if (std::ssize(fits) > sizes.refined) fits.resize(static_cast<std::size_t>(sizes.refined));
  for (auto& one : fits) one = fit(misfit, one.u, each_by_itself(active), sizes.few_iterations, stop);
  best_first();
  if (!fits.empty()) fits.front() = fit(misfit, fits.front().u, each_by_itself(active), sizes.iterations, stop);
  return fits;
}

std::vector<Eigen::Index> others(const std::vector<Eigen::Index>& all, const std::vector<Eigen::Index>& without) {
  std::vector<Eigen::Index> rest;
  std::ranges::copy_if(all, std::back_inserter(rest),
                       [&](Eigen::Index k) { return std::ranges::find(without, k) == without.end(); });
  return rest;
}

}  // namespace

Fit fit_from_starts(Misfit& misfit, const std::function<bool()>& stop) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(misfit.space().size()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  Eigen::VectorXd base = misfit.space().start(halton_points(1, misfit.space().numbers().size()).front());
  std::vector<bool> steady, moving;
  for (const auto& record : misfit.records()) {
    steady.push_back(record.kind == RecordKind::steady_velocity);
    moving.push_back(!steady.back());
  }
  const bool both = std::ranges::find(steady, true) != steady.end() && std::ranges::find(moving, true) != moving.end();
  std::vector<Eigen::Index> rest = all;
  if (both) {
    misfit.use(steady);
    const auto felt = felt_coordinates(misfit, base);
    const auto fits = stage(misfit, base, felt, {24, 6, 10, 60}, stop);
    if (!fits.empty() && !felt.empty()) {
      base = fits.front().u;
      rest = others(all, felt);
    }
    misfit.use(moving);
  }
  const int points = 8 * static_cast<int>(std::clamp<std::size_t>(rest.size(), 2, 6));
  const int refined = rest.size() > 6 ? 10 : 4;  // parallel elements have many local minima
  auto fits = stage(misfit, base, rest, {points, refined, 8, 30}, stop);
  misfit.use({});
  Fit best;
  best.u = base;
  for (std::size_t i = 0; i < std::min<std::size_t>(fits.size(), 2); ++i) {
    Fit joint = fit_within(misfit, fits[i], felt_coordinates(misfit, fits[i].u), 100, stop);
    if (joint.sum_of_squares < best.sum_of_squares) best = std::move(joint);
  }
  return best;
}

Fit begun_off_levels(const Misfit& misfit, const Fit& best, const std::function<bool()>& stop) {
  constexpr double factor_above = 0.3;  // as a logarithm
  const auto bounds = misfit.space().bounds();
  const auto between = [&](std::size_t b) { return bounds[b].above >= 0 && bounds[b].below >= 0; };
  Fit better = best;
  if (std::ranges::none_of(best.held, between)) return better;
  const auto felt = felt_coordinates(misfit, best.u);
  for (const double share : {0.2, 0.5, 0.8}) {
    if (stop && stop()) break;
    Fit from = best;
    from.held.clear();
    const Eigen::VectorXd middle = misfit.space().start(std::vector<double>(misfit.space().numbers().size(), share));
    for (Eigen::Index k = 0; k < from.u.size(); ++k)
      if (std::ranges::find(felt, k) == felt.end()) from.u(k) = middle(k);
    for (const auto b : best.held) {
      if (between(b))
        from.u(bounds[b].above) = from.u(bounds[b].below) + factor_above;
      else
        from.held.push_back(b);
    }
    const Fit next = fit_within(misfit, from, felt_coordinates(misfit, from.u), 60, stop);
    if (next.sum_of_squares < better.sum_of_squares - 1e-4) better = next;
  }
  return better;
}

}  // namespace limcycle
