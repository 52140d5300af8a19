#include "limcycle/analysis/study/sensitivity/global/sobol.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "limcycle/analysis/study/sensitivity/global/sobol_estimators.hpp"

namespace limcycle {
namespace {

constexpr std::size_t fewest_pairs = 16;   ///< of answers for an interval
constexpr std::size_t fewest_samples = 8;  ///< of a step of convergence
constexpr std::size_t most_blocks = 64;

/// The estimate, but without an interval if there are too few pairs for one.
Estimate trusted(Estimate estimate, std::size_t pairs) {
  if (pairs >= fewest_pairs) return estimate;
  Estimate wide;
  wide.value = estimate.value, wide.known = estimate.known;
  return wide;
}

void fill(const SobolEstimator& estimator, std::size_t blocks, const SobolOptions& options, SobolIndices& result) {
  const auto found =
      bootstrap(blocks, options.resamples, RandomStream(options.seed, "Sobol bootstrap"), estimator.indices);
  std::size_t next = 0;
  const auto take = [&](Estimate& estimate, std::size_t& pairs) {
    pairs = estimator.pairs[next];
    estimate = trusted(found[next++], pairs);
  };
  for (auto& index : result.parameters) {
    take(index.first, index.first_pairs);
    take(index.total, index.total_pairs);
  }
  for (auto& interaction : result.interactions) take(interaction.share, interaction.pairs);
}

std::string without_answer(const ScaledAnswers& answers) {
  return std::to_string(answers.missing()) + " of " + std::to_string(answers.rows()) +
         " rows have no answer: the indices are of the parameters' distribution among answers. Where the parameters "
         "decide whether there is one, they are not independent there, and indices need not add up";
}

SobolIndices nothing_known(const SobolDesign& design, std::size_t samples) {
  SobolIndices result;
  result.samples = samples;
  result.rows = samples * design.rows_per_sample();
  result.parameters.resize(design.parameters());
  for (std::size_t i = 0; design.second_order() && i < design.parameters(); ++i)
    for (std::size_t k = i + 1; k < design.parameters(); ++k) result.interactions.push_back({i, k, {}, 0});
  return result;
}

}  // namespace

double SobolIndices::share_without_answer() const {
  return rows > 0 ? static_cast<double>(rows_without_answer) / static_cast<double>(rows) : 0.0;
}

std::vector<std::size_t> SobolIndices::by_total() const {
  std::vector<std::size_t> order(parameters.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t k) {
    const auto &one = parameters[i].total, &other = parameters[k].total;
    return one.known != other.known ? one.known : one.value > other.value;
  });
  return order;
}

SobolIndices sobol_indices(const SobolDesign& design, RowAnswers answers, const SobolOptions& options) {
  if (answers.size() != design.rows())
    throw std::invalid_argument("Sobol indices need an answer, or none, for each of the design's " +
                                std::to_string(design.rows()) + " rows, got " + std::to_string(answers.size()));
  if (options.samples > design.samples())
    throw std::invalid_argument("the design has " + std::to_string(design.samples()) + " samples, not " +
                                std::to_string(options.samples));
  if (!(options.noise >= 0.0 && std::isfinite(options.noise)))
    throw std::invalid_argument("the noise of answers is a finite number, not below 0");
  const std::size_t samples = options.samples > 0 ? options.samples : design.samples();
  const ScaledAnswers scaled(design, answers, samples);
  const SobolSample sample{design, scaled, samples, std::min(samples, most_blocks), scaled.least(options.noise)};
  SobolIndices result = nothing_known(design, samples);
  result.rows_without_answer = scaled.missing();
  result.mean = scaled.mean();
  result.deviation = scaled.deviation();
  if (scaled.missing() == scaled.rows())
    result.notes.emplace_back("no row has an answer: nothing is known");
  else if (scaled.base() < 2)
    result.notes.emplace_back("fewer than two of the rows A and B have an answer: nothing is known");
  else if (scaled.constant(options.noise))
    result.notes.emplace_back("the answers do not vary: there is no variance to share out");
  else if (scaled.missing() == 0)
    fill(by_exchange(sample), sample.blocks, options, result);
  else {
    fill(by_pairs(sample), sample.blocks, options, result);
    result.notes.push_back(without_answer(scaled));
  }
  return result;
}

std::vector<SobolIndices> sobol_convergence(const SobolDesign& design, RowAnswers answers,
                                            const SobolOptions& options) {
  const std::size_t samples = options.samples > 0 ? options.samples : design.samples();
  std::vector<SobolIndices> steps;
  for (const std::size_t part : {8U, 4U, 2U, 1U}) {
    SobolOptions fewer = options;
    fewer.samples = samples / part;
    if (fewer.samples >= fewest_samples || part == 1) steps.push_back(sobol_indices(design, answers, fewer));
  }
  return steps;
}

}  // namespace limcycle
