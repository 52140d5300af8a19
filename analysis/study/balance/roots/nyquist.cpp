#include "limcycle/analysis/study/balance/roots/nyquist.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/balance/roots/df_predictions.hpp"
#include "limcycle/analysis/study/balance/roots/within_data.hpp"

namespace limcycle {
namespace {

/// A logarithmic grid together with the marked places, in order.
std::vector<double> grid_with(double from, double to, int steps, const std::vector<double>& marked) {
  std::vector<double> grid = marked;
  for (int i = 0; i <= steps; ++i) grid.push_back(from * std::pow(to / from, double(i) / steps));
  std::ranges::sort(grid);
  // Places that differ only by rounding are one.
  const auto same = [](double a, double b) { return b <= a * (1.0 + 1e-9); };
  grid.erase(std::unique(grid.begin(), grid.end(), same), grid.end());
  return grid;
}

/// Samples of G between two frequencies, halved where G turns or grows by more than a tenth, so that a resonance is not
/// drawn as a polygon.
void refine(const std::function<std::complex<double>(double)>& G, double from, std::complex<double> at_from, double to,
            std::complex<double> at_to, int depth, NyquistPicture& picture) {
  const double size = std::max(std::abs(at_from), std::abs(at_to));
  if (depth == 0 || !(std::abs(at_to - at_from) > 0.1 * size)) return;
  const double middle = std::sqrt(from * to);
  const std::complex<double> at_middle = G(middle);
  if (!std::isfinite(std::abs(at_middle))) return;
  refine(G, from, at_from, middle, at_middle, depth - 1, picture);
  picture.frequency.push_back(middle);
  picture.G.push_back(at_middle);
  refine(G, middle, at_middle, to, at_to, depth - 1, picture);
}

void sample_response(const Loop& loop, const std::vector<double>& grid, NyquistPicture& picture) {
  const auto main = std::ssize(loop.elements) - 1;
  Loop straight = loop;
  straight.A = loop.tangent();  // gravity as a spring
  const auto G = [&](double w) { return -straight.element_response(w)(main, main); };
  bool joined = false;
  for (const double w : grid) {
    const std::complex<double> here = G(w);
    const bool exists = std::isfinite(std::abs(here));
    if (exists && joined) {
      const double before = picture.frequency.back();
      const std::complex<double> at_before = picture.G.back();
      refine(G, before, at_before, w, here, 12, picture);
    }
    if (exists) {
      picture.frequency.push_back(w);
      picture.G.push_back(here);
    }
    joined = exists;
  }
}

}  // namespace

NyquistPicture nyquist_picture(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                               const std::vector<SearchPoint>& roots, const std::function<bool()>& stop) {
  NyquistPicture picture;
  std::vector<double> amplitudes, frequencies;
  for (const auto& root : roots) {
    amplitudes.push_back(root.amplitude);
    frequencies.push_back(root.frequency);
  }
  sample_response(loop, grid_with(box.frequency_min, box.frequency_max, 400, frequencies), picture);
  picture.family_amplitude = grid_with(box.amplitude_min, box.amplitude_max, 90, amplitudes);
  if (balance.depends_on_frequency())
    picture.family_frequency = grid_with(box.frequency_min, box.frequency_max, 24, frequencies);
  else
    picture.family_frequency = {std::sqrt(box.frequency_min * box.frequency_max)};
  constexpr double accuracy = 1e-4;
  for (const double w : picture.family_frequency) {
    auto& curve = picture.minus_inverse_N.emplace_back();
    std::vector<SearchPoint> points;
    for (const double A : picture.family_amplitude) points.push_back({A, w});
    if (stop && stop()) return picture;
    balance.prepare(points, accuracy);
    for (const double A : picture.family_amplitude) {
      if (stop && stop()) return picture;
      curve.push_back(-1.0 / balance.gain(A, w, accuracy));
    }
  }
  return picture;
}

NyquistPicture nyquist_picture(const Loop& loop, const PredictReport& report, const std::function<bool()>& stop) try {
  if (!report.describing_function) return {};
  std::vector<SearchPoint> roots;
  for (const Prediction& one : report.predictions)
    if (one.method == DfPredictions::method) roots.push_back({one.input_amplitude, one.frequency});
  SearchBox drawn = report.search;
  if (const auto boxes = within_data(loop, drawn); !boxes.empty()) {
    drawn.frequency_min = boxes.front().frequency_min;
    drawn.frequency_max = boxes.back().frequency_max;
  }
  return nyquist_picture(loop, FirstHarmonicBalance(loop), drawn, roots, stop);
} catch (const std::invalid_argument&) {  // numbers beyond the range of the method: no curves, but the rest stands
  return {};
}

}  // namespace limcycle
