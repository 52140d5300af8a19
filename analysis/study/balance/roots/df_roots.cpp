#include "limcycle/analysis/study/balance/roots/df_roots.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/roots/rootless_parts.hpp"
#include "limcycle/analysis/study/balance/roots/within_data.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

class RootStudy {
 public:
  RootStudy(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
            const std::function<bool()>& stop, long max_evaluations)
      : loop_(loop),
        balance_(balance),
        box_(box),
        stop_(stop),
        last_evaluation_(balance.evaluations() + max_evaluations) {}

  DfRoots run() {
    for (const double pole : undamped_poles())
      found_.notes.push_back("the rest of the loop has an undamped resonance at " + short_number(pole) +
                             " rad/s: roots within 0.1 % of it are not searched");
    for (const SearchBox& box : between_undamped_poles()) {
      const auto roots = search(box);
      found_.roots.insert(found_.roots.end(), roots.begin(), roots.end());
    }
    return std::move(found_);
  }

 private:
  std::vector<double> undamped_poles() const {
    std::vector<double> found;
    for (const auto& pole : eigenvalues(loop_.A))
      if (pole.imag() > 0.0 && std::abs(pole.real()) < 1e-9 * pole.imag()) found.push_back(pole.imag());
    std::ranges::sort(found);
    return found;
  }

  /// G is infinite at an undamped pole of the rest of the loop: the box is cut there, a part in 1e3 of the frequency.
  std::vector<SearchBox> between_undamped_poles() const {
    const auto cuts = undamped_poles();
    std::vector<SearchBox> boxes;
    for (const SearchBox& known : within_data(loop_, box_)) {
      boxes.push_back(known);
      for (const double cut : cuts) {
        SearchBox& last = boxes.back();
        if (cut <= last.frequency_min * 1.001 || cut >= last.frequency_max * 0.999) continue;
        SearchBox next = last;
        last.frequency_max = cut * (1.0 - 1e-3);
        next.frequency_min = cut * (1.0 + 1e-3);
        boxes.push_back(next);
      }
    }
    return boxes;
  }

  /// On a belt N has a kink where the velocity amplitude A w is the mean velocity: there the search runs over (A w, w),
  /// in which that line is straight.
  std::vector<Root> search(SearchBox box) {
    RootSearchOptions options;
    options.interrupted = [this] { return used_up() || (stop_ && stop_()); };
    options.stop = stop_;
    // The other element's kink crosses the whole box; for gravity it is a ridge along the free swing, on which f is
    // small.
    if (balance_.main_element() > 0) options.max_evaluations = 20000;
    // For each frequency the gain of the main element is sampled over all amplitudes: without a closed form at an
    // accuracy that its kernel still reaches, a fiftieth of the work of a quadrature.
    const bool closed_form = loop_.elements[balance_.main_element()].facts().has_closed_form;
    const bool sampled = balance_.has_second() && !closed_form;
    if (sampled) options.fine_accuracy = 1e-10;
    // Each sample of a law of many states, or of a belt, takes long too; a root is polished to the fine accuracy in any
    // case.
    if (sampled || loop_.elements[balance_.main_element()].states() > 2 || balance_.mean_velocity() != 0.0)
      options.coarse_accuracy = 1e-4;
    for (const auto& pole : eigenvalues(loop_.tangent()))
      if (pole.imag() > box.frequency_min && pole.imag() < box.frequency_max)
        options.frequency_hints.push_back(std::abs(pole));
    // The phase of a delay must not turn by more than about 0.7 between two samples.
    const double turns = box.frequency_max * loop_.delay * std::log(box.frequency_max / box.frequency_min);
    options.initial_cells_frequency = std::clamp(static_cast<int>(turns / 1.4), options.initial_cells_frequency, 800);
    const double speed = std::abs(balance_.mean_velocity());
    if (speed > 0.0) {
      box.amplitude_min *= box.frequency_min;
      box.amplitude_max *= box.frequency_max;
      if (speed > box.amplitude_min && speed < box.amplitude_max) options.amplitude_hints = {speed};
    }
    options.prepare = [&](std::vector<SearchPoint> points, double accuracy) {
      for (SearchPoint& point : points)
        if (speed > 0.0) point.amplitude /= point.frequency;
      balance_.prepare(points, accuracy, options.interrupted);
    };
    if (speed == 0.0)
      if (const auto known = RootlessParts::of(loop_, box))
        options.rootless = [=](const SearchBox& part) { return known->forbids(part); };
    std::vector<Root> roots;
    for (int branch = 0; branch < (balance_.has_second() ? AmplitudeBranches::most : 1); ++branch) {
      const auto f = [&](double A, double w, double accuracy) {
        const double amplitude = speed > 0.0 ? A / w : A;
        return balance_.has_second() ? balance_.on_branch(branch, amplitude, w, accuracy)
                                     : balance_(amplitude, w, accuracy);
      };
      auto found = find_roots(f, box, options);
      if (branch > 0 && found.status == Status::not_finite) break;
      for (Root& root : found.roots) {
        if (speed > 0.0) root.amplitude /= root.frequency;
        roots.push_back(root);
      }
      note_doubts(found, box);
    }
    if (balance_.has_second()) add_roots_from_second(box, options, roots);
    return without_doubles(roots);
  }

  /// Search over the amplitude of the second element's input; that of the main element follows from it.
  void add_roots_from_second(const SearchBox& box, RootSearchOptions options, std::vector<Root>& roots) {
    const auto [from, to] = balance_.second_range();
    const SearchBox second{from, to, box.frequency_min, box.frequency_max};
    options.prepare = {};
    options.amplitude_hints.clear();
    for (int branch = 0; branch < AmplitudeBranches::most; ++branch) {
      const auto f = [&](double a, double w, double accuracy) {
        return balance_.from_second(branch, a, w, accuracy).left;
      };
      auto found = find_roots(f, second, options);
      if (found.status == Status::not_finite) break;
      if (used_up()) note_doubts(found, second);
      for (Root& root : found.roots) {
        root.amplitude = balance_.from_second(branch, root.amplitude, root.frequency, 1e-12).amplitude;
        roots.push_back(root);
      }
    }
  }

  /// The roots in the box, each once: two branches meet where one turns into the other, and a second element is
  /// searched from both sides.
  std::vector<Root> without_doubles(const std::vector<Root>& roots) const {
    const auto near = [](double a, double b) { return std::abs(a / b - 1.0) < 1e-7; };
    std::vector<Root> kept;
    for (const Root& root : roots) {
      constexpr double edge = 1e-9;
      if (!(root.amplitude > box_.amplitude_min * (1.0 - edge) && root.amplitude < box_.amplitude_max * (1.0 + edge)))
        continue;
      if (std::ranges::none_of(kept, [&](const Root& other) {
            return near(other.amplitude, root.amplitude) && near(other.frequency, root.frequency);
          }))
        kept.push_back(root);
    }
    std::ranges::sort(kept, {}, [](const Root& root) { return std::pair(root.frequency, root.amplitude); });
    return kept;
  }

  void note_doubts(const RootSearch& found, const SearchBox& box) {
    if (found.status == Status::converged || found.status == Status::no_cycle) return;
    if (used_up() && !(stop_ && stop_())) {
      const std::string note = "root search: step limit reached, solutions may be missing";
      if (std::ranges::find(found_.notes, note) == found_.notes.end()) found_.notes.push_back(note);
      found_.status = Status::incomplete;
      return;
    }
    const std::string range = short_number(box.frequency_min) + " and " + short_number(box.frequency_max) + " rad/s";
    std::string note =
        found.status == Status::not_finite
            ? "the describing function exists nowhere in the search box between " + range + ", so it predicts nothing"
            : "the root search between " + range + " ended with status " + std::string(to_string(found.status)) +
                  ": solutions may be missing";
    if (std::ranges::find(found_.notes, note) == found_.notes.end()) found_.notes.push_back(std::move(note));
    found_.status = found.status == Status::interrupted ? found.status : Status::incomplete;
  }

  bool used_up() const { return balance_.evaluations() > last_evaluation_; }

  const Loop& loop_;
  const FirstHarmonicBalance& balance_;
  const SearchBox& box_;
  const std::function<bool()>& stop_;
  long last_evaluation_;
  DfRoots found_;
};

}  // namespace

DfRoots find_df_roots(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                      const std::function<bool()>& stop, long max_evaluations) {
  return RootStudy(loop, balance, box, stop, max_evaluations).run();
}

}  // namespace limcycle
