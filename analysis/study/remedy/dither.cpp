#include "limcycle/analysis/study/remedy/dither.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/dithered_coulomb.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::VectorXd;

constexpr long most_windows = 300;  ///< times as long as the period of hunting
constexpr long most_steps = 400'000;
constexpr std::size_t fewest_windows = 24;  ///< before hunting is taken to last
constexpr double rtol_of_dither = 1e-7;

/// The motion of a loop under dither, one period of the dither after the other.
class DitheredMotion {
 public:
  DitheredMotion(const Loop& loop, const LoopState& from, const Dither& dither)
      : loop_(loop), period_(2.0 * std::numbers::pi / dither.frequency), field_(loop) {
    field_.set_external([constant = loop.external, dither](double t, External& value, External& rate) {
      value = constant;
      rate.setZero();
      value(external_force) += dither.amplitude * std::sin(dither.frequency * t);
      rate(external_force) = dither.amplitude * dither.frequency * std::cos(dither.frequency * t);
    });
    field_.modes() = from.modes;
    march_.emplace(field_, StepperKind::automatic, loop_weights(loop, rtol_of_dither));
    march_->limit_step(period_ / 8.0);
    march_->begin(from.x, 0.0);
  }

  double period() const { return period_; }
  long steps() const { return march_->steps(); }

  /// Means of the linear states over the next period; empty if the march cannot go on.
  std::optional<VectorXd> next_mean() {
    const auto n = static_cast<std::size_t>(loop_.states());
    VectorXd sum = VectorXd::Zero(loop_.states());
    const double until = static_cast<double>(++count_) * period_;
    while (march_->t() < until) {
      if (march_->step(until) != Status::converged) return std::nullopt;
      const Step& one = march_->last();
      const double h = one.t1 - one.t0;
      for (std::size_t i = 0; i < n; ++i)  // of the cubic through the step
        sum(static_cast<Eigen::Index>(i)) += h * (0.5 * (one.x0[i] + one.x1[i]) + h / 12.0 * (one.dx0[i] - one.dx1[i]));
    }
    return sum / period_;
  }

 private:
  const Loop& loop_;
  double period_;
  long count_ = 0;
  LoopField field_;
  std::optional<March> march_;
};

/// True if the swings have not shrunk: the largest in the second half is that of the quarter before it, and more than
/// `least`. A body that waits for an integrator does not swing for many windows.
bool swings_last(const std::vector<double>& swings, double least) {
  if (swings.size() < fewest_windows) return false;
  const auto middle = swings.begin() + std::ssize(swings) / 2, quarter = swings.begin() + std::ssize(swings) / 4;
  const double before = *std::max_element(quarter, middle), now = *std::max_element(middle, swings.end());
  return before > least && now >= 0.995 * before;
}

}  // namespace

std::string why_no_dither(const LoopParts& parts) {
  if (parts.diagram) return "in a diagram it is not implemented";
  if (!parts.friction) return "there is no friction that a dither could smooth";
  if (std::holds_alternative<NoController>(parts.controller)) return "there is no controller that could add it";
  if (parts.reference_rate != 0.0) return "it is not implemented along a ramp";
  const Loop loop = build_loop(parts);
  if (loop.sampled || loop.delay > 0.0) return "it is not implemented with sampling or a dead time";
  return {};
}

std::optional<double> frequency_of_dither(const LoopParts& parts) {
  const auto crossover = highest_crossover(parts);
  return crossover ? std::optional(rounded_to(10.0 * *crossover, 3)) : std::nullopt;
}

std::optional<double> dither_speed(const LoopParts& parts, const Dither& dither) {
  const auto* law = parts.friction ? parts.friction->as<Coulomb<double>>() : nullptr;
  if (law == nullptr || dither.amplitude < std::max(law->Fs, law->Fs_minus)) return std::nullopt;
  const Loop loop = build_loop(parts);
  const Port& rubbing = loop.ports.back();
  const auto at = loop.resolved(std::complex<double>(0.0, dither.frequency));
  Eigen::MatrixXcd columns(loop.states(), 2);
  columns << loop.E.col(external_force).cast<std::complex<double>>(), at.B.rightCols(1);
  const Eigen::RowVectorXcd response = rubbing.C_v.cast<std::complex<double>>() * solve_columns(at.from, columns);
  const std::complex<double> g = response(0), h = response(1);
  const double dry = 2.0 * (law->Fc + law->Fc_minus) / std::numbers::pi;
  // |c a - d|^2 = |g amplitude|^2
  const std::complex<double> c = 1.0 - h * law->sigma2, d = h * dry;
  const double half = (c * std::conj(d)).real() / std::norm(c);
  const double rest = (std::norm(d) - std::norm(g) * dither.amplitude * dither.amplitude) / std::norm(c);
  const double under = half * half - rest;
  if (!(under >= 0.0)) return std::nullopt;
  const double a = half + std::sqrt(under);
  return a > 0.0 && std::isfinite(a) ? std::optional(a) : std::nullopt;
}

std::optional<LoopParts> averaged_over(const LoopParts& parts, const Dither& dither) {
  const auto speed = dither_speed(parts, dither);
  if (!speed) return std::nullopt;
  const auto* law = parts.friction->as<Coulomb<double>>();
  DitheredCoulomb<double> mean;
  mean.Fc = law->Fc;
  mean.Fc_minus = law->Fc_minus;
  mean.sigma2 = law->sigma2;
  mean.speed = *speed;
  LoopParts averaged = parts;
  averaged.friction = Element(mean);
  return averaged;
}

Hunts hunts_under(const Loop& loop, const LoopState& from, const Dither& dither, const Cycle& hunting,
                  const std::function<bool()>& stop) {
  DitheredMotion motion(loop, from, dither);
  const State typical = typical_sizes(loop);
  const auto sizes = Eigen::Map<const VectorXd>(typical.data(), loop.states());
  const auto periods = static_cast<long>(std::ceil(hunting.period / motion.period()));
  std::optional<VectorXd> before;
  std::vector<double> swings;
  for (long window = 0; window < most_windows; ++window) {
    double low = infinite, high = -infinite;
    std::optional<VectorXd> mean;
    for (long k = 0; k < periods; ++k) {
      if ((stop && stop()) || motion.steps() > most_steps) return Hunts::undecided;
      mean = motion.next_mean();
      if (!mean || !mean->allFinite()) return Hunts::undecided;
      const double y = loop.C_y.dot(*mean);
      low = std::min(low, y);
      high = std::max(high, y);
    }
    const double swing = 0.5 * (high - low);
    if (swing > 1e3 * hunting.amplitude) return Hunts::diverges;
    const bool still = before && ((*mean - *before).cwiseAbs().array() <= 1e-3 * sizes.array()).all();
    if (still && swing <= 1e-2 * hunting.amplitude) return Hunts::no;
    before = mean;
    swings.push_back(swing);
    if (swings_last(swings, 1e-2 * hunting.amplitude)) return Hunts::yes;
  }
  return Hunts::undecided;
}

namespace {

class DitherSearch {
 public:
  DitherSearch(const RemedyCandidate& candidate, const LoopParts& parts, const HuntingLoop& loop, double step,
               const std::function<void(double)>& progress)
      : candidate_(candidate), parts_(parts), loop_(loop), step_(step), progress_(progress), built_(build_loop(parts)) {
    for (const Cycle& one : loop.cycles)
      if (one.stable == true && (hunting_ == nullptr || one.amplitude > hunting_->amplitude)) hunting_ = &one;
  }

  Remedy run() {
    Remedy remedy{candidate_};
    if (hunting_ == nullptr) {
      remedy.why = "the loop has no stable cycle with whose period the motion under dither could be compared";
      return remedy;
    }
    if (!scan()) {
      if (!open_ && !stopped()) remedy.ends = false;
      remedy.why = stopped() ? "interrupted" : nothing_found() + at_frequency();
      return remedy;
    }
    bisect();
    if (stopped()) {
      remedy.why = "interrupted";
      return remedy;
    }
    remedy.ends = true;
    remedy.value = ends_;
    remedy.why = verdict() + at_frequency() + averaged();
    if (not_ending_ > 0.0) {
      remedy.edges.push_back(ends_);
      remedy.beyond.push_back(not_ending_);
    }
    return remedy;
  }

 private:
  bool stopped() const { return loop_.judging.predict.stop && loop_.judging.predict.stop(); }
  static std::string newtons(double value) { return short_number(value, 3) + " N"; }
  std::string at_frequency() const { return " (a sine of " + short_number(candidate_.frequency, 3) + " rad/s)"; }

  Hunts judged(double amplitude) const {
    const Dither dither{amplitude, candidate_.frequency};
    const Hunts here = hunts_under(built_, hunting_->start, dither, *hunting_, loop_.judging.predict.stop);
    if (here != Hunts::no) return here;
    return hunts_under(built_, displaced(built_, step_), dither, *hunting_, loop_.judging.predict.stop);
  }

  bool scan() {
    constexpr int a_decade = 4, values = 3 * a_decade;
    const double smallest = 0.1 * loop_.sizes.force;
    for (int k = 0; k <= values && !stopped(); ++k) {
      if (progress_) progress_(static_cast<double>(k) / (values + 6));
      const double value = rounded_to(smallest * std::pow(10.0, static_cast<double>(k) / a_decade), 3);
      const Hunts here = judged(value);
      open_ = open_ || here == Hunts::undecided;
      if (here == Hunts::no) {
        ends_ = value;
        return true;
      }
      keep(value, here);
    }
    return false;
  }

  void bisect() {
    constexpr double narrow = 1.01, narrow_beside_undecided = 1.1;
    while (not_ending_ > 0.0 && ends_ / not_ending_ > (undecided_ ? narrow_beside_undecided : narrow) && !stopped()) {
      const double middle = rounded_to(std::sqrt(not_ending_ * ends_), 3);
      if (middle <= not_ending_ || middle >= ends_) return;
      const Hunts here = judged(middle);
      if (here == Hunts::no)
        ends_ = middle;
      else
        keep(middle, here);
    }
  }

  void keep(double value, Hunts here) {
    not_ending_ = value;
    undecided_ = here == Hunts::undecided;
    if (!undecided_) hunts_at_ = value;
  }

  std::string nothing_found() const {
    if (!open_) return "no amplitude up to " + newtons(not_ending_) + " ends it";
    return (hunts_at_ > 0.0 ? "hunts at " + newtons(hunts_at_) + "; " : "") + "up to " + newtons(not_ending_) +
           " simulations show no end of it, and do not decide at every amplitude";
  }

  std::string verdict() const {
    if (not_ending_ == 0.0) return "rests at every value tried, down to " + newtons(ends_);
    std::string said = hunts_at_ > 0.0 ? "hunts at " + short_number(hunts_at_, 3) + ", " : "";
    if (undecided_) said += "not decided at " + short_number(not_ending_, 3) + ", ";
    return said + "no longer at " + newtons(ends_);
  }

  /// The verdict of the averaged friction, a clause: at the amplitude found, or at the next one for which there is such
  /// a mean.
  std::string averaged() const {
    constexpr double farthest = 100.0;
    if (built_.elements.size() > 1 || parts_.friction->as<Coulomb<double>>() == nullptr) return {};
    Dither dither{ends_, candidate_.frequency};
    std::optional<LoopParts> parts = averaged_over(parts_, dither);
    for (; !parts && dither.amplitude < farthest * ends_; parts = averaged_over(parts_, dither))
      dither.amplitude = rounded_to(1.1 * dither.amplitude, 3);
    if (!parts) return "; no amplitude keeps the body moving by its first harmonic, so that no mean law applies";
    const Hunts mean = hunts(build_loop(*parts), loop_.judging).hunts;
    return "; with the mean of the friction over " + newtons(dither.amplitude) + ", smooth below " +
           short_number(*dither_speed(parts_, dither), 3) + " m/s, it " +
           (mean == Hunts::no    ? "does not hunt either"
            : mean == Hunts::yes ? "hunts: the two disagree"
                                 : "was not decided");
  }

  const RemedyCandidate& candidate_;
  const LoopParts& parts_;
  const HuntingLoop& loop_;
  const double step_;
  const std::function<void(double)>& progress_;
  const Loop built_;
  const Cycle* hunting_ = nullptr;
  double ends_ = 0.0, not_ending_ = 0.0, hunts_at_ = 0.0;
  bool open_ = false, undecided_ = false;
};

}  // namespace

Remedy dither_remedy(const RemedyCandidate& candidate, const LoopParts& parts, const HuntingLoop& loop, double step,
                     const std::function<void(double)>& progress) {
  return DitherSearch(candidate, parts, loop, step, progress).run();
}

}  // namespace limcycle
