#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/study/precision/work_precision.hpp"

namespace limcycle {

/// Settings of the accuracy study of a describing function.
struct DfPrecisionOptions {
  std::vector<double> accuracies{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  int largest_fft = 1 << 16;  ///< samples per period
  WorkOptions work;
};

/// Accuracy of the describing function of one element over some points: worst relative error of the gain and total
/// cost. The reference is the quadrature at the tightest accuracy (the closed form if there is one); the FFT of uniform
/// samples, which shares neither mesh nor quadrature with it, is the second method.
struct DfPrecision {
  std::vector<DfPoint> points;
  std::vector<WorkPoint> results;  ///< "fft", "quadrature", "automatic"
  std::string made_by, verified_by;
  double agreement = 0.0;  ///< largest relative difference of the reference and the second method over the points
  double error = 0.0;      ///< largest own estimate of the reference
  std::vector<std::string> notes;
  bool verified() const { return agreement < 1e-3; }
};

/// A few points that span pre-sliding to gross slip, by the element's own scales: 0.1 to 1000 times its displacement
/// scale, each slow and fast relative to its velocity scale. Without a displacement scale `amplitude` is used instead.
std::vector<DfPoint> representative_points(const Element& element, double amplitude = 1.0);

/// At most five amplitudes by three frequencies out of lists, evenly spread over each, without bias.
std::vector<DfPoint> representative_points(const std::vector<double>& amplitudes,
                                           const std::vector<double>& frequencies);

/// Points at which the element has no describing function are omitted, with a note. Empty results: no point remains.
DfPrecision df_precision(const Element& element, const std::vector<DfPoint>& points,
                         const DfPrecisionOptions& options = {});

}  // namespace limcycle
