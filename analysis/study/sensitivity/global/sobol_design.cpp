#include "limcycle/analysis/study/sensitivity/global/sobol_design.hpp"

#include <gsl/gsl_qrng.h>

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace limcycle {
namespace {

constexpr std::size_t sobol_parameters = 20;  ///< GSL's sequence has 40 dimensions; its numbers are multiples of 2^-30
constexpr std::size_t most_samples = std::size_t{1} << 30U;

/// Points of a Sobol sequence, all shifted by the same random binary digits.
class ShiftedSobol {
 public:
  ShiftedSobol(std::size_t dimensions, RandomStream random)
      : sequence_(gsl_qrng_alloc(gsl_qrng_sobol, static_cast<unsigned>(dimensions)), &gsl_qrng_free),
        point_(dimensions, 0.0) {  // the sequence's point 0, which GSL omits
    if (!sequence_) throw std::bad_alloc();
    for (std::size_t i = 0; i < dimensions; ++i) shift_.push_back(random.bits() >> 12U);
  }

  /// In (0, 1): the middle of a cell of 2^-52.
  double coordinate(std::size_t i) const {
    const auto digits = static_cast<std::uint64_t>(point_[i] * 0x1p52);  // whole: the last 22 are 0
    return (static_cast<double>(digits ^ shift_[i]) + 0.5) * 0x1p-52;
  }
  void move_on() { gsl_qrng_get(sequence_.get(), point_.data()); }

 private:
  std::unique_ptr<gsl_qrng, decltype(&gsl_qrng_free)> sequence_;
  std::vector<double> point_;
  std::vector<std::uint64_t> shift_;
};

}  // namespace

SobolDesign::SobolDesign(std::size_t parameters, std::size_t samples, bool second_order, std::uint64_t seed)
    : parameters_(parameters), samples_(samples), second_order_(second_order) {
  if (parameters == 0) throw std::invalid_argument("a Sobol design needs a parameter at least");
  if (samples == 0 || samples > most_samples)
    throw std::invalid_argument("a Sobol design needs 1 to 2^30 samples, got " + std::to_string(samples));
  base_.reserve(2 * parameters * samples);
  const std::size_t in_sequence = std::min(parameters, sobol_parameters);
  ShiftedSobol sobol(2 * in_sequence, RandomStream(seed, "Sobol design"));
  for (std::size_t k = 0; k < samples; ++k, sobol.move_on()) {
    RandomStream random(seed, "Sobol design, parameters beyond", k);
    for (const std::size_t half : {std::size_t{0}, in_sequence})
      for (std::size_t i = 0; i < parameters; ++i)
        base_.push_back(i < in_sequence ? sobol.coordinate(half + i) : random.uniform());
  }
}

std::vector<double> SobolDesign::row(std::size_t k) const {
  if (k >= rows()) throw std::out_of_range("row " + std::to_string(k) + " of a design of " + std::to_string(rows()));
  const std::size_t sample = k / rows_per_sample(), which = k % rows_per_sample();
  const auto a = base_.begin() + static_cast<std::ptrdiff_t>(2 * parameters_ * sample);
  const auto b = a + static_cast<std::ptrdiff_t>(parameters_), end = b + static_cast<std::ptrdiff_t>(parameters_);
  std::vector<double> from_a(a, b), from_b(b, end);
  if (which >= 2) {
    const std::size_t i = (which - 2) % parameters_;
    std::swap(from_a[i], from_b[i]);
  }
  const bool is_b = which == 1 || which >= 2 + parameters_;
  return is_b ? from_b : from_a;
}

}  // namespace limcycle
