#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/global/sobol_estimators.hpp"

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
  /// Nothing where the answers hardly differ from one another.
  std::optional<double> correlation(double least) const {
    if (weight == 0.0) return std::nullopt;
    const double mean = middle / weight, variance = square / weight - mean * mean;
    if (!(variance > least * least)) return std::nullopt;
    return (product / weight - mean * mean) / variance;
  }
};

struct Pairs {
  std::vector<PairSums> blocks;
  std::size_t count = 0;

  void add(std::size_t block, const std::optional<double>& f, const std::optional<double>& g, double weight) {
    if (!f || !g) return;
    blocks[block].add(*f, *g, weight);
    ++count;
  }
  std::optional<double> correlation(std::span<const double> weights, double least) const {
    PairSums sum;
    for (std::size_t k = 0; k < blocks.size(); ++k) sum.add(blocks[k], weights[k]);
    return sum.correlation(least);
  }
};

/// Share of answers in cells of one or two coordinates, in the rows A and B.
class AnswerShare {
 public:
  AnswerShare(const SobolSample& s, std::size_t i, std::size_t j)
      : i_(i), j_(j), cells_(cells_along(s.samples, i == j)) {
    asked_.resize(i == j ? cells_ : cells_ * cells_);
    answered_.resize(asked_.size());
    for (std::size_t k = 0; k < s.samples; ++k)
      for (const auto row : {s.design.row_a(k), s.design.row_b(k)}) {
        const auto point = s.design.row(row);
        const std::size_t cell = cell_of(point);
        asked_[cell] += 1.0;
        if (s.answers[row]) answered_[cell] += 1.0;
      }
  }
  /// Of a pair that shares these coordinates of a point; 1 in a cell where no row A or B answered.
  double weight(const std::vector<double>& point) const {
    const std::size_t cell = cell_of(point);
    return answered_[cell] > 0.0 ? asked_[cell] / answered_[cell] : 1.0;
  }

 private:
  /// As many that 64 rows fall into each.
  static std::size_t cells_along(std::size_t samples, bool one) {
    const double cells = static_cast<double>(samples) / 32.0;
    return static_cast<std::size_t>(std::max(1.0, one ? cells : std::sqrt(cells)));
  }
  std::size_t cell_of(const std::vector<double>& point) const {
    const double n = static_cast<double>(cells_);
    const auto along = static_cast<std::size_t>(point[i_] * n);
    return i_ == j_ ? along : along * cells_ + static_cast<std::size_t>(point[j_] * n);
  }

  std::size_t i_, j_, cells_;
  std::vector<double> asked_, answered_;
};

Pairs first_pairs(const SobolSample& s, std::size_t i) {
  Pairs pairs{std::vector<PairSums>(s.blocks)};
  const AnswerShare share(s, i, i);
  for (std::size_t k = 0; k < s.samples; ++k) {
    const std::size_t a = s.design.row_a(k), b = s.design.row_b(k), ab = s.design.row_ab(k, i);
    pairs.add(s.block(k), s.answers[b], s.answers[ab], share.weight(s.design.row(b)));
    if (!s.design.second_order()) continue;
    pairs.add(s.block(k), s.answers[a], s.answers[s.design.row_ba(k, i)], share.weight(s.design.row(a)));
  }
  return pairs;
}

Pairs total_pairs(const SobolSample& s, std::size_t i) {
  Pairs pairs{std::vector<PairSums>(s.blocks)};
  for (std::size_t k = 0; k < s.samples; ++k) {
    pairs.add(s.block(k), s.answers[s.design.row_a(k)], s.answers[s.design.row_ab(k, i)], 1.0);
    if (!s.design.second_order()) continue;
    pairs.add(s.block(k), s.answers[s.design.row_b(k)], s.answers[s.design.row_ba(k, i)], 1.0);
  }
  return pairs;
}

/// AB_i and BA_j share x_i (of B) and x_j (of A), AB_j and BA_i the others of both.
Pairs closed_pairs(const SobolSample& s, std::size_t i, std::size_t j) {
  Pairs pairs{std::vector<PairSums>(s.blocks)};
  const AnswerShare share(s, i, j);
  for (std::size_t k = 0; k < s.samples; ++k)
    for (const auto& [one, other] : {std::pair(i, j), std::pair(j, i)}) {
      const std::size_t ab = s.design.row_ab(k, one), ba = s.design.row_ba(k, other);
      pairs.add(s.block(k), s.answers[ab], s.answers[ba], share.weight(s.design.row(ab)));
    }
  return pairs;
}

}  // namespace

SobolEstimator by_pairs(const SobolSample& sample) {
  const std::size_t d = sample.design.parameters();
  std::vector<Pairs> all;
  for (std::size_t i = 0; i < d; ++i) {
    all.push_back(first_pairs(sample, i));
    all.push_back(total_pairs(sample, i));
  }
  for (std::size_t i = 0; sample.design.second_order() && i < d; ++i)
    for (std::size_t j = i + 1; j < d; ++j) all.push_back(closed_pairs(sample, i, j));
  std::vector<std::size_t> counts;
  for (const Pairs& pairs : all) counts.push_back(pairs.count);
  return {[d, all = std::move(all), least = sample.least](std::span<const double> weights) {
            std::vector<std::optional<double>> found;
            for (const Pairs& pairs : all) found.push_back(pairs.correlation(weights, least));
            for (std::size_t i = 0; i < d; ++i)
              if (auto& total = found[2 * i + 1]) total = 1.0 - *total;
            std::size_t next = 2 * d;
            for (std::size_t i = 0; next < found.size(); ++i)
              for (std::size_t j = i + 1; j < d; ++j, ++next)
                found[next] = interaction(found[next], found[2 * i], found[2 * j]);
            return found;
          },
          std::move(counts)};
}

}  // namespace limcycle
