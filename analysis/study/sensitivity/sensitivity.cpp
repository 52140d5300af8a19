#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace limcycle {
namespace {

constexpr std::size_t morris_levels = 8;

std::optional<double> number_of_answer(const std::optional<EnsembleOutcome>& answer, std::size_t output) {
  if (!answer) return std::nullopt;
  const double numbers[] = {answer->hunts, answer->amplitude, answer->period};
  return std::isfinite(numbers[output]) ? std::optional(numbers[output]) : std::nullopt;
}

/// Standard deviation of the answers caused by their own error alone; 0 for hunting or not.
double noise_of(std::size_t output, std::span<const std::optional<double>> answers, double relative) {
  if (output == 0) return 0.0;
  double largest = 0.0;
  for (const auto& answer : answers)
    if (answer) largest = std::max(largest, std::abs(*answer));
  return relative * largest;
}

}  // namespace

GlobalPlan::GlobalPlan(const ParameterSpread& spread, std::size_t trajectories, std::size_t samples, bool second_order)
    : spread_(spread),
      joint_(spread),
      morris_(spread.parameters.size(), trajectories, morris_levels, spread.seed),
      sobol_(spread.parameters.size(), samples, second_order && !joint_.correlated(), spread.seed) {}

std::vector<double> GlobalPlan::values(std::size_t row) const {
  if (joint_.correlated()) return joint_.values(sobol_.row(fair_row_of_sobol(row)));
  return joint_.values(row < morris_.rows() ? morris_.row(row) : sobol_.row(row - morris_.rows()));
}

std::size_t GlobalPlan::fair_row(std::size_t k) const {
  return joint_.correlated() ? k : morris_.rows() + fair_row_of_sobol(k);
}

std::size_t GlobalPlan::fair_row_of_sobol(std::size_t k) const {
  return k % 2 == 0 ? sobol_.row_a(k / 2) : sobol_.row_b(k / 2);
}

namespace {

std::optional<OutputBand> band_of(std::vector<double> answers) {
  if (answers.size() < answers_of_a_band) return std::nullopt;
  std::ranges::sort(answers);
  return OutputBand{percentile(answers, 0.025), percentile(answers, 0.5), percentile(answers, 0.975), answers.size()};
}

/// Answers in the fair rows: that a loop hunts, and the band of the output.
Probability look_at_fair_rows(const GlobalPlan& plan, const std::vector<std::optional<double>>& numbers,
                              OutputSensitivity& one) {
  std::size_t yes = 0, no = 0;
  std::vector<double> answers;
  for (std::size_t k = 0; k < plan.fair_rows(); ++k) {
    const auto& number = numbers[plan.fair_row(k)];
    if (!number) continue;
    ++(*number > 0.5 ? yes : no);
    answers.push_back(*number);
  }
  const Probability fair = probability(yes, no, plan.fair_rows() - yes - no);
  one.share_without_answer = static_cast<double>(fair.undecided) / static_cast<double>(plan.fair_rows());
  if (one.output != EnsembleOutcome::names[0]) one.band = band_of(std::move(answers));
  return fair;
}

}  // namespace

GlobalSensitivity global_sensitivity(const GlobalPlan& plan, std::span<const std::optional<EnsembleOutcome>> answers,
                                     double noise, const std::function<bool(std::size_t row)>& is_valid) {
  if (answers.size() != plan.size()) throw std::invalid_argument("as many answers as the plan has rows are needed");
  GlobalSensitivity result;
  for (std::size_t output = 0; output < EnsembleOutcome::numbers; ++output) {
    std::vector<std::optional<double>> numbers;
    for (const auto& answer : answers) numbers.push_back(number_of_answer(answer, output));
    OutputSensitivity one;
    one.output = EnsembleOutcome::names[output];
    const Probability fair = look_at_fair_rows(plan, numbers, one);
    if (output == 0) {
      for (std::size_t k = 0; k < plan.fair_rows() && is_valid; ++k)
        if (const std::size_t row = plan.fair_row(k); !numbers[row] && !is_valid(row)) ++result.not_valid;
      result.hunting = probability(fair.yes, fair.no, fair.undecided - result.not_valid);
    }
    if (plan.correlated()) {
      result.outputs.push_back(std::move(one));
      continue;
    }
    const auto for_morris = std::span<const std::optional<double>>(numbers).first(plan.morris().rows());
    const auto for_sobol = std::span<const std::optional<double>>(numbers).subspan(plan.morris().rows());
    SobolOptions options;
    options.seed = plan.spread().seed;
    options.noise = noise_of(output, numbers, noise);
    one.morris = morris_effects(plan.morris(), for_morris, options.resamples, options.seed);
    one.sobol = sobol_indices(plan.sobol(), for_sobol, options);
    one.convergence = sobol_convergence(plan.sobol(), for_sobol, options);
    if (output == 0) {
      const auto order = one.sobol.by_total();
      if (!order.empty() && one.sobol.parameters[order.front()].total.known) result.matters_most = order.front();
    }
    result.outputs.push_back(std::move(one));
  }
  return result;
}

}  // namespace limcycle
