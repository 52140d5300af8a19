#include "limcycle/analysis/study/balance/force_limit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

constexpr double spacing = 0.005;  ///< of the samples, in ln w
constexpr double least_damping = 0.1;
constexpr double between_samples = 2.0;

bool has_sharp_peak(const Loop& loop, const SearchBox& box) {
  const Eigen::VectorXcd poles = eigenvalues(loop.A);
  return std::any_of(poles.begin(), poles.end(), [&](std::complex<double> pole) {
    const double w = std::abs(pole.imag());
    return w > 0.5 * box.frequency_min && w < 2.0 * box.frequency_max && std::abs(pole.real()) < least_damping * w;
  });
}

}  // namespace

std::optional<ForceLimit> ForceLimit::of(const Loop& loop, const SearchBox& box) {
  const bool plain =
      loop.elements.size() == 1 && loop.ports[0].rubs && loop.delay == 0.0 && !loop.sampled && loop.measured.empty();
  if (!plain || !loop.elements[0].force_bound(1.0) || has_sharp_peak(loop, box)) return std::nullopt;
  return ForceLimit(loop, box);
}

ForceLimit::ForceLimit(const Loop& loop, const SearchBox& box)
    : element_(loop.elements[0]), first_(std::log(box.frequency_min) - spacing) {
  const double last = std::log(box.frequency_max) + spacing;
  const auto count = static_cast<std::size_t>(std::ceil((last - first_) / spacing)) + 1;
  step_ = (last - first_) / static_cast<double>(count - 1);
  responses_.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    responses_.push_back(std::abs(loop.element_response(std::exp(first_ + static_cast<double>(i) * step_))(0, 0)));
}

std::size_t ForceLimit::sample_below(double frequency) const {
  const double at = std::floor((std::log(frequency) - first_) / step_);
  return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(responses_.size() - 2)));
}

bool ForceLimit::forbids(const SearchBox& part) const {
  const auto force = element_.force_bound(part.amplitude_max * part.frequency_max);
  if (!force) return false;
  const auto from = responses_.begin() + static_cast<std::ptrdiff_t>(sample_below(part.frequency_min));
  const auto to = responses_.begin() + static_cast<std::ptrdiff_t>(sample_below(part.frequency_max)) + 2;
  const double response = between_samples * *std::max_element(from, to);
  return 4.0 / std::numbers::pi * *force / part.amplitude_min * response < 1.0;
}

}  // namespace limcycle
