#include "limcycle/analysis/study/adequacy/adequate.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/adequacy/asked_scenes.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {
namespace {

const std::string shooting = "shooting";

/// "finds no cycle, although a cycle exists": text for an answer whose verdict differs from the reference.
std::string disagreement(const std::string& verdict, const MethodAnswer& best) {
  const std::string claim = verdict.find('/') != std::string::npos ? "inconsistent"
                            : verdict == "cycle" || verdict == "no cycle"
                                ? "finds " + (verdict == "cycle" ? "a " + verdict : verdict)
                                : "ends in " + verdict;
  return claim + (best.hunts() ? ", although a cycle exists" : ", although the loop ends in " + best.verdict);
}

class LadderClimb {
 public:
  LadderClimb(const LoopParts& parts, const AdequateOptions& options)
      : parts_(parts), options_(options), asked_(options.predict, options.patience) {
    report_.tolerance = options.tolerance;
    report_.laws = simplified_laws(*parts.friction);
    choose_variations();
    for (const auto& one : variations_) report_.spread.push_back(one.name);
  }

  AdequateReport run() {
    if (!find_best()) return std::move(report_);
    find_best_over_spread();
    ask_laws();
    if (report_.least) find_cheapest();
    if (stopped()) report_.status = Status::interrupted;
    tell(1.0, "done");
    return std::move(report_);
  }

 private:
  void choose_variations() {
    if (!options_.variations.empty()) {
      variations_ = options_.variations;
      report_.spread_rule = options_.spread_rule;
    } else if (options_.spread > 0.0) {
      for (auto& one : law_variations(*parts_.friction, options_.spread)) {
        variations_.push_back({std::move(one.name), parts_});
        variations_.back().parts.friction = std::move(one.law);
      }
      report_.spread_rule = "each number of the law up and down, one at a time";
      varies_law_only_ = true;
    }
  }

  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.progress) options_.progress(fraction, what);
  }

  /// The same work for each of a number of laws or variations, on several threads.
  void for_each(std::size_t count, double from, double to, std::string_view what,
                const std::function<void(std::size_t)>& work) const {
    run_each(count, work,
             part_of_work(options_.threads, options_.predict.stop, options_.progress, from, to, std::string(what)));
  }

  const MethodAnswer& ask_at_own_values(const std::string& method, const Element& law) {
    return asked_.ask(method, 0, parts_, law);
  }

  const MethodAnswer& ask_at(std::size_t variation, const std::string& method, const Element& law) {
    return asked_.ask(method, varies_law_only_ ? 0 : variation + 1, variations_[variation].parts, law);
  }

  bool find_best() {
    tell(0.0, "the case's own law");
    const Loop loop = scene_loop(parts_, *parts_.friction);
    report_.best = ask_scene(shooting, loop, options_.predict);
    asked_.keep(shooting, 0, parts_, *parts_.friction, report_.best);
    if (!report_.best.answered) return give_up("its own law by shooting: " + report_.best.why);
    if (!report_.best.cycle) return confirm_without_cycle(loop);
    CycleReference reference{
        *report_.best.cycle, sizes_on_cycle(loop, *report_.best.cycle), {}, {}, false, infinite, infinite};
    verify(loop, reference, 1000000, options_.predict.stop);
    if (!(reference.agreement < 0.01 * options_.tolerance))
      return give_up("no second method confirms the cycle of its own law");
    report_.verified = "to " + short_number(reference.agreement, 2) + " by " + reference.verified_by;
    return true;
  }

  /// For a loop that does not hunt: true if simulations from other starts also find no hunting.
  bool confirm_without_cycle(const Loop& loop) {
    PredictOptions elsewhere = options_.predict;
    elsewhere.search = options_.predict.search.value_or(default_search_box(loop));
    elsewhere.search->amplitude_max *= 0.37;
    const MethodAnswer second = ask_scene(shooting, loop, elsewhere);
    if (!second.answered || second.verdict != report_.best.verdict)
      return give_up("simulations from other states do not confirm that its own law gives " + report_.best.verdict);
    report_.verified = "by simulations from other states";
    return true;
  }

  bool give_up(std::string why) {
    report_.status = stopped() ? Status::interrupted : Status::undefined;
    report_.why = std::move(why);
    return false;
  }

  /// A law for which shooting exceeds the patience costs the methods of the frequency domain no less, and is not
  /// adequate in any case: they are not run.
  static bool too_dear(const std::string& method, const MethodAnswer& by_shooting, double patience) {
    return by_shooting.seconds > patience && method != "simulation" && method != shooting;
  }

  /// Each law by every method, and by shooting over the spread. Later laws of the ladder take longer and begin first.
  void ask_laws() {
    const std::size_t count = report_.laws.size();
    std::vector<std::vector<AdequatePoint>> points(count);
    std::vector<char> finished(count, false);
    for_each(count, 0.3, 0.9, "laws", [&](std::size_t turn) {
      const std::size_t i = count - 1 - turn;
      if (report_.laws[i].law) ask_methods(report_.laws[i], points[i]);
      for (AdequatePoint& point : points[i])
        if (point.method == shooting && point.within) over_spread(point, i);
      finished[i] = !stopped();
    });
    for (auto& of_law : points) std::ranges::move(of_law, std::back_inserter(report_.points));
    for (std::size_t i = 0; i < count && finished[i] && !report_.least; ++i) {
      const AdequatePoint* point = point_of(report_.laws[i].name, shooting);
      if (point != nullptr && point->within) report_.least = i;
    }
  }

  void ask_methods(const SimplifiedLaw& rung, std::vector<AdequatePoint>& points) {
    const MethodAnswer by_shooting = ask_at_own_values(shooting, *rung.law);
    bool predicted = false;  // by a first-harmonic method, so that harmonic balance has a start
    for (const auto& method : answering_methods()) {
      if (stopped()) return;
      AdequatePoint point{.law = rung.name, .method = method, .answer = {}, .worst_at = {}, .why = {}};
      if (!rung.own && too_dear(method, by_shooting, options_.patience))
        point.answer = not_asked("not asked, since shooting with this law was " + by_shooting.why);
      else if (method == "harmonic-balance" && !predicted)
        point.answer = not_asked("no first-harmonic method predicts a cycle to begin from");
      else
        point.answer = ask_at_own_values(method, *rung.law);
      if (stopped()) return;
      predicted = predicted || (point.answer.answered && point.answer.hunts());
      point.error = scene_error(method, point.answer, report_.best);
      judge(point, point.error, point.answer, report_.best, "");
      points.push_back(std::move(point));
    }
  }

  /// Sets `within`, or the reason why not.
  void judge(AdequatePoint& point, double error, const MethodAnswer& answer, const MethodAnswer& best,
             const std::string& where) const {
    point.within = error <= options_.tolerance;
    if (point.within) return;
    if (!answer.answered)
      point.why = answer.why;
    else if (std::isinf(error))
      point.why = disagreement(answer.verdict, best);
    else
      point.why = "off by " + short_number(100.0 * error, 3) + " %";
    if (!where.empty()) point.why += " at " + where;
  }

  AdequatePoint* point_of(const std::string& law, const std::string& method) {
    const auto found = std::ranges::find_if(
        report_.points, [&](const AdequatePoint& one) { return one.law == law && one.method == method; });
    return found == report_.points.end() ? nullptr : &*found;
  }

  void find_best_over_spread() {
    best_.assign(variations_.size(), unanswered("not asked"));
    for_each(variations_.size(), 0.1, 0.3, "spread",
             [&](std::size_t i) { best_[i] = ask_at(i, shooting, *variations_[i].parts.friction); });
    for (std::size_t i = 0; i < variations_.size() && !stopped(); ++i)
      if (!best_[i].answered)
        report_.notes.push_back(variations_[i].name + ": the case's own law gives no answer, omitted (" + best_[i].why +
                                ")");
  }

  /// The same rung made from a varied law.
  static std::optional<Element> varied(const Element& own, std::size_t rung) {
    const auto ladder = simplified_laws(own);
    return rung < ladder.size() ? ladder[rung].law : std::nullopt;
  }

  /// Tests a point over the spread; it must have been within the tolerance before. Stops at the first place where it is
  /// not.
  void over_spread(AdequatePoint& point, std::size_t rung) {
    point.worst = point.error;
    point.worst_at = "the case's own values";
    for (std::size_t i = 0; i < best_.size() && !stopped() && point.within; ++i) {
      if (!best_[i].answered) continue;
      const auto law = varied(*variations_[i].parts.friction, rung);
      if (!law) continue;
      const MethodAnswer& answer = ask_at(i, point.method, *law);
      if (stopped()) return;
      const double error = scene_error(point.method, answer, best_[i]);
      if (error <= point.worst) continue;
      point.worst = error;
      point.worst_at = variations_[i].name;
      judge(point, error, answer, best_[i], variations_[i].name);
    }
  }

  void find_cheapest() {
    const std::string& law = report_.laws[*report_.least].name;
    for (std::size_t i = 0; i < report_.points.size() && !stopped(); ++i) {
      AdequatePoint& point = report_.points[i];
      if (point.law != law) continue;
      tell(0.9, point.method);
      if (point.within && point.method != shooting) over_spread(point, *report_.least);
      if (stopped() || !point.within) continue;
      if (!report_.cheapest || point.answer.seconds < report_.points[*report_.cheapest].answer.seconds)
        report_.cheapest = i;
    }
  }

  const LoopParts& parts_;
  const AdequateOptions& options_;
  AskedScenes asked_;
  std::vector<SceneVariation> variations_;
  bool varies_law_only_ = false;
  std::vector<MethodAnswer> best_;  ///< of the own law, for each variation
  AdequateReport report_;
};

}  // namespace

AdequateReport adequate(const LoopParts& parts, const AdequateOptions& options) {
  if (!parts.friction)
    throw std::invalid_argument("this loop has no [loop.friction]: `adequate` compares friction laws and needs one");
  return LadderClimb(parts, options).run();
}

}  // namespace limcycle
