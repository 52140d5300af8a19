#include "limcycle/analysis/study/balance/roots/rootless_parts.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

constexpr double spacing = 0.005;  ///< of the samples, in ln w
constexpr double least_damping = 0.1;
constexpr double factor_between_samples = 2.0, share_between_samples = 0.01;

bool has_sharp_peak(const Loop& loop, const SearchBox& box) {
  const Eigen::VectorXcd poles = eigenvalues(loop.A);
  return std::any_of(poles.begin(), poles.end(), [&](std::complex<double> pole) {
    const double w = std::abs(pole.imag());
    return w > 0.5 * box.frequency_min && w < 2.0 * box.frequency_max && std::abs(pole.real()) < least_damping * w;
  });
}

}  // namespace

std::optional<RootlessParts> RootlessParts::of(const Loop& loop, const SearchBox& box) {
  const bool plain =
      loop.elements.size() == 1 && loop.ports[0].rubs && loop.delay == 0.0 && !loop.sampled && loop.measured.empty();
  if (!plain || has_sharp_peak(loop, box)) return std::nullopt;
  if (!loop.elements[0].force_bound(1.0) && !loop.elements[0].is_passive()) return std::nullopt;
  return RootlessParts(loop, box);
}

RootlessParts::RootlessParts(const Loop& loop, const SearchBox& box)
    : element_(loop.elements[0]), first_(std::log(box.frequency_min) - spacing) {
  const double last = std::log(box.frequency_max) + spacing;
  const auto count = static_cast<std::size_t>(std::ceil((last - first_) / spacing)) + 1;
  step_ = (last - first_) / static_cast<double>(count - 1);
  supplied_.assign(count, 1);
  std::vector<double> imaginary(count);
  sizes_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::complex<double> H = loop.element_response(std::exp(first_ + static_cast<double>(i) * step_))(0, 0);
    sizes_.push_back(std::abs(H));
    imaginary[i] = H.imag();
  }
  if (!element_.is_passive()) return;
  for (std::size_t i = 1; i + 1 < count; ++i)  // Im(1/H) = -Im H/|H|^2
    supplied_[i] = imaginary[i] > share_between_samples * std::max({sizes_[i - 1], sizes_[i], sizes_[i + 1]}) ? 0 : 1;
}

std::size_t RootlessParts::sample_below(double frequency) const {
  const double at = std::floor((std::log(frequency) - first_) / step_);
  return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(sizes_.size() - 2)));
}

bool RootlessParts::too_weak(const SearchBox& part, double response) const {
  const auto force = element_.force_bound(part.amplitude_max * part.frequency_max);
  return force && 4.0 / std::numbers::pi * *force / part.amplitude_min * factor_between_samples * response < 1.0;
}

bool RootlessParts::forbids(const SearchBox& part) const {
  const std::size_t from = sample_below(part.frequency_min), to = sample_below(part.frequency_max) + 2;
  const auto supplied = std::span(supplied_).subspan(from, to - from);
  return std::ranges::find(supplied, 1) == supplied.end() ||
         too_weak(part, std::ranges::max(std::span(sizes_).subspan(from, to - from)));
}

}  // namespace limcycle
