#pragma once
#include <complex>
#include <functional>
#include <string_view>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Method that computes the harmonics of the periodic steady state.
enum class DfMethod {
  automatic,   ///< closed form of the gain if there is one, else a kernel for the law, else quadrature
  fft,         ///< FFT of uniform samples of the periodic steady state, doubled until two resolutions agree
  quadrature,  ///< nodes graded towards reversals and split at switches
};

/// Options of a describing function.
struct DfOptions {
  int harmonics = 7;       ///< orders 1..harmonics are returned
  double accuracy = 1e-6;  ///< wanted relative error of the gain, 1e-13..1e-1
  DfMethod method = DfMethod::automatic;
  Isa isa = Isa::scalar;  ///< of the kernels; other methods use portable code only. Must be available
  int threads = 1;        ///< of a table; 0: one per core. The numbers do not depend on it
};

/// Point of a describing function: the input is bias t + amplitude sin(frequency t) for a friction law (bias: mean
/// velocity), bias + amplitude sin(frequency t) for another element.
struct DfPoint {
  double amplitude = 0.0;  ///< > 0, units of the input
  double frequency = 0.0;  ///< > 0, rad/s
  double bias = 0.0;
};

/// Gain and harmonics of the periodic output at one point.
struct DescribingFunction {
  std::complex<double> gain;                    ///< N = (b1 + j a1)/A
  double mean = 0.0;                            ///< mean output
  std::vector<std::complex<double>> harmonics;  ///< [k-1]: sine + j cosine coefficient of order k, units of the output
  double dissipation = 0.0;                     ///< work per period against the element, integral of output times rate
  /// Estimated relative error of the gain: difference of two meshes (or resolutions) with a margin, defect of
  /// periodicity and roundings; of a kernel also a bound that holds for every motion and was verified by tests. 0 with
  /// a gain of exactly 0: no first harmonic above rounding (relay within its hysteresis, sliding on a constant level).
  double error = 0.0;
  bool symmetric = false;             ///< the output is half-wave symmetric
  std::string_view method;            ///< "closed-form", "kernel", "fft" or "quadrature"
  Status status = Status::converged;  ///< incomplete: the wanted accuracy was not reached, see error
  long evaluations = 0;               ///< of the element's equations

  /// True if the numbers above are valid; any other status comes with zeros.
  bool answered() const { return status == Status::converged || status == Status::incomplete; }
};

/// Throws std::invalid_argument quoting the option or coordinate that is out of range.
void validate(const DfOptions& options);
void validate(const DfPoint& point);

/// Describing function of one element at one point, from the fixed point of its period map (never from a decayed
/// transient). A result that is not finite is not returned: its Status is not_finite and the numbers are 0.
DescribingFunction describing_function(const Element& element, const DfPoint& point, const DfOptions& options = {});

/// All points of a list, such as the product amplitudes x frequencies x biases. `stop` is called for every point, by
/// any of the threads, one at a time: once it returns true no further point is begun, and the longest gapless run of
/// computed points from the first on is returned. `progress` is called from time to time and at the end with the number
/// of points done. The result at a point does not depend on the other points.
std::vector<DescribingFunction> describing_function_table(const Element& element, std::vector<DfPoint> points,
                                                          const DfOptions& options,
                                                          const std::function<bool()>& stop = {},
                                                          const std::function<void(std::size_t)>& progress = {});

}  // namespace limcycle
