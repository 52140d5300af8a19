#pragma once
#include <complex>
#include <vector>

#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// The part of the complex plane that a Nyquist picture shows.
struct NyquistWindow {
  double re_from = -1.0, re_to = 1.0, im_from = -1.0, im_to = 1.0;
};

/// G at a frequency between the samples of the picture (linear in ln w); nothing outside their range.
std::optional<std::complex<double>> response_at(const NyquistPicture& picture, double frequency);

/// A window around the origin that shows the essential part: the roots if there are any; else the whole of G if it is
/// bounded within the search box; else (integrators, where |G| grows without bound at the low edge) the place where G
/// and the -1/N family come closest. Not empty, always finite, contains the origin.
NyquistWindow nyquist_window(const NyquistPicture& picture, const std::vector<std::complex<double>>& roots);

}  // namespace limcycle
