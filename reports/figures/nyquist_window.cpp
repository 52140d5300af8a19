#include "limcycle/reports/figures/nyquist_window.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

using Complex = std::complex<double>;

bool finite(Complex z) { return std::isfinite(z.real()) && std::isfinite(z.imag()); }

template <class Visit>
void each_of_family(const NyquistPicture& picture, Visit&& visit) {
  for (const auto& member : picture.minus_inverse_N)
    for (const auto& point : member)
      if (finite(point)) visit(point);
}

/// |G| at the point of the curve with the least distance to the family, relative to |G|.
double size_at_closest(const NyquistPicture& picture) {
  double least = INFINITY, size = 0.0;
  for (const auto& G : picture.G) {
    if (!finite(G) || std::abs(G) == 0.0) continue;
    each_of_family(picture, [&](Complex point) {
      const double distance = std::abs(G - point) / std::abs(G);
      if (distance < least) least = distance, size = std::abs(G);
    });
  }
  return size;
}

double radius(const NyquistPicture& picture, const std::vector<Complex>& roots) {
  double greatest = 0.0;
  std::size_t where = 0;
  for (std::size_t i = 0; i < picture.G.size(); ++i)
    if (finite(picture.G[i]) && std::abs(picture.G[i]) > greatest) greatest = std::abs(picture.G[i]), where = i;
  double wanted = 0.0;
  for (const auto& root : roots) wanted = std::max(wanted, 2.5 * std::abs(root));
  if (wanted == 0.0 && where > 0) wanted = 1.1 * greatest;
  if (wanted == 0.0) wanted = 4.0 * size_at_closest(picture);
  // In a much larger window the curve would be a dot.
  if (greatest > 0.0 && (wanted == 0.0 || wanted > 1.1 * greatest)) wanted = 1.1 * greatest;
  return wanted > 0.0 && std::isfinite(wanted) ? wanted : 1.0;
}

}  // namespace

std::optional<Complex> response_at(const NyquistPicture& picture, double frequency) {
  const auto& w = picture.frequency;
  for (std::size_t i = 0; i + 1 < std::min(w.size(), picture.G.size()); ++i) {
    if (!(w[i] <= frequency && frequency <= w[i + 1] && w[i] < w[i + 1])) continue;
    const double share = std::log(frequency / w[i]) / std::log(w[i + 1] / w[i]);
    const Complex G = picture.G[i] + share * (picture.G[i + 1] - picture.G[i]);
    if (finite(G)) return G;
  }
  return std::nullopt;
}

NyquistWindow nyquist_window(const NyquistPicture& picture, const std::vector<Complex>& roots) {
  const double R = radius(picture, roots);
  NyquistWindow box{0.0, 0.0, 0.0, 0.0};
  const auto include = [&](Complex z) {
    // A point outside extends the border to where its curve leaves the circle.
    if (std::abs(z) > R) z *= R / std::abs(z);
    box.re_from = std::min(box.re_from, z.real());
    box.re_to = std::max(box.re_to, z.real());
    box.im_from = std::min(box.im_from, z.imag());
    box.im_to = std::max(box.im_to, z.imag());
  };
  for (const auto& G : picture.G)
    if (finite(G)) include(G);
  each_of_family(picture, include);
  for (const auto& root : roots) include(root);
  const double margin = 0.08 * std::max({box.re_to - box.re_from, box.im_to - box.im_from, 1e-3 * R});
  return {box.re_from - margin, box.re_to + margin, box.im_from - margin, box.im_to + margin};
}

}  // namespace limcycle
