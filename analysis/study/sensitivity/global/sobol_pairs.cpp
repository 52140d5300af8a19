#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/sensitivity/global/sobol_estimators.hpp"

namespace limcycle {
namespace {

/// Sums over the pairs of a block.
struct PairSums {
  double weight = 0.0, middle = 0.0, square = 0.0, product = 0.0;

  void add(double f, double g, double w) {
    weight += w;
    middle += w * 0.5 * (f + g);
    square += w * 0.5 * (f * f + g * g);
    product += w * f * g;
  }
  void add(const PairSums& other, double times) {
    weight += times * other.weight, middle += times * other.middle;
    square += times * other.square, product += times * other.product;
  }
  /// Nothing if the answers hardly differ from one another.
  std::optional<double> correlation(double least) const {
    if (weight == 0.0) return std::nullopt;
    const double mean = middle / weight, variance = square / weight - mean * mean;
    if (!(variance > least * least)) return std::nullopt;
    return (product / weight - mean * mean) / variance;
  }
};

/// Both answers at two points that share coordinates.
struct AnsweredPair {
  std::size_t block;
  double f, g;
  std::vector<double> point;  ///< one of the two
  double weight = 1.0;
};

/// Cells of one or two coordinates.
class Margin {
 public:
  Margin(std::size_t i, std::size_t j, double cells)
      : i_(i), j_(j), along_(static_cast<std::size_t>(std::max(1.0, i == j ? cells : std::sqrt(cells)))) {}
  std::size_t size() const { return i_ == j_ ? along_ : along_ * along_; }
  std::size_t cell(const std::vector<double>& point) const {
    const auto n = static_cast<double>(along_);
    const auto first = static_cast<std::size_t>(point[i_] * n);
    return i_ == j_ ? first : first * along_ + static_cast<std::size_t>(point[j_] * n);
  }

 private:
  std::size_t i_, j_, along_;
};

/// Pairs for an index, and the margins in which they must be distributed like answers.
class Pairs {
 public:
  explicit Pairs(const SobolSample& sample) : sample_(sample) {}

  /// Coordinates of `row` are shared with `other`. Added if both have answers.
  void add(std::size_t base_sample, std::size_t row, std::size_t other) {
    const auto &f = sample_.answers[row], &g = sample_.answers[other];
    if (f && g) pairs_.push_back({sample_.block(base_sample), *f, *g, sample_.design.row(row)});
  }
  std::size_t count() const { return pairs_.size(); }

  /// Weights the pairs until in each margin they are distributed as the rows A and B with answers (iterative
  /// proportional fitting).
  void rake(const std::vector<Margin>& margins) {
    std::vector<std::vector<double>> wanted;
    wanted.reserve(margins.size());
    for (const Margin& margin : margins) wanted.emplace_back(margin.size());
    for (std::size_t k = 0; k < sample_.samples; ++k)
      for (const auto row : {sample_.design.row_a(k), sample_.design.row_b(k)}) {
        if (!sample_.answers[row]) continue;
        const auto point = sample_.design.row(row);
        for (std::size_t m = 0; m < margins.size(); ++m) wanted[m][margins[m].cell(point)] += 1.0;
      }
    for (int sweep = 0; sweep < (margins.size() > 1 ? sweeps : 1); ++sweep)
      for (std::size_t m = 0; m < margins.size(); ++m) fit(margins[m], wanted[m]);
  }

  std::vector<PairSums> blocks() const {
    std::vector<PairSums> sums(sample_.blocks);
    for (const auto& pair : pairs_) sums[pair.block].add(pair.f, pair.g, pair.weight);
    return sums;
  }

 private:
  static constexpr int sweeps = 5;

  void fit(const Margin& margin, const std::vector<double>& wanted) {
    std::vector<double> present(margin.size());
    for (const auto& pair : pairs_) present[margin.cell(pair.point)] += pair.weight;
    for (auto& pair : pairs_) {
      const std::size_t cell = margin.cell(pair.point);
      if (present[cell] > 0.0) pair.weight *= wanted[cell] / present[cell];
    }
  }

  const SobolSample& sample_;
  std::vector<AnsweredPair> pairs_;
};

/// Number of cells of each margin: one for every 64 rows A and B, shared among the margins.
double cells_of(const SobolSample& s, std::size_t margins) {
  return static_cast<double>(s.samples) / (32.0 * static_cast<double>(margins));
}

Pairs first_pairs(const SobolSample& s, std::size_t i) {
  Pairs pairs(s);
  for (std::size_t k = 0; k < s.samples; ++k) {
    pairs.add(k, s.design.row_b(k), s.design.row_ab(k, i));
    if (s.design.second_order()) pairs.add(k, s.design.row_a(k), s.design.row_ba(k, i));
  }
  pairs.rake({Margin(i, i, cells_of(s, 1))});
  return pairs;
}

Pairs total_pairs(const SobolSample& s, std::size_t i) {
  Pairs pairs(s);
  for (std::size_t k = 0; k < s.samples; ++k) {
    pairs.add(k, s.design.row_a(k), s.design.row_ab(k, i));
    if (s.design.second_order()) pairs.add(k, s.design.row_b(k), s.design.row_ba(k, i));
  }
  std::vector<Margin> others;
  for (std::size_t j = 0; j < s.design.parameters(); ++j)
    if (j != i) others.emplace_back(j, j, cells_of(s, s.design.parameters() - 1));
  pairs.rake(others);
  return pairs;
}

/// AB_i and BA_j share x_i (of B) and x_j (of A), AB_j and BA_i the others of both.
Pairs closed_pairs(const SobolSample& s, std::size_t i, std::size_t j) {
  Pairs pairs(s);
  for (std::size_t k = 0; k < s.samples; ++k) {
    pairs.add(k, s.design.row_ab(k, i), s.design.row_ba(k, j));
    pairs.add(k, s.design.row_ab(k, j), s.design.row_ba(k, i));
  }
  pairs.rake({Margin(i, j, cells_of(s, 1))});
  return pairs;
}

/// A and B share nothing: any correlation of their answers is chance.
Pairs independent_pairs(const SobolSample& s) {
  Pairs pairs(s);
  for (std::size_t k = 0; k < s.samples; ++k) pairs.add(k, s.design.row_a(k), s.design.row_b(k));
  return pairs;
}

/// Subtracts the chance of `independent` from the correlations: AB_i equals A as far as x_i has no effect, that is with
/// the correlation 1 - T_i, so that B and AB_i have that share of the chance correlation of B and A. (A control
/// variate: its mean is 0, so that no index is biased.)
void without_chance(std::vector<std::optional<double>>& found, std::size_t d, std::optional<double> independent) {
  if (!independent) return;
  const auto kept = [&](std::size_t i) {
    return found[2 * i + 1] ? std::clamp(1.0 - *found[2 * i + 1], 0.0, 1.0) : 0.0;
  };
  for (std::size_t i = 0; i < d; ++i)
    if (auto& first = found[2 * i]) *first -= kept(i) * *independent;
  std::size_t next = 2 * d;
  for (std::size_t i = 0; next < found.size(); ++i)
    for (std::size_t j = i + 1; j < d; ++j, ++next)
      if (auto& closed = found[next]) *closed -= kept(i) * kept(j) * *independent;
}

std::optional<double> correlation(const std::vector<PairSums>& blocks, std::span<const double> weights, double least) {
  PairSums sum;
  for (std::size_t k = 0; k < blocks.size(); ++k) sum.add(blocks[k], weights[k]);
  return sum.correlation(least);
}

}  // namespace

SobolEstimator by_pairs(const SobolSample& sample) {
  const std::size_t d = sample.design.parameters();
  std::vector<std::vector<PairSums>> sums;
  std::vector<std::size_t> counts;
  const auto take = [&](const Pairs& pairs) {
    sums.push_back(pairs.blocks());
    counts.push_back(pairs.count());
  };
  for (std::size_t i = 0; i < d; ++i) {
    take(first_pairs(sample, i));
    take(total_pairs(sample, i));
  }
  for (std::size_t i = 0; sample.design.second_order() && i < d; ++i)
    for (std::size_t j = i + 1; j < d; ++j) take(closed_pairs(sample, i, j));
  return {[d, sums = std::move(sums), chance = independent_pairs(sample).blocks(),
           least = sample.least](std::span<const double> weights) {
            std::vector<std::optional<double>> found;
            for (const auto& blocks : sums) found.push_back(correlation(blocks, weights, least));
            for (std::size_t i = 0; i < d; ++i)
              if (auto& total = found[2 * i + 1]) total = 1.0 - *total;
            without_chance(found, d, correlation(chance, weights, least));
            std::size_t next = 2 * d;
            for (std::size_t i = 0; next < found.size(); ++i)
              for (std::size_t j = i + 1; j < d; ++j, ++next)
                found[next] = interaction(found[next], found[2 * i], found[2 * j]);
            return found;
          },
          std::move(counts)};
}

}  // namespace limcycle
