#pragma once
#include <Eigen/Core>
#include <complex>

namespace limcycle {

struct Loop;

/// Responses of a loop with a sampled controller to the outputs of its elements (those of the averaged loop), as in
/// Loop::element_response and Loop::output_response.
struct SampledResponse {
  Eigen::MatrixXcd elements;
  Eigen::RowVectorXcd output;
};

/// The response at s that such a loop has to a signal exp(st), without what sampling adds at other frequencies
/// (aliases, s + 2 pi j k/T): each part of the controller with its pulse transfer function K(exp(sT)), behind the hold
/// (1 - exp(-sT))/(sT) where the continuous part reads it, and its computation delay. Exact for the first harmonic
/// of a motion whose other harmonics do not pass the plant; w < pi/T. Quanta are left out. A limit within the
/// controller is an element of the averaged loop: its output is held. `loop.sampled` must be present. Cost O(n^3).
/// Astrom, Wittenmark (1997), Computer-Controlled Systems, 3rd ed., ch. 7.
SampledResponse sampled_response(const Loop& loop, std::complex<double> s);

}  // namespace limcycle
