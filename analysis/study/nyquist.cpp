#include <cmath>

#include "limcycle/analysis/study/loop_balance.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

NyquistPicture nyquist_picture(const Loop& loop, const SearchBox& box, const std::function<bool()>& stop) {
  NyquistPicture picture;
  const auto main = std::ssize(loop.elements) - 1;
  const auto logarithmic = [](double from, double to, int i, int n) {
    return from * std::pow(to / from, double(i) / n);
  };
  Loop straight = loop;
  straight.A = loop.tangent();  // gravity as a spring
  for (int i = 0; i <= 400; ++i) {
    const double w = logarithmic(box.frequency_min, box.frequency_max, i, 400);
    const std::complex<double> G = -straight.element_response(w)(main, main);
    if (!std::isfinite(std::abs(G))) continue;
    picture.frequency.push_back(w);
    picture.G.push_back(G);
  }
  const LoopBalance balance(loop);
  const int members = balance.depends_on_frequency() ? 6 : 0;
  for (int i = 0; i <= 60; ++i)
    picture.family_amplitude.push_back(logarithmic(box.amplitude_min, box.amplitude_max, i, 60));
  for (int k = 0; k <= members; ++k) {
    const double w = members ? logarithmic(box.frequency_min, box.frequency_max, k, members)
                             : std::sqrt(box.frequency_min * box.frequency_max);
    auto& curve = picture.minus_inverse_N.emplace_back();
    picture.family_frequency.push_back(w);
    for (const double A : picture.family_amplitude) {
      if (stop && stop()) return picture;
      curve.push_back(-1.0 / balance.gain(A, w, 1e-4));
    }
  }
  return picture;
}

}  // namespace limcycle
