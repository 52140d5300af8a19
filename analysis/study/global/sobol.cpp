#include "limcycle/analysis/study/global/sobol.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "limcycle/analysis/study/global/bootstrap.hpp"
#include "limcycle/analysis/study/global/scaled_answers.hpp"

namespace limcycle {
namespace {

constexpr std::size_t fewest_samples = 8;  ///< that have an interval
constexpr std::size_t most_blocks = 64;

/// Sums over the base samples of a block.
struct BlockSums {
  double shared = 0.0, changed = 0.0, spread = 0.0, count = 0.0;
};

/// The estimator for one set of parameters, block by block of the sample. p and p' are answers at independent points; r
/// and r' at those points after they exchanged the coordinates in the set. Then E (p - r)(r' - p') = 2 V_first,
/// E (p - r)^2 = E (p' - r')^2 = 2 V_total and E (p - p')^2 = E (r - r')^2 = 2 V.
struct Exchange {
  std::vector<BlockSums> blocks;
  std::size_t samples = 0;

  void add(std::size_t block, double p, double p_other, double r, double r_other) {
    auto& sums = blocks[block];
    sums.shared += 2.0 * (p - r) * (r_other - p_other);
    sums.changed += (p - r) * (p - r) + (p_other - r_other) * (p_other - r_other);
    sums.spread += (p - p_other) * (p - p_other) + (r - r_other) * (r - r_other);
    sums.count += 2.0;
    ++samples;
  }
  /// Without r': in the first product any number may stand for it, the mean at best, which is 0 here.
  void add(std::size_t block, double p, double p_other, double r) {
    auto& sums = blocks[block];
    sums.shared += 2.0 * (r - p) * p_other;
    sums.changed += (p - r) * (p - r);
    sums.spread += (p - p_other) * (p - p_other);
    sums.count += 1.0;
    ++samples;
  }
  BlockSums weighted(std::span<const double> weights) const {
    BlockSums sum;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      sum.shared += weights[k] * blocks[k].shared;
      sum.changed += weights[k] * blocks[k].changed;
      sum.spread += weights[k] * blocks[k].spread;
      sum.count += weights[k] * blocks[k].count;
    }
    return sum;
  }
};

/// Of two parameters: their exchange together, and those of each in the same samples.
struct InteractionExchange {
  Exchange both, one, other;
};

class SobolSums {
 public:
  SobolSums(const SobolDesign& design, const ScaledAnswers& answers, std::size_t samples, double noise)
      : design_(design), y_(answers), samples_(samples), blocks_(std::min(samples, most_blocks)) {
    least_ = y_.least(noise);
    for (std::size_t i = 0; i < design.parameters(); ++i) parameters_.push_back(of_parameter(i));
    if (!design.second_order()) return;
    for (std::size_t i = 0; i < design.parameters(); ++i)
      for (std::size_t k = i + 1; k < design.parameters(); ++k) interactions_.push_back(of_interaction(i, k));
  }

  std::size_t blocks() const { return blocks_; }
  const std::vector<Exchange>& parameters() const { return parameters_; }
  const std::vector<InteractionExchange>& interactions() const { return interactions_; }

  /// First and total index of each parameter, then the interactions.
  std::vector<std::optional<double>> indices(std::span<const double> weights) const {
    std::vector<std::optional<double>> found;
    for (const auto& exchange : parameters_) {
      const BlockSums sum = exchange.weighted(weights);
      found.push_back(share(sum, sum.shared));
      found.push_back(share(sum, sum.changed));
    }
    for (const auto& [both, one, other] : interactions_) {
      const BlockSums b = both.weighted(weights), i = one.weighted(weights), k = other.weighted(weights);
      const auto closed = share(b, b.shared), first_i = share(i, i.shared), first_k = share(k, k.shared);
      found.push_back(closed && first_i && first_k ? std::optional(*closed - *first_i - *first_k) : std::nullopt);
    }
    return found;
  }

 private:
  /// Nothing where the answers hardly differ from one another.
  std::optional<double> share(const BlockSums& sum, double part) const {
    if (!(sum.spread > 2.0 * least_ * least_ * sum.count)) return std::nullopt;
    return part / sum.spread;
  }

  Exchange of_parameter(std::size_t i) const {
    Exchange exchange{std::vector<BlockSums>(blocks_)};
    for (std::size_t k = 0; k < samples_; ++k) {
      const auto &a = y_[design_.row_a(k)], &b = y_[design_.row_b(k)], &ab = y_[design_.row_ab(k, i)];
      if (!a || !b || !ab) continue;
      if (!design_.second_order())
        exchange.add(block(k), *a, *b, *ab);
      else if (const auto& ba = y_[design_.row_ba(k, i)])
        exchange.add(block(k), *a, *b, *ab, *ba);
    }
    return exchange;
  }

  /// AB_i and BA_i are independent points, and exchange the coordinates i and j to be AB_j and BA_j.
  InteractionExchange of_interaction(std::size_t i, std::size_t j) const {
    const Exchange empty{std::vector<BlockSums>(blocks_)};
    InteractionExchange sums{empty, empty, empty};
    for (std::size_t k = 0; k < samples_; ++k) {
      const auto &a = y_[design_.row_a(k)], &b = y_[design_.row_b(k)];
      const auto &ab_i = y_[design_.row_ab(k, i)], &ba_i = y_[design_.row_ba(k, i)];
      const auto &ab_j = y_[design_.row_ab(k, j)], &ba_j = y_[design_.row_ba(k, j)];
      if (!a || !b || !ab_i || !ba_i || !ab_j || !ba_j) continue;
      sums.both.add(block(k), *ab_i, *ba_i, *ab_j, *ba_j);
      sums.one.add(block(k), *a, *b, *ab_i, *ba_i);
      sums.other.add(block(k), *a, *b, *ab_j, *ba_j);
    }
    return sums;
  }

  std::size_t block(std::size_t sample) const { return sample * blocks_ / samples_; }

  const SobolDesign& design_;
  const ScaledAnswers& y_;
  std::size_t samples_, blocks_;
  double least_ = 0.0;
  std::vector<Exchange> parameters_;
  std::vector<InteractionExchange> interactions_;
};

Estimate trusted(Estimate estimate, std::size_t samples) {
  if (samples >= fewest_samples) return estimate;
  Estimate wide;
  wide.value = estimate.value, wide.known = estimate.known;
  return wide;
}

void estimate(const SobolSums& sums, const SobolOptions& options, SobolIndices& result) {
  const auto found = bootstrap(sums.blocks(), options.resamples, RandomStream(options.seed, "Sobol bootstrap"),
                               [&](std::span<const double> weights) { return sums.indices(weights); });
  auto next = found.begin();
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    auto& index = result.parameters[i];
    index.samples = sums.parameters()[i].samples;
    index.first = trusted(*next++, index.samples);
    index.total = trusted(*next++, index.samples);
  }
  for (std::size_t i = 0; i < result.interactions.size(); ++i) {
    auto& interaction = result.interactions[i];
    interaction.samples = sums.interactions()[i].both.samples;
    interaction.share = trusted(*next++, interaction.samples);
  }
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
  SobolIndices result = nothing_known(design, samples);
  result.rows_without_answer = scaled.missing();
  result.mean = scaled.mean();
  result.deviation = scaled.deviation();
  if (scaled.missing() == scaled.rows())
    result.notes.emplace_back("no row has an answer: nothing is known");
  else if (scaled.constant(options.noise))
    result.notes.emplace_back("the answers do not vary: there is no variance to share out");
  else
    estimate(SobolSums(design, scaled, samples, options.noise), options, result);
  if (scaled.missing() > 0 && scaled.missing() < scaled.rows())
    result.notes.push_back(std::to_string(scaled.missing()) + " of " + std::to_string(scaled.rows()) +
                           " rows have no answer: the indices are those within the part of the space that answers; "
                           "parameters are not independent there, and indices need not add up");
  return result;
}

std::vector<SobolIndices> sobol_convergence(const SobolDesign& design, RowAnswers answers,
                                            const SobolOptions& options) {
  const std::size_t samples = options.samples > 0 ? options.samples : design.samples();
  std::vector<SobolIndices> steps;
  for (const std::size_t part : {8, 4, 2, 1}) {
    SobolOptions fewer = options;
    fewer.samples = samples / part;
    if (fewer.samples >= fewest_samples || part == 1) steps.push_back(sobol_indices(design, answers, fewer));
  }
  return steps;
}

}  // namespace limcycle
