#include "limcycle/models/measured/measured_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

namespace limcycle {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

std::string number(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string percent(double share) { return number(100.0 * share, share < 1.0 ? 2 : 4) + " %"; }

/// The data without the dead time.
FrequencyData advanced(const FrequencyData& data, double delay) {
  FrequencyData early = data;
  for (std::size_t i = 0; i < early.size(); ++i) early.response[i] *= std::polar(1.0, early.frequency[i] * delay);
  return early;
}

VectorFit fitted(const FrequencyData& data, const FitWish& wish, double delay) {
  const auto fit = delay > 0.0 ? chosen_fit(advanced(data, delay), wish) : chosen_fit(data, wish);
  const std::string points = std::to_string(data.size()) + (data.size() == 1 ? " point" : " points");
  if (!fit)
    throw std::invalid_argument("holds " + points + ": too few for a fit" +
                                (wish.order ? " of order " + std::to_string(*wish.order) + ", which needs " +
                                                  std::to_string(least_points(*wish.order))
                                            : ""));
  if (!(fit->error.rms <= MeasuredResponse::worst_rms))
    throw std::invalid_argument("is fitted by no stable function of " + std::to_string(fit->shape.order) +
                                (fit->shape.order == 1 ? " pole" : " poles") +
                                (wish.order ? "" : ", nor of another that was tried") + ": it would differ by " +
                                percent(fit->error.rms) + " (rms), at most " + percent(fit->error.largest) + " at " +
                                number(fit->error.at, 4) + " rad/s. Check format, frequency and columns; " +
                                (wish.order || wish.poles_at_zero || wish.relative_degree
                                     ? "order, poles_at_zero and relative_degree as asked; "
                                     : "") +
                                "a dead time (delay); whether the plant is stable but for poles at zero");
  return *fit;
}

}  // namespace

MeasuredResponse::MeasuredResponse(std::shared_ptr<const FrequencyData> data, FitWish wish, double delay)
    : data_(std::move(data)),
      wish_(wish),
      delay_(delay),
      fit_(fitted(*data_, wish_, delay_)),
      gaps_(gaps_in(data_->frequency)) {
  double angle = 0.0;
  for (std::size_t i = 0; i < data_->size(); ++i) {
    const double w = data_->frequency[i];
    const Complex fit = response_of(fit_.model, w) * std::polar(1.0, -w * delay_);
    Complex log = std::log(data_->response[i] / fit);
    log += Complex(0.0, 2.0 * std::numbers::pi * std::round((angle - log.imag()) / (2.0 * std::numbers::pi)));
    angle = log.imag();
    log_ratio_.push_back(log);
  }
}

/// Position i of the points i and i + 1 between which w lies; nowhere: beyond the data, or in a gap.
std::size_t MeasuredResponse::interval(double w) const {
  const auto& points = data_->frequency;
  if (points.size() < 2 || !(w >= points.front() && w <= points.back())) return nowhere;
  const auto above = std::ranges::upper_bound(points, w);
  const auto i = static_cast<std::size_t>(std::min(above - points.begin(), std::ssize(points) - 1) - 1);
  if (!std::ranges::binary_search(gaps_, i)) return i;
  if (w == points[i] && i > 0) return i - 1;
  return w == points[i + 1] && i + 2 < points.size() ? i + 1 : nowhere;
}

std::complex<double> MeasuredResponse::ratio(double w) const {
  const std::size_t i = interval(w);
  if (i == nowhere) return 1.0;
  const auto& points = data_->frequency;
  const double share = std::log(w / points[i]) / std::log(points[i + 1] / points[i]);
  return std::exp((1.0 - share) * log_ratio_[i] + share * log_ratio_[i + 1]);
}

double MeasuredResponse::deviation(double w) const {
  const std::size_t i = interval(w);
  if (i == nowhere || data_->deviation.empty()) return 0.0;
  return std::max(data_->deviation[i], data_->deviation[i + 1]);
}

std::vector<std::pair<double, double>> MeasuredResponse::ranges() const {
  const auto& points = data_->frequency;
  std::vector<std::pair<double, double>> list{{points.front(), points.back()}};
  for (const std::size_t gap : gaps_) {
    list.back().second = points[gap];
    list.emplace_back(points[gap + 1], points.back());
  }
  return list;
}

std::string MeasuredResponse::data_in_words() const {
  return std::to_string(data_->size()) + " points from " + number(data_->frequency.front(), 4) + " to " +
         number(data_->frequency.back(), 4) + " rad/s in " + data_->file;
}

std::string MeasuredResponse::fit_in_words() const {
  const auto& [order, at_zero, degree] = fit_.shape;
  std::string text = "a fit of order " + std::to_string(order);
  if (at_zero > 0) text += at_zero == 1 ? " with one pole at zero" : " with two poles at zero";
  text += ", which differs from the data by " + percent(fit_.error.rms) + " (rms), at most " +
          percent(fit_.error.largest) + " (at " + number(fit_.error.at, 4) + " rad/s)";
  if (fit_.error.deviations) text += ", by " + number(*fit_.error.deviations, 2) + " standard deviations (rms)";
  return text;
}

}  // namespace limcycle
