#include "limcycle/analysis/study/remedy/impulse_remedy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/remedy/remedy_search.hpp"

namespace limcycle {
namespace {

class ImpulseSearch {
 public:
  ImpulseSearch(const RemedyCandidate& candidate, double reference, const HuntingLoop& loop,
                const std::function<void(double)>& progress)
      : candidate_(candidate), reference_(reference), loop_(loop), progress_(progress) {}

  Remedy run() {
    Remedy remedy{candidate_, false};
    if (!scan() || !lies_well_within()) {
      if (open_ || stopped()) remedy.ends = std::nullopt;
      remedy.why = stopped() ? "interrupted" : nothing_found();
      return remedy;
    }
    remedy.ends = true;
    remedy.value = enough_;
    remedy.after = run_;
    remedy.why = lower_edge();
    HuntingLoop of_impulses = loop_;  // whose cycles are none of the loop with integral action
    of_impulses.followable = false;
    RemedySearch(candidate_, of_impulses, [this](double fraction) {
      tell(0.6 + 0.4 * fraction);
    }).locate_far_edge(remedy, {enough_, too_little_});
    return remedy;
  }

 private:
  enum class Found { within, outside, hunts, open };

  bool stopped() const { return loop_.judging.predict.stop && loop_.judging.predict.stop(); }
  void tell(double fraction) const {
    if (progress_) progress_(fraction);
  }
  static std::string newtons(double value) { return short_number(value, 3) + " N"; }

  /// The largest error at the end of the motions.
  double error_of(const PredictReport& found) const {
    double most = 0.0;
    for (const OutcomeOfStart& one : found.outcomes)
      if (!one.trace.y.empty()) most = std::max(most, std::abs(reference_ - one.trace.y_origin - one.trace.y.back()));
    return most;
  }

  using Care = HuntingEdge::Care;

  Found judged(double size, Care care = Care::full) {
    constexpr double near = 1.01;  // motions end a little before rest
    const auto parts = candidate_.parts(size);
    if (!parts) return Found::open;
    HuntsAnswer answer = hunts(build_loop(*parts), care == Care::full ? loop_.judging : hurried(loop_.judging));
    if (answer.hunts == Hunts::yes || answer.hunts == Hunts::diverges) return Found::hunts;
    if (answer.hunts != Hunts::no) return Found::open;
    if (error_of(answer.found) > near * candidate_.band) return Found::outside;
    if (!answer.found.outcomes.empty()) run_ = std::move(answer.found.outcomes.front().trace);
    return Found::within;
  }

  bool scan() {
    constexpr int a_decade = 4, values = 2 * a_decade;
    const double smallest = 0.5 * loop_.sizes.force;
    for (int k = 0; k <= values && !stopped(); ++k) {
      tell(0.4 * k / values);
      const double size = rounded_to(smallest * std::pow(10.0, static_cast<double>(k) / a_decade), 3);
      const Found here = judged(size, Care::quick);
      open_ = open_ || here == Found::open;
      if (here == Found::hunts) {
        hunts_at_ = size;
        return false;
      }
      if (here == Found::within) {
        enough_ = size;
        bisect();
        return true;
      }
      set_too_little(size, here);
    }
    return false;
  }

  void set_too_little(double size, Found found) {
    too_little_ = size;
    still_hops_ = found == Found::open;
  }

  void bisect() {
    constexpr double narrow = 1.01, narrow_for_time = 1.1;  // which is no edge of the loop
    while (too_little_ > 0.0 && enough_ / too_little_ > (still_hops_ ? narrow_for_time : narrow) && !stopped()) {
      const double middle = rounded_to(std::sqrt(too_little_ * enough_), 3);
      if (middle <= too_little_ || middle >= enough_) return;
      const Found here = judged(middle, Care::quick);
      if (here == Found::within)
        enough_ = middle;
      else
        set_too_little(middle, here);
    }
  }

  /// Moves on to larger ones until those a little larger do as well.
  bool lies_well_within() {
    constexpr std::array a_little_beyond{1.1, 1.03, 1.0};  // the last one's run is kept
    constexpr int most = 4;
    for (int i = 0; i < most && !stopped(); ++i) {
      Found here = Found::within;
      const auto bad = std::ranges::find_if(a_little_beyond, [&](double factor) {
        here = judged(rounded_to(factor * enough_, 3));
        return here != Found::within;
      });
      if (bad == a_little_beyond.end()) return true;
      set_too_little(rounded_to(*bad * enough_, 3), here);
      enough_ = rounded_to(1.05 * too_little_, 3);
    }
    open_ = true;
    return false;
  }

  std::string lower_edge() const {
    if (too_little_ == 0.0) return "holds the error at every size tried, down to " + newtons(enough_);
    const std::string less = short_number(too_little_, 3), more = newtons(enough_);
    if (still_hops_) return "at " + less + " the body still hops when the simulation ends, it arrives at " + more;
    return "leaves more than " + short_number(candidate_.band, 3) + " m at " + less + ", no longer at " + more;
  }

  std::string nothing_found() const {
    if (hunts_at_ > 0.0)
      return (too_little_ > 0.0 ? "impulses of " + newtons(too_little_) + " leave a larger error, those of "
                                : "impulses of ") +
             newtons(hunts_at_) + " make it hop for ever";
    return open_ ? "simulations do not decide at every size up to " + newtons(too_little_)
                 : "no size up to " + newtons(too_little_) + " brings it within the band";
  }

  const RemedyCandidate& candidate_;
  const double reference_;
  const HuntingLoop& loop_;
  const std::function<void(double)>& progress_;
  Trace run_ = {};
  double enough_ = 0.0, too_little_ = 0.0, hunts_at_ = 0.0;
  bool open_ = false;
  bool still_hops_ = false;  ///< at too_little_
};

}  // namespace

Remedy impulse_remedy(const RemedyCandidate& candidate, double reference, const HuntingLoop& loop,
                      const std::function<void(double)>& progress) {
  return ImpulseSearch(candidate, reference, loop, progress).run();
}

}  // namespace limcycle
