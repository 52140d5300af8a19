#pragma once
#include <complex>
#include <span>
#include <vector>

namespace limcycle {

/// Harmonics 0..orders of `samples` taken at the phases origin + 2 pi j/N: element k is sine + j cosine coefficient of
/// sin and cos of k theta, theta the phase itself; element 0 holds the mean in its imaginary part (the cosine of order
/// 0). FFTW, ESTIMATE plans (the same answer every time), planner locked; safe to call from several threads.
/// Throws std::invalid_argument if there are not more than 2 orders samples. Cost O(N log N).
std::vector<std::complex<double>> harmonics_by_fft(std::span<const double> samples, double origin, int orders);

}  // namespace limcycle
