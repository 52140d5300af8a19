#include "limcycle/analysis/study/tune/local_search.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "limcycle/analysis/study/tune/direct_search.hpp"
#include "limcycle/analysis/study/tune/judged_points.hpp"

namespace limcycle {
namespace {

constexpr std::size_t most_judgements = 40;

class LocalSearchRun {
 public:
  LocalSearchRun(const std::vector<TunePoint>& known, std::size_t start, std::size_t number, const TuneSpace& space,
                 const TuneQuestion& question)
      : number_(number), space_(space), question_(question), least_(*question.cost_of(known[start])), judged_(space) {
    for (const TunePoint& one : known) {
      tried_.insert(one.values);
      judged_.add(one);
    }
  }

  /// The first of these places that is better: see DirectSearch.
  std::optional<std::size_t> first_better(std::span<const std::vector<double>> places, double step) {
    for (const auto& [place, i] : cheaper_of(places, step)) {
      if (is_over()) break;
      TunePoint& point = found_.points[i];
      judge(point, question_, judged_.hunting_near(point.values));
      judged_.add(point);
      ++found_.judged;
      if (point.outcome != TuneOutcome::feasible) continue;
      least_ = *question_.cost_of(point);
      found_.reached = i;
      return place;
    }
    return std::nullopt;
  }

  bool is_over() const { return is_stopped() || found_.judged >= most_judgements; }
  LocalSearch& found() { return found_; }

 private:
  struct Tried {
    std::size_t place, point;
  };

  bool is_stopped() const { return question_.judging.predict.stop && question_.judging.predict.stop(); }

  /// The places that would be better if they did not hunt, in the order in which they are judged.
  std::vector<Tried> cheaper_of(std::span<const std::vector<double>> places, double step) {
    std::vector<std::tuple<bool, double, Tried>> cheaper;
    for (std::size_t k = 0; k < places.size() && !is_stopped(); ++k) {
      TunePoint point{space_.values(places[k]), TunePoint::Part::search, number_};
      if (!tried_.insert(point.values).second) continue;
      look_at(point, question_);
      const auto cost = question_.cost_of(point);
      if (point.outcome == TuneOutcome::not_judged && cost && is_lower(*cost, least_) &&
          !judged_.refuted_within(0.5 * step, point.values))
        cheaper.emplace_back(!judged_.suggest_feasible(point.values), *cost, Tried{k, found_.points.size()});
      found_.points.push_back(std::move(point));
    }
    std::ranges::stable_sort(cheaper, {},
                             [](const auto& one) { return std::pair(std::get<0>(one), std::get<1>(one)); });
    std::vector<Tried> order;
    order.reserve(cheaper.size());
    for (const auto& one : cheaper) order.push_back(std::get<2>(one));
    return order;
  }

  const std::size_t number_;
  const TuneSpace& space_;
  const TuneQuestion& question_;
  double least_;
  std::set<std::vector<double>> tried_;
  JudgedPoints judged_;
  LocalSearch found_;
};

}  // namespace

LocalSearch search_from(const std::vector<TunePoint>& known, std::size_t start, std::size_t number,
                        const TuneSpace& space, const TuneQuestion& question, std::uint64_t seed) {
  LocalSearchRun run(known, start, number, space, question);
  auto place = space.place(known[start].values);
  const bool ended = DirectSearch{}.run(
      place, RandomStream(seed, "tune", number),
      [&](auto places, double step) { return run.first_better(places, step); }, [&] { return run.is_over(); });
  run.found().ended = ended;
  return std::move(run.found());
}

}  // namespace limcycle
