#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"

#include <cmath>
#include <stdexcept>

namespace limcycle {
namespace {

constexpr std::size_t morris_levels = 8;

std::optional<double> number_of_answer(const std::optional<HuntingAnswer>& answer, std::size_t output) {
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
      morris_(spread.parameters.size(), trajectories, morris_levels, spread.seed),
      sobol_(spread.parameters.size(), samples, second_order, spread.seed) {}

std::vector<double> GlobalPlan::values(std::size_t row) const {
  std::vector<double> at = row < morris_.rows() ? morris_.row(row) : sobol_.row(row - morris_.rows());
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = spread_.parameters[i].quantile(at[i]);
  return at;
}

GlobalSensitivity global_sensitivity(const GlobalPlan& plan, std::span<const std::optional<HuntingAnswer>> answers,
                                     double noise) {
  if (answers.size() != plan.size()) throw std::invalid_argument("as many answers as the plan has rows are needed");
  GlobalSensitivity result;
  for (std::size_t output = 0; output < HuntingAnswer::numbers; ++output) {
    std::vector<std::optional<double>> numbers;
    for (const auto& answer : answers) numbers.push_back(number_of_answer(answer, output));
    const auto for_morris = std::span<const std::optional<double>>(numbers).first(plan.morris().rows());
    const auto for_sobol = std::span<const std::optional<double>>(numbers).subspan(plan.morris().rows());
    SobolOptions options;
    options.seed = plan.spread().seed;
    options.noise = noise_of(output, numbers, noise);
    OutputSensitivity one;
    one.output = HuntingAnswer::names[output];
    const Probability fair = probability(plan.sobol(), for_sobol);
    one.share_without_answer = static_cast<double>(fair.undecided) / static_cast<double>(2 * plan.sobol().samples());
    one.morris = morris_effects(plan.morris(), for_morris, options.resamples, options.seed);
    one.sobol = sobol_indices(plan.sobol(), for_sobol, options);
    one.convergence = sobol_convergence(plan.sobol(), for_sobol, options);
    if (output == 0) {
      result.hunting = probability(plan.sobol(), for_sobol);
      const auto order = one.sobol.by_total();
      if (!order.empty() && one.sobol.parameters[order.front()].total.known) result.matters_most = order.front();
    }
    result.outputs.push_back(std::move(one));
  }
  return result;
}

}  // namespace limcycle
