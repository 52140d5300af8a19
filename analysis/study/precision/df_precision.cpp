#include "limcycle/analysis/study/precision/df_precision.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {
namespace {

constexpr double tightest = 1e-13;

/// The element by the FFT of `samples` samples, without an error estimate.
DescribingFunction by_fft(const Element& element, const DfPoint& point, int samples) {
  const PrescribedMotion motion(point.amplitude, point.frequency, point.bias, element.is_friction());
  DfOptions options;
  options.harmonics = 1;
  return FftRoute(element, motion, element.odd() && point.bias == 0.0, point.bias, options).on_samples(samples);
}

double difference(const DescribingFunction& one, const DescribingFunction& reference) {
  const double size = std::abs(reference.gain);
  return size == 0.0 ? std::abs(one.gain) : std::abs(one.gain - reference.gain) / size;
}

class PrecisionOfDf {
 public:
  PrecisionOfDf(const Element& element, const std::vector<DfPoint>& points, const DfPrecisionOptions& options)
      : element_(element), options_(options) {
    for (const DfPoint& point : points) add_reference(point);
  }

  DfPrecision run() {
    if (result_.points.empty()) return std::move(result_);
    verify();
    std::vector<WorkMethod> methods;
    methods.push_back({"fft", "evaluations", {}, [this](std::size_t i) {
                         return over_points([&](const DfPoint& p) { return by_fft(element_, p, samples_[i]); });
                       }});
    for (int n = 64; n <= options_.largest_fft; n *= 4) {
      samples_.push_back(n);
      methods.back().settings.push_back(std::to_string(n) + " samples");
    }
    for (const auto& [name, method] :
         {std::pair("quadrature", DfMethod::quadrature), {"automatic", DfMethod::automatic}}) {
      methods.push_back({name, "evaluations", {}, [this, method = method](std::size_t i) {
                           DfOptions options{1, options_.accuracies[i], method};
                           return over_points(
                               [&](const DfPoint& p) { return describing_function(element_, p, options); });
                         }});
      for (const double accuracy : options_.accuracies)
        methods.back().settings.push_back("accuracy " + short_number(accuracy));
    }
    for (const auto& method : methods) {
      auto more = run_method(method, options_.work);
      std::ranges::move(more, std::back_inserter(result_.results));
    }
    return std::move(result_);
  }

 private:
  void add_reference(const DfPoint& point) {
    auto reference = describing_function(element_, point, {1, tightest, DfMethod::automatic});
    if (!reference.answered() || reference.gain == 0.0) {
      result_.notes.push_back("no describing function at amplitude " + short_number(point.amplitude) + " and " +
                              short_number(point.frequency) + " rad/s (" + std::string(to_string(reference.status)) +
                              "): the point is left out");
      return;
    }
    result_.error = std::max(result_.error, reference.error);
    result_.made_by = std::string(reference.method) + " at accuracy " + short_number(tightest);
    result_.points.push_back(point);
    references_.push_back(std::move(reference));
  }

  void verify() {
    const int samples = std::max(options_.largest_fft, 1024);
    result_.verified_by = "FFT of " + std::to_string(samples) + " uniform samples";
    for (std::size_t i = 0; i < references_.size(); ++i) {
      if (options_.work.stop && options_.work.stop()) return;
      const auto second = by_fft(element_, result_.points[i], samples);
      const double apart = second.answered() ? difference(second, references_[i]) : 1.0;
      result_.agreement = std::max(result_.agreement, apart);
    }
  }

  template <class Method>
  Attempt over_points(const Method& method) {
    Attempt worst;
    worst.status = Status::converged;
    worst.answered = true;
    worst.error = 0.0;
    for (std::size_t i = 0; i < references_.size(); ++i) {
      if (options_.work.stop && options_.work.stop()) worst.status = Status::interrupted;
      if (worst.status == Status::interrupted) return worst;
      const DescribingFunction one = method(result_.points[i]);
      worst.evaluations += one.evaluations;
      if (!one.answered()) return failed(std::move(worst), one.status, i);
      if (one.status != Status::converged) worst.status = one.status;
      const double error = difference(one, references_[i]);
      if (error > worst.error) {
        worst.error = error;
        if (error > right_within) worst.why = "worst at " + place(i);
      }
    }
    return worst;
  }

  Attempt failed(Attempt so_far, Status status, std::size_t point) const {
    so_far.answered = false;
    so_far.status = status;
    so_far.why = std::string(to_string(status)) + " at " + place(point);
    return so_far;
  }

  std::string place(std::size_t i) const {
    return "amplitude " + short_number(result_.points[i].amplitude) + " and " +
           short_number(result_.points[i].frequency) + " rad/s";
  }

  const Element& element_;
  const DfPrecisionOptions& options_;
  std::vector<DescribingFunction> references_;
  std::vector<int> samples_;
  DfPrecision result_;
};

}  // namespace

std::vector<DfPoint> representative_points(const Element& element, double amplitude) {
  const Scales scales = element.scales();
  const double unit = std::isfinite(scales.displacement) ? scales.displacement : amplitude;
  std::vector<DfPoint> points;
  for (const double factor : {0.1, 1.0, 10.0, 1000.0}) {
    const double A = factor * unit;
    if (!std::isfinite(scales.velocity)) {
      points.push_back({A, 1.0, 0.0});
      continue;
    }
    for (const double speed : {0.1, 10.0}) points.push_back({A, speed * scales.velocity / A, 0.0});
  }
  return points;
}

std::vector<DfPoint> representative_points(const std::vector<double>& amplitudes,
                                           const std::vector<double>& frequencies) {
  const auto spread = [](const std::vector<double>& list, std::size_t count) {
    if (list.size() <= count) return list;
    std::vector<double> chosen;
    for (std::size_t k = 0; k < count; ++k) chosen.push_back(list[k * (list.size() - 1) / (count - 1)]);
    return chosen;
  };
  std::vector<DfPoint> points;
  for (const double amplitude : spread(amplitudes, 5))
    for (const double frequency : spread(frequencies, 3)) points.push_back({amplitude, frequency, 0.0});
  return points;
}

DfPrecision df_precision(const Element& element, const std::vector<DfPoint>& points,
                         const DfPrecisionOptions& options) {
  return PrecisionOfDf(element, points, options).run();
}

}  // namespace limcycle
