#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "limcycle/analysis/study/identify/fit.hpp"
#include "limcycle/analysis/study/identify/identify.hpp"

namespace limcycle {

/// One law of identify(), fitted to prepared records, which must outlive it.
class LawFit {
 public:
  LawFit(const Element& kind, const std::vector<PreparedRecord>& records, const FreeChoice& choice,
         std::function<bool()> stop);
  LawFit(const LawFit&) = delete;
  LawFit& operator=(const LawFit&) = delete;

  /// Of a fit that converged; else NaN.
  double held_out() const { return result_.status == Status::converged ? result_.held_out : NAN; }
  /// The fit with intervals: by profile likelihood, or linear ones, which cost little.
  IdentifiedLaw with_intervals(bool profiled);

 private:
  bool stopped() const { return stop_ && stop_(); }
  void fit_with_noise();
  void refit();  ///< with the noise as it is, and all that does not need intervals

  std::function<bool()> stop_;
  ParameterSpace space_;
  const std::vector<PreparedRecord>& records_;
  IdentifiedLaw result_;
  Fit best_;
  std::vector<double> noise_;
  bool answered_ = false;
};

}  // namespace limcycle
