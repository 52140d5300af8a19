#include "limcycle/models/measured/fit_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limcycle {
namespace {

constexpr double exact = 1e-9;  ///< relative error of a fit that could not be better

double slope_over(const FrequencyData& data, std::size_t from, std::size_t to) {
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(to - from);
  for (std::size_t i = from; i < to; ++i) {
    mean_x += std::log(data.frequency[i]) / n;
    mean_y += std::log(std::abs(data.response[i])) / n;
  }
  for (std::size_t i = from; i < to; ++i) {
    const double x = std::log(data.frequency[i]) - mean_x;
    xx += x * x;
    xy += x * (std::log(std::abs(data.response[i])) - mean_y);
  }
  return xx > 0.0 ? xy / xx : 0.0;
}

/// Misfit of a fit with the relative error `exact` everywhere.
double least_misfit(const FrequencyData& data) {
  double weights = data.deviation.empty() ? static_cast<double>(data.size()) : 0.0;
  for (const double deviation : data.deviation) weights += deviation > 0.0 ? 1.0 / (deviation * deviation) : 1.0;
  return 0.5 * exact * exact * weights / static_cast<double>(data.size());
}

/// Schwarz's criterion of a fit: the less the better.
double criterion(const FrequencyData& data, const VectorFit& fit) {
  const double numbers = 2.0 * static_cast<double>(data.size());
  const int fitted = 2 * fit.shape.order - fit.shape.poles_at_zero - (fit.shape.relative_degree - 1);
  return numbers * std::log(std::max(fit.misfit, least_misfit(data))) + fitted * std::log(numbers);
}

constexpr std::size_t points_to_choose = 1000;

/// At most about `points_to_choose` of the points, no nearer to each other than they would be at equal steps of the
/// logarithm.
FrequencyData thinned(const FrequencyData& data) {
  FrequencyData few;
  const double step = std::pow(data.frequency.back() / data.frequency.front(), 1.0 / points_to_choose);
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (i > 0 && i + 1 < data.size() && data.frequency[i] < step * few.frequency.back()) continue;
    few.frequency.push_back(data.frequency[i]);
    few.response.push_back(data.response[i]);
    if (!data.deviation.empty()) few.deviation.push_back(data.deviation[i]);
  }
  return few;
}

class FitChoice {
 public:
  FitChoice(const FrequencyData& data, const FitWish& wish) : data_(data), wish_(wish) {}

  std::optional<VectorFit> run() {
    const EndSlopes slopes = end_slopes(data_);
    for (int degree = 2; degree >= 1; --degree) {
      const bool chosen = slopes.high > -1.5 || degree == 2;
      if (wish_.relative_degree ? *wish_.relative_degree != degree : !chosen) continue;
      for (int k = 2; k >= 0; --k) {
        const bool may = k == 0 || slopes.low <= 0.5 - k;
        if (wish_.poles_at_zero ? *wish_.poles_at_zero == k : may) try_orders(k, degree);
      }
    }
    return std::move(best_);
  }

 private:
  /// Another number of poles at zero, or another relative degree, changes the order that is needed by two at most.
  void try_orders(int poles_at_zero, int relative_degree) {
    const int least = std::max(poles_at_zero, relative_degree), known = best_ ? best_->shape.order : 0;
    const int from = std::max(wish_.order.value_or(known - 2), wish_.order ? 0 : least);
    const int to = wish_.order.value_or(std::min(most_chosen_order, known > 0 ? known + 2 : most_chosen_order));
    if (from < least) return;
    double least_here = std::numeric_limits<double>::infinity();
    int worse = 0;
    for (int order = from; order <= to && worse < 4; ++order) {
      if (static_cast<std::size_t>(least_points(order)) > data_.size()) return;
      VectorFit fit = vector_fit(data_, {order, poles_at_zero, relative_degree});
      if (fit.model.states() == 0) continue;
      const double here = criterion(data_, fit);
      worse = here < least_here ? 0 : worse + 1;
      least_here = std::min(least_here, here);
      const bool is_exact = fit.error.rms < exact;
      if (!best_ || here < least_) {
        least_ = here;
        best_ = std::move(fit);
      }
      if (is_exact) return;
    }
  }

  const FrequencyData& data_;
  const FitWish& wish_;
  std::optional<VectorFit> best_;
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

EndSlopes end_slopes(const FrequencyData& data) {
  const std::size_t n = data.size();
  if (n < 2) return {};
  const double reach = std::cbrt(10.0);
  std::size_t low = std::min<std::size_t>(n, 3), high = n - low;
  while (low < n && data.frequency[low] <= reach * data.frequency.front()) ++low;
  while (high > 0 && data.frequency[high - 1] >= data.frequency.back() / reach) --high;
  return {slope_over(data, 0, low), slope_over(data, high, n)};
}

std::optional<VectorFit> chosen_fit(const FrequencyData& data, const FitWish& wish) {
  if (wish.order || data.size() <= 2 * points_to_choose) return FitChoice(data, wish).run();
  const auto rough = FitChoice(thinned(data), wish).run();
  if (!rough) return std::nullopt;
  return vector_fit(data, rough->shape);
}

}  // namespace limcycle
