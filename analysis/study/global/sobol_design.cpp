#include "limcycle/analysis/study/global/sobol_design.hpp"

#include <gsl/gsl_qrng.h>

#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace limcycle {
namespace {

constexpr std::size_t sobol_dimensions = 40;  ///< of GSL's sequence; its numbers are multiples of 2^-30
constexpr std::size_t most_samples = std::size_t{1} << 30U;

using Sequence = std::unique_ptr<gsl_qrng, decltype(&gsl_qrng_free)>;

Sequence sequence(const gsl_qrng_type* type, std::size_t dimensions) {
  Sequence made(gsl_qrng_alloc(type, static_cast<unsigned>(dimensions)), &gsl_qrng_free);
  if (!made) throw std::bad_alloc();
  return made;
}

}  // namespace

SobolDesign::SobolDesign(std::size_t parameters, std::size_t samples, bool second_order, std::uint64_t seed)
    : parameters_(parameters), samples_(samples), second_order_(second_order) {
  if (parameters == 0 || parameters > most_parameters)
    throw std::invalid_argument("a Sobol design needs 1 to " + std::to_string(most_parameters) + " parameters, got " +
                                std::to_string(parameters));
  if (samples == 0 || samples > most_samples)
    throw std::invalid_argument("a Sobol design needs 1 to 2^30 samples, got " + std::to_string(samples));
  base_.reserve(2 * parameters * samples);
  const RandomStream random(seed, "Sobol design");
  if (2 * parameters <= sobol_dimensions)
    take_sobol(random);
  else
    take_halton(random);
}

void SobolDesign::take_sobol(RandomStream random) {
  const auto points = sequence(gsl_qrng_sobol, 2 * parameters_);
  std::vector<double> point(2 * parameters_, 0.0);  // the sequence's point 0, which GSL leaves out
  std::vector<std::uint64_t> shift;
  for (std::size_t i = 0; i < point.size(); ++i) shift.push_back(random.bits() >> 12U);
  for (std::size_t k = 0; k < samples_; ++k) {
    if (k > 0) gsl_qrng_get(points.get(), point.data());
    for (std::size_t i = 0; i < point.size(); ++i) {
      const auto digits = static_cast<std::uint64_t>(point[i] * 0x1p52);  // whole: the last 22 are 0
      base_.push_back((static_cast<double>(digits ^ shift[i]) + 0.5) * 0x1p-52);
    }
  }
}

void SobolDesign::take_halton(RandomStream random) {
  const auto points = sequence(gsl_qrng_reversehalton, 2 * parameters_);
  std::vector<double> point(2 * parameters_), shift;
  for (std::size_t i = 0; i < point.size(); ++i) shift.push_back(random.uniform());
  for (std::size_t k = 0; k < samples_; ++k) {
    gsl_qrng_get(points.get(), point.data());
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double moved = point[i] + shift[i], within = moved - std::floor(moved);
      base_.push_back(within > 0.0 ? within : 0x1p-53);  // the sum of two doubles may be whole
    }
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
