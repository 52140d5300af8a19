#include "limcycle/analysis/study/sensitivity/global/morris.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/study/sensitivity/global/bootstrap.hpp"

namespace limcycle {
namespace {

/// mu, mu* and sigma of effects, of which number k counts weights[k] times.
std::vector<std::optional<double>> moments(std::span<const double> effects, std::span<const double> weights) {
  double count = 0.0, sum = 0.0, sizes = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    count += weights[k];
    sum += weights[k] * effects[k];
    sizes += weights[k] * std::abs(effects[k]);
  }
  if (count == 0.0) return {std::nullopt, std::nullopt, std::nullopt};
  const double mu = sum / count;
  for (std::size_t k = 0; k < effects.size(); ++k) squares += weights[k] * (effects[k] - mu) * (effects[k] - mu);
  return {mu, sizes / count, count > 1.0 ? std::optional(std::sqrt(squares / (count - 1.0))) : std::nullopt};
}

Estimate scaled_by(Estimate estimate, double factor) {
  estimate.value *= factor, estimate.low *= factor, estimate.high *= factor;
  return estimate;
}

/// Results for one parameter, from its effects. They are scaled, so that none of their squares overflows.
void describe(std::vector<double> effects, std::size_t resamples, const RandomStream& random, MorrisEffects& result) {
  result.effects = effects.size();
  double size = 0.0;
  for (const double effect : effects) size = std::max(size, std::abs(effect));
  if (size == 0.0) size = 1.0;
  for (double& effect : effects) effect /= size;
  const auto found = bootstrap(effects.size(), resamples, random,
                               [&](std::span<const double> weights) { return moments(effects, weights); });
  result.mu = scaled_by(found[0], size);
  result.mu_star = scaled_by(found[1], size);
  result.sigma = scaled_by(found[2], size);
}

/// Effect of the move that follows row_of(trajectory, move); nothing without an answer on either side.
std::optional<double> effect(const MorrisDesign& design, RowAnswers answers, std::size_t trajectory, std::size_t move) {
  const auto &before = answers[design.row_of(trajectory, move)], &after = answers[design.row_of(trajectory, move + 1)];
  if (!before || !after) return std::nullopt;
  const double change = (*after - *before) / MorrisDesign::step;
  if (!std::isfinite(change)) return std::nullopt;
  return design.upwards(trajectory, design.moved(trajectory, move)) ? change : -change;
}

double part_of(std::size_t part, std::size_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

}  // namespace

MorrisDesign::MorrisDesign(std::size_t parameters, std::size_t trajectories, std::size_t levels, std::uint64_t seed)
    : parameters_(parameters), trajectories_(trajectories), levels_(levels) {
  if (parameters == 0 || trajectories == 0)
    throw std::invalid_argument("a Morris design needs a parameter and a trajectory at least");
  if (levels < 4 || levels % 2 != 0)
    throw std::invalid_argument("a Morris design needs an even number of levels, 4 at least, got " +
                                std::to_string(levels));
  for (std::size_t t = 0; t < trajectories; ++t) {
    RandomStream random(seed, "Morris design", t);
    for (std::size_t i = 0; i < parameters; ++i) start_.push_back(random.below(levels));
    const std::size_t first = order_.size();
    for (std::size_t i = 0; i < parameters; ++i) {
      order_.push_back(i);
      std::swap(order_.back(), order_[first + random.below(i + 1)]);
    }
  }
}

std::size_t MorrisDesign::moved(std::size_t trajectory, std::size_t move) const {
  return order_[trajectory * parameters_ + move];
}

bool MorrisDesign::upwards(std::size_t trajectory, std::size_t parameter) const {
  return start_[trajectory * parameters_ + parameter] < levels_ / 2;
}

std::vector<double> MorrisDesign::row(std::size_t k) const {
  if (k >= rows()) throw std::out_of_range("row " + std::to_string(k) + " of a design of " + std::to_string(rows()));
  const std::size_t trajectory = k / (parameters_ + 1), moves = k % (parameters_ + 1);
  std::vector<double> point;
  for (std::size_t i = 0; i < parameters_; ++i)
    point.push_back((static_cast<double>(start_[trajectory * parameters_ + i]) + 0.5) / static_cast<double>(levels_));
  for (std::size_t move = 0; move < moves; ++move) {
    const std::size_t i = moved(trajectory, move);
    point[i] += upwards(trajectory, i) ? step : -step;
  }
  return point;
}

double MorrisEffects::share_without_answer() const { return part_of(without_answer, effects + without_answer); }
double MorrisResult::share_without_answer() const { return part_of(rows_without_answer, rows); }

std::vector<std::size_t> MorrisResult::by_mu_star() const {
  std::vector<std::size_t> order(parameters.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t k) {
    const auto &one = parameters[i].mu_star, &other = parameters[k].mu_star;
    return one.known != other.known ? one.known : one.value > other.value;
  });
  return order;
}

MorrisResult morris_effects(const MorrisDesign& design, RowAnswers answers, std::size_t resamples, std::uint64_t seed) {
  if (answers.size() != design.rows())
    throw std::invalid_argument("elementary effects need an answer, or none, for each of the design's " +
                                std::to_string(design.rows()) + " rows, got " + std::to_string(answers.size()));
  MorrisResult result;
  result.rows = design.rows();
  result.parameters.resize(design.parameters());
  for (const auto& y : answers)
    if (!y || !std::isfinite(*y)) ++result.rows_without_answer;
  std::vector<std::vector<double>> effects(design.parameters());
  for (std::size_t t = 0; t < design.trajectories(); ++t)
    for (std::size_t move = 0; move < design.parameters(); ++move) {
      const std::size_t i = design.moved(t, move);
      if (const auto found = effect(design, answers, t, move))
        effects[i].push_back(*found);
      else
        ++result.parameters[i].without_answer;
    }
  for (std::size_t i = 0; i < effects.size(); ++i)
    describe(std::move(effects[i]), resamples, RandomStream(seed, "Morris bootstrap", i), result.parameters[i]);
  if (result.rows_without_answer > 0)
    result.notes.push_back(std::to_string(result.rows_without_answer) + " of " + std::to_string(result.rows) +
                           " rows have no answer; the effects are those between rows that have one");
  return result;
}

}  // namespace limcycle
