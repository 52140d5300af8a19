#include "limcycle/analysis/study/sensitivity/global/sobol_estimators.hpp"

namespace limcycle {
namespace {

/// Sums over the base samples of a block, for one set of parameters.
struct ExchangeSums {
  double shared = 0.0, changed = 0.0, spread = 0.0, count = 0.0;

  void add(double p, double p_other, double r, double r_other) {
    shared += 2.0 * (p - r) * (r_other - p_other);
    changed += (p - r) * (p - r) + (p_other - r_other) * (p_other - r_other);
    spread += (p - p_other) * (p - p_other) + (r - r_other) * (r - r_other);
    count += 2.0;
  }
  /// Without r', which the mean replaces: 0.
  void add(double p, double p_other, double r) {
    shared += 2.0 * (r - p) * p_other;
    changed += (p - r) * (p - r);
    spread += (p - p_other) * (p - p_other);
    count += 1.0;
  }
  void add(const ExchangeSums& other, double weight) {
    shared += weight * other.shared, changed += weight * other.changed;
    spread += weight * other.spread, count += weight * other.count;
  }

  /// Nothing if the answers hardly differ from one another.
  std::optional<double> share(double part, double least) const {
    if (!(spread > 2.0 * least * least * count)) return std::nullopt;
    return part / spread;
  }
};
using ExchangeBlocks = std::vector<ExchangeSums>;

ExchangeBlocks of_parameter(const SobolSample& s, std::size_t i) {
  ExchangeBlocks blocks(s.blocks);
  for (std::size_t k = 0; k < s.samples; ++k) {
    const double a = *s.answers[s.design.row_a(k)], b = *s.answers[s.design.row_b(k)];
    const double ab = *s.answers[s.design.row_ab(k, i)];
    if (s.design.second_order())
      blocks[s.block(k)].add(a, b, ab, *s.answers[s.design.row_ba(k, i)]);
    else
      blocks[s.block(k)].add(a, b, ab);
  }
  return blocks;
}

ExchangeBlocks of_two(const SobolSample& s, std::size_t i, std::size_t j) {
  ExchangeBlocks blocks(s.blocks);
  for (std::size_t k = 0; k < s.samples; ++k)
    blocks[s.block(k)].add(*s.answers[s.design.row_ab(k, i)], *s.answers[s.design.row_ba(k, i)],
                           *s.answers[s.design.row_ab(k, j)], *s.answers[s.design.row_ba(k, j)]);
  return blocks;
}

ExchangeSums sum_of(const ExchangeBlocks& blocks, std::span<const double> weights) {
  ExchangeSums sum;
  for (std::size_t k = 0; k < blocks.size(); ++k) sum.add(blocks[k], weights[k]);
  return sum;
}

}  // namespace

SobolEstimator by_exchange(const SobolSample& sample) {
  const std::size_t d = sample.design.parameters();
  std::vector<ExchangeBlocks> one, two;
  for (std::size_t i = 0; i < d; ++i) one.push_back(of_parameter(sample, i));
  for (std::size_t i = 0; sample.design.second_order() && i < d; ++i)
    for (std::size_t j = i + 1; j < d; ++j) two.push_back(of_two(sample, i, j));
  const std::size_t pairs = sample.samples * (sample.design.second_order() ? 2 : 1);
  std::vector<std::size_t> counts(2 * one.size() + two.size(), pairs);
  return {[d, one = std::move(one), two = std::move(two), least = sample.least](std::span<const double> weights) {
            std::vector<std::optional<double>> found;
            for (const auto& blocks : one) {
              const ExchangeSums sum = sum_of(blocks, weights);
              found.push_back(sum.share(sum.shared, least));
              found.push_back(sum.share(sum.changed, least));
            }
            auto blocks = two.begin();
            for (std::size_t i = 0; blocks != two.end(); ++i)
              for (std::size_t j = i + 1; j < d; ++j, ++blocks) {
                const ExchangeSums sum = sum_of(*blocks, weights);
                found.push_back(interaction(sum.share(sum.shared, least), found[2 * i], found[2 * j]));
              }
            return found;
          },
          std::move(counts)};
}

}  // namespace limcycle
