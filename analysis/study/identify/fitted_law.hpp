#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <optional>
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

  /// Root mean square of what is left over of the free motions, as a share of their sizes, where they are simulated
  /// that way; infinite if there is no answer, 0 without free motions.
  double error_of_motion(Shooting shooting) const;
  /// Takes the fit with that kind of simulation. To be called before what follows.
  void settle(Shooting shooting);
  /// Of a fit that converged; else NaN.
  double held_out() const { return result_.status == Status::converged ? result_.held_out : NAN; }
  /// The fit with intervals: by profile likelihood, or linear ones, which cost little.
  IdentifiedLaw with_intervals(bool profiled);
  /// See plan_records().
  std::optional<IdentifyPlan> plan() const { return plan_records(misfit_now(), best_.u, stop_); }

 private:
  /// A fit with the noise that it leaves.
  struct Noisy {
    Fit fit;
    std::vector<double> noise;
  };
  bool stopped() const { return stop_ && stop_(); }
  std::optional<Noisy> fit_with_noise(Shooting shooting, const std::optional<Noisy>& from);
  Misfit misfit_now() const;  ///< with the noise as it is
  void refit();               ///< with the noise as it is, and all that does not need intervals

  std::function<bool()> stop_;
  ParameterSpace space_;
  const std::vector<PreparedRecord>& records_;
  IdentifiedLaw result_;
  Fit best_;
  std::vector<double> noise_;
  std::array<std::optional<Noisy>, 2> fits_ = {};  ///< by Shooting
  Shooting shooting_ = Shooting::single;
  bool answered_ = false;
};

}  // namespace limcycle
