#include "limcycle/analysis/frequency/describing_function/harmonics_by_fft.hpp"

#include <fftw3.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

namespace limcycle {

namespace {

std::mutex planner;

struct Free {
  void operator()(void* memory) const { fftw_free(memory); }
};
struct DestroyPlan {
  void operator()(fftw_plan plan) const {
    const std::lock_guard lock(planner);
    fftw_destroy_plan(plan);
  }
};

}  // namespace

std::vector<std::complex<double>> harmonics_by_fft(std::span<const double> samples, double origin, int orders) {
  const auto count = samples.size();
  if (orders < 0 || count <= 2 * static_cast<std::size_t>(orders))
    throw std::invalid_argument("harmonics_by_fft: " + std::to_string(count) + " samples cannot give " +
                                std::to_string(orders) + " harmonics");
  const std::unique_ptr<double, Free> in(fftw_alloc_real(count));
  const std::unique_ptr<fftw_complex, Free> out(fftw_alloc_complex(count / 2 + 1));
  std::unique_ptr<std::remove_pointer_t<fftw_plan>, DestroyPlan> plan;
  {
    const std::lock_guard lock(planner);
    plan.reset(fftw_plan_dft_r2c_1d(static_cast<int>(count), in.get(), out.get(), FFTW_ESTIMATE));
  }
  std::copy(samples.begin(), samples.end(), in.get());
  fftw_execute(plan.get());

  std::vector<std::complex<double>> harmonics;
  for (int k = 0; k <= orders; ++k) {
    // F = sum c_k exp(jk theta) with c_k = X_k exp(-jk origin)/N; b_k + j a_k = 2 j c_k.
    const auto& bin = out.get()[k];
    const std::complex<double> c =
        std::complex<double>(bin[0], bin[1]) * std::polar(1.0 / static_cast<double>(count), -k * origin);
    harmonics.push_back((k == 0 ? 1.0 : 2.0) * std::complex<double>(0.0, 1.0) * c);
  }
  return harmonics;
}

}  // namespace limcycle
