#include "limcycle/reports/figures/drawing/svg_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {

void Scale::include(double value) {
  if (!std::isfinite(value) || (logarithmic_ && !(value > 0.0))) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

void Scale::include(const std::vector<double>& values) {
  for (const double value : values) include(value);
}

void Scale::settle(bool room) {
  if (!(low_ <= high_)) low_ = high_ = logarithmic_ ? 1.0 : 0.0;
  if (logarithmic_) {
    if (high_ < 2.0 * low_) {
      low_ /= 2.0;
      high_ *= 2.0;
    }
    return;
  }
  // A nearly constant quantity is drawn as such, not as a picture of its rounding.
  const double middle = 0.5 * (low_ + high_), least = middle != 0.0 ? 0.02 * std::abs(middle) : 1e-12;
  const double half = std::max(0.5 * (high_ - low_), 0.5 * least) * (room ? 1.06 : 1.0);
  low_ = middle - half;
  high_ = middle + half;
  const double size = std::max(std::abs(low_), std::abs(high_));
  const int decade = static_cast<int>(std::floor(std::log10(size)));
  if (decade < -2 || decade > 3) exponent_ = 3 * static_cast<int>(std::floor(decade / 3.0));
}

double Scale::share(double value) const {
  return logarithmic_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
}

std::vector<std::pair<double, std::string>> Scale::ticks() const {
  std::vector<std::pair<double, std::string>> list;
  if (logarithmic_) {
    for (int k = static_cast<int>(std::ceil(std::log10(low_) - 1e-9)); std::pow(10.0, k) <= high_ * 1.0000001; ++k)
      list.emplace_back(std::pow(10.0, k), fmt::format("{:g}", std::pow(10.0, k)));
    const std::size_t stride = (list.size() + 3) / 4;
    std::vector<std::pair<double, std::string>> few;
    for (std::size_t i = 0; i < list.size(); i += std::max<std::size_t>(stride, 1)) few.push_back(list[i]);
    return few;
  }
  const double raw = (high_ - low_) / 3.5, ten = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = raw < 1.5 * ten ? ten : raw < 3.5 * ten ? 2.0 * ten : raw < 7.5 * ten ? 5.0 * ten : 10.0 * ten;
  const double unit = std::pow(10.0, exponent_);
  for (double k = std::ceil(low_ / step); k * step <= high_; ++k)
    list.emplace_back(k * step, fmt::format("{:.6g}", k == 0.0 ? 0.0 : k * step / unit));
  return list;
}

std::string Scale::label(const std::string& name, const std::string& unit) const {
  const std::string power = exponent_ == 0 ? "" : fmt::format("1e{}", exponent_);
  const std::string both = power + (power.empty() || unit.empty() ? "" : " ") + unit;
  return both.empty() ? name : name + " (" + both + ")";
}

std::string AxesFrame::markup() const {
  std::string out;
  for (const auto& [value, text] : x.ticks())
    out += fmt::format(
        "<line class=\"tick\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/><text x=\"{0:.1f}\" "
        "y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>\n",
        px(value), top, top + height, top + height + 12.0, text);
  for (const auto& [value, text] : y.ticks())
    out += fmt::format(
        "<line class=\"tick\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\"/><text x=\"{3:.1f}\" "
        "y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        left, py(value), left + width, left - 4.0, py(value) + 4.0, text);
  return out + fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>\n", left, top,
                           width, height);
}

std::string AxesFrame::names(const std::string& of_x, const std::string& of_y) const {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
      left, top - 6.0, html_escaped(of_y), left + width, top + height + 26.0, html_escaped(of_x));
}

}  // namespace limcycle
