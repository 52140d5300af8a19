#pragma once
#include <string>
#include <utility>
#include <vector>

#include "limcycle/models/parameter.hpp"

namespace limcycle {

/// One axis with its ticks; small and large numbers are shown in units of a power of ten.
class Scale {
 public:
  explicit Scale(bool logarithmic = false) : logarithmic_(logarithmic) {}

  void include(double value);
  void include(const std::vector<double>& values);
  /// After all values: with some room at both ends, or from the first to the last.
  void settle(bool room = true);
  double share(double value) const;
  std::vector<std::pair<double, std::string>> ticks() const;
  /// "x (1e-6 m)"
  std::string label(const std::string& name, const std::string& unit) const;

 private:
  bool logarithmic_;
  double low_ = infinite, high_ = -infinite;
  int exponent_ = 0;
};

/// A rectangle with two axes, as SVG. The style of the picture defines the classes `frame` and `tick`; labels are
/// placed 40 to its left and 12 below it.
struct AxesFrame {
  double left, top, width, height;
  Scale x{}, y{};

  double px(double value) const { return left + width * x.share(value); }
  double py(double value) const { return top + height * (1.0 - y.share(value)); }
  /// The border, the ticks and their labels.
  std::string markup() const;
  /// Names of the axes: that of y above the frame on the left, that of x below it on the right.
  std::string names(const std::string& of_x, const std::string& of_y) const;
};

/// Styles of the classes of AxesFrame and of `title`.
inline constexpr std::string_view axes_style =
    "text{font:11px system-ui,sans-serif;fill:#59636e}.frame{fill:none;stroke:#8b949e;stroke-opacity:.5}"
    ".tick{stroke:#8b949e;stroke-opacity:.25}.title{font-size:14px;font-weight:600}";

}  // namespace limcycle
