#include "limcycle/reports/figures/fit_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

constexpr std::string_view fit_style =
    "text{font:12px system-ui,sans-serif;fill:#59636e}.title{font-size:14px;font-weight:600}.end{text-anchor:end}"
    ".frame{fill:none;stroke:#8b949e;stroke-opacity:.5}.grid{stroke:#8b949e;stroke-opacity:.25}"
    ".fit{fill:none;stroke:#2f81c7;stroke-width:2}.data{fill:#d9661f}"
    ".deviation{fill:none;stroke:#59636e;stroke-dasharray:4 3}";

constexpr double fit_left = 70.0, fit_width = 660.0;

/// A panel over the logarithm of the frequency.
class FitPanel {
 public:
  FitPanel(double top, double height, double from, double to) : top_(top), height_(height), from_(from), to_(to) {}

  void scale(double low, double high) {
    low_ = low;
    high_ = high;
  }
  double x(double w) const { return place(std::log(w), fit_left, fit_width, std::log(from_), std::log(to_)); }
  double y(double value) const { return place(-value, top_, height_, -high_, -low_); }

  /// The frame, with lines at decades of the frequency and at `steps` of the scale.
  std::string frame(const std::string& name, const std::vector<std::pair<double, std::string>>& steps) const {
    std::string out =
        fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", fit_left,
                    top_, fit_width, height_);
    const int last = static_cast<int>(std::floor(std::log10(to_)));
    for (int decade = static_cast<int>(std::ceil(std::log10(from_))); decade <= last; ++decade) {
      const double at = x(std::pow(10.0, decade));
      out += line_of(at, top_, at, top_ + height_, "grid");
    }
    for (const auto& [value, words] : steps) {
      out += line_of(fit_left, y(value), fit_left + fit_width, y(value), "grid");
      out += words_at(fit_left - 6.0, y(value) + 4.0, "end", words);
    }
    return out + words_at(fit_left, top_ - 5.0, "", name);
  }

  template <class Values>
  std::string curve(const std::vector<double>& w, const Values& values, std::string_view kind) const {
    std::string d;
    for (std::size_t i = 0; i < w.size(); ++i)
      d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : " L", x(w[i]), y(values[i]));
    return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", kind, d);
  }

  template <class Values>
  std::string dots(const std::vector<double>& w, const Values& values) const {
    constexpr std::size_t most = 1000;
    std::string out;
    for (std::size_t i = 0; i < w.size(); i += w.size() / most + 1)
      out += fmt::format("<circle class=\"data\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>\n", x(w[i]), y(values[i]));
    return out;
  }

 private:
  double top_, height_, from_, to_, low_ = 0.0, high_ = 1.0;
};

/// The multiples of `by` between two values, with their words.
std::vector<std::pair<double, std::string>> multiples(double low, double high, int by, const auto& words) {
  std::vector<std::pair<double, std::string>> steps;
  for (int k = static_cast<int>(std::ceil(low / by)); k * by <= high; ++k) steps.emplace_back(k * by, words(k * by));
  return steps;
}

/// Steps of a scale in powers of ten, ten at most, as exponents.
std::vector<std::pair<double, std::string>> decades(double low, double high) {
  const int by = std::max(1, static_cast<int>(std::ceil((high - low) / 8.0)));
  return multiples(low, high, by, [](int at) { return fmt::format("1e{}", at); });
}

std::vector<std::pair<double, std::string>> degrees(double low, double high) {
  const int by = 90 * std::max(1, static_cast<int>(std::ceil((high - low) / 540.0)));
  return multiples(low, high, by, [](int at) { return fmt::format("{}\xC2\xB0", at); });
}

struct Curves {
  std::vector<double> w, size, phase;
};

/// Decimal logarithm of the size, and the phase in degrees without jumps, of responses in order of frequency.
Curves curves_of(const std::vector<double>& w, const std::vector<std::complex<double>>& response, double first_near) {
  Curves out{w, {}, {}};
  double last = first_near;
  for (const auto& G : response) {
    const double phase = std::arg(G) * 180.0 / std::numbers::pi;
    last = phase + 360.0 * std::round((last - phase) / 360.0);
    out.size.push_back(std::log10(std::abs(G)));
    out.phase.push_back(last);
  }
  return out;
}

}  // namespace

std::string fit_picture(const MeasuredPlantAt& plant) {
  const MeasuredResponse& measured = *plant.response;
  const FrequencyData& data = measured.data();
  const double from = data.frequency.front(), to = data.frequency.back();
  std::vector<double> fine, distance, deviation;
  std::vector<std::complex<double>> fitted;
  for (int i = 0; i <= 600; ++i) fine.push_back(from * std::pow(to / from, i / 600.0));
  const auto fit_at = [&](double w) {
    return response_of(measured.fit().model, w) * std::polar(1.0, -w * measured.delay());
  };
  fitted.reserve(fine.size());
  for (const double w : fine) fitted.push_back(fit_at(w));
  for (std::size_t i = 0; i < data.size(); ++i)
    distance.push_back(std::log10(std::max(1e-16, std::abs(fit_at(data.frequency[i]) / data.response[i] - 1.0))));
  for (const double one : data.deviation) deviation.push_back(std::log10(std::max(1e-16, one)));

  const Curves points = curves_of(data.frequency, data.response, -180.0);
  const Curves fit = curves_of(fine, fitted, points.phase.front());
  const auto limits = [](const std::vector<double>& values, double margin) {
    const auto [low, high] = std::ranges::minmax(values);
    return std::pair(low - margin, high + margin);
  };
  FitPanel size(50, 190, from, to), phase(270, 130, from, to), error(430, 130, from, to);
  const auto [size_low, size_high] = limits(points.size, 0.2);
  const auto [phase_low, phase_high] = limits(points.phase, 15.0);
  auto all = distance;
  all.insert(all.end(), deviation.begin(), deviation.end());
  const auto [error_low, error_high] = limits(all, 0.3);
  size.scale(size_low, size_high);
  phase.scale(phase_low, phase_high);
  error.scale(error_low, error_high);
  std::string body = size.frame("size of y/u", decades(size_low, size_high)) + size.curve(fit.w, fit.size, "fit") +
                     size.dots(points.w, points.size);
  body += phase.frame("phase", degrees(phase_low, phase_high)) + phase.curve(fit.w, fit.phase, "fit") +
          phase.dots(points.w, points.phase);
  body += error.frame("distance of the fit from the data, relative" +
                          std::string(deviation.empty() ? "" : " (dashed: standard deviation of the data)"),
                      decades(error_low, error_high)) +
          error.dots(data.frequency, distance);
  if (!deviation.empty()) body += error.curve(data.frequency, deviation, "deviation");
  body += words_at(fit_left, 578, "", with_digits(from, 4) + " rad/s") +
          words_at(fit_left + fit_width, 578, "end", with_digits(to, 4) + " rad/s (log)") +
          words_at(fit_left, 598, "", "dots: data; line: fit");
  return svg_picture(760, 606, plant.path + ": " + measured.data_in_words() + "; " + measured.fit_in_words(), fit_style,
                     fmt::format("{}: data, and the fit of order {}", plant.path, measured.fit().shape.order), body);
}

}  // namespace limcycle
