#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/roots/within_data.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

std::string ended(Status status) {
  return status == Status::interrupted ? "step limit reached" : "ended with status " + std::string(to_string(status));
}

void check(const CompositeSearchOptions& o) {
  const auto refuse = [](const std::string& what, double value) {
    throw std::invalid_argument("composite balance: " + what + ", got " + short_number(value));
  };
  if (!(o.frequency_min > 0.0)) refuse("frequency_min must be > 0", o.frequency_min);
  if (!(o.frequency_max > o.frequency_min && std::isfinite(o.frequency_max)))
    refuse("frequency_max must be finite and exceed frequency_min", o.frequency_max);
  if (!(o.force_min >= 0.0)) refuse("force_min must not be negative", o.force_min);
  if (!(o.force_max >= 0.0 && std::isfinite(o.force_max))) refuse("force_max must be finite, 0 or more", o.force_max);
  if (!(o.coarse_accuracy >= 1e-8 && o.coarse_accuracy <= 1e-2))
    refuse("coarse_accuracy must lie in 1e-8..1e-2", o.coarse_accuracy);
  if (!(o.accuracy >= 1e-10 && o.accuracy <= 1e-4)) refuse("accuracy must lie in 1e-10..1e-4", o.accuracy);
}

}  // namespace

/// Frequencies at which a passive N can balance: Im(1/K) <= 0, with a margin of three degrees.
std::vector<CompositeBalance::Window> CompositeBalance::windows(const CompositeSearchOptions& options) const {
  if (biased_) return {{options.frequency_min, options.frequency_max}};
  std::vector<Window> found;
  const int n = 200;
  const double ratio = std::log(options.frequency_max / options.frequency_min) / n;
  bool open = false;
  double last = options.frequency_min;
  for (int i = 0; i <= n; ++i) {
    const double w = i == n ? options.frequency_max : options.frequency_min * std::exp(ratio * i);
    const Complex N = 1.0 / rest_of_loop(w);
    const bool may = !(N.imag() > 0.05 * std::abs(N));
    if (may && !open) found.push_back({last, w});
    if (may || open) found.back().high = w;
    open = may;
    last = w;
  }
  return found;
}

/// Makes the element stop by itself where ended_early() would end the search.
void CompositeBalance::bound(const CompositeSearchOptions& options) {
  element_.stop_with([this, &options] { return element_.steps() > last_step_ || (options.stop && options.stop()); });
}

void CompositeBalance::add(double force, double frequency, int index, const CompositeSearchOptions& options,
                           CompositeSearch& found) {
  element_.stop_with(options.stop);  // a root that was found is kept at any cost
  const CompositeResponse r = solve(force, frequency, options.accuracy, false);
  bound(options);
  if (r.status != Status::converged) return;
  CompositeRoot root = describe(force, frequency, r.gain, index);
  root.bias = r.bias;
  root.sticking_fraction = r.sticking_fraction;
  found.roots.push_back(root);
}

/// True after an interruption by the caller, or too many steps: the last answer of the element is then invalid.
bool CompositeBalance::ended_early(const CompositeSearchOptions& options, CompositeSearch& found) const {
  if (options.stop && options.stop()) found.status = Status::interrupted;
  return found.status == Status::interrupted || element_.steps() > last_step_;
}

/// Below break-away |N| is that of a stiff spring, mostly far too small: true if |K N| exceeds a half anywhere. N grows
/// with the force there and changes smoothly with the frequency (the natural frequency of mass and bristles included,
/// where the samples are closer than its width).
bool CompositeBalance::may_balance_below(const Window& window, const CompositeSearchOptions& options,
                                         CompositeSearch& found) {
  const int n = std::clamp(static_cast<int>(10.0 * std::log10(window.high / window.low)), 4, 80);
  for (int i = 0; i <= n; ++i) {
    if (ended_early(options, found)) return false;
    const double w = window.low * std::pow(window.high / window.low, double(i) / n);
    for (const double share : {0.2, 1.0}) {
      const double force = side_force(share, w, false, options.coarse_accuracy);
      const CompositeResponse r = solve(force, w, options.coarse_accuracy, false);
      if (r.status != Status::converged || std::abs(r.gain * rest_of_loop(w)) > 0.5) return true;
    }
  }
  return false;
}

void CompositeBalance::search_side(const Window& window, bool above, const CompositeSearchOptions& options,
                                   CompositeSearch& found) {
  const double low = options.force_min > 0.0 ? options.force_min : 0.2 * level_;
  const double high = options.force_max > 0.0 ? options.force_max : 100.0 * level_;
  RootSearchOptions search;
  SearchBox box{low / level_, 1.0, window.low, window.high};
  if (above) box = {1.0, std::exp(std::acosh(std::max(high / level_, 1.01))), window.low, window.high};
  if (!(box.amplitude_max > box.amplitude_min * 1.001)) return;
  const double decades = std::log10(window.high / window.low);
  search.initial_cells_amplitude = above ? 8 : 4;
  search.initial_cells_frequency = std::clamp(static_cast<int>(std::ceil(4.0 * decades)), 6, 24);
  search.coarse_accuracy = options.coarse_accuracy;
  search.fine_accuracy = options.accuracy;
  search.residual = 100.0 * options.accuracy;
  search.max_evaluations = 3000;
  search.interrupted = [&] { return ended_early(options, found); };
  near_.reset();
  if (!above && !may_balance_below(window, options, found)) return;
  near_.reset();
  const auto side = find_roots(
      [&](double a, double w, double accuracy) { return (*this)(side_force(a, w, above, accuracy), w, accuracy); }, box,
      search);
  for (const Root& root : side.roots)
    add(side_force(root.amplitude, root.frequency, above, 1e-12), root.frequency, root.index, options, found);
  if (ended_early(options, found) || (side.status != Status::converged && side.status != Status::no_cycle))
    found.notes.push_back(std::string("the search ") + (above ? "above" : "below") +
                          " break-away: " + ended(ended_early(options, found) ? Status::interrupted : side.status) +
                          ", solutions may be missing");
}

/// On a belt or a ramp: searches the sheet of motions that stick in every period (see stick_slip), then that of motions
/// that slide all the time, whose velocity amplitude U/(m w) is below the mean velocity. Without a mean velocity:
/// everything.
void CompositeBalance::search_biased(const CompositeSearchOptions& options, CompositeSearch& found) {
  const double low = options.force_min > 0.0 ? options.force_min : 0.1 * level_;
  const double high = options.force_max > 0.0 ? options.force_max : 10.0 * level_;
  RootSearchOptions search;
  search.initial_cells_amplitude = 8;
  search.initial_cells_frequency =
      std::clamp(static_cast<int>(std::ceil(4.0 * std::log10(options.frequency_max / options.frequency_min))), 6, 24);
  search.coarse_accuracy = options.coarse_accuracy;
  search.fine_accuracy = options.accuracy;
  search.residual = 100.0 * options.accuracy;
  search.max_evaluations = 3000;
  search.max_border_depth = 5;
  search.interrupted = [&] { return ended_early(options, found); };
  const SearchBox box{low, high, options.frequency_min, options.frequency_max};
  const Complex undefined{std::nan(""), std::nan("")};
  const double speed = std::abs(mean_velocity_);
  near_.reset();
  const auto note = [&](const RootSearch& side, const char* what) {
    if (!ended_early(options, found) && (side.status == Status::converged || side.status == Status::no_cycle)) return;
    found.notes.push_back(std::string("the search among ") + what + ": " +
                          ended(ended_early(options, found) ? Status::interrupted : side.status) +
                          ", solutions may be missing");
  };
  if (speed == 0.0) {
    const auto all =
        find_roots([&](double U, double w, double accuracy) { return (*this)(U, w, accuracy); }, box, search);
    for (const Root& root : all.roots) add(root.amplitude, root.frequency, root.index, options, found);
    return note(all, "biased motions");
  }
  const auto sticking = find_roots(
      [&](double U, double w, double accuracy) {
        const auto s = stick_slip(U, w, accuracy);
        return s ? residue(s->gain, w) : undefined;
      },
      box, search);
  element_.stop_with(options.stop);  // see add()
  for (const Root& root : sticking.roots) {
    const auto s = stick_slip(root.amplitude, root.frequency, options.accuracy);
    if (!s) continue;
    CompositeRoot made = describe(root.amplitude, root.frequency, s->gain, root.index);
    made.bias = s->bias;
    made.sticking_fraction = s->sticking;
    made.on_break_away_front = s->share < 1.0;
    if (made.on_break_away_front)
      made.note = "lies in the leap of the mean velocity at break-away: full stick-slip would be " +
                  short_number(1.0 / s->share) +
                  " times as fast as the mean motion: a first-harmonic balance is hardly a prediction there";
    found.roots.push_back(made);
  }
  bound(options);
  note(sticking, "motions that stick");
  // Friction of constant slope makes this sheet linear: no cycle, or a family of sines.
  const bool curved = std::isfinite(loop_->elements.back().scales().velocity);
  if (!curved || ended_early(options, found)) return;
  const auto sliding = find_roots(
      [&](double a, double w, double accuracy) {
        near_.reset();
        return (*this)(a * mass_ * w, w, accuracy);
      },
      {0.01 * speed, 0.999 * speed, options.frequency_min, options.frequency_max}, search);
  for (const Root& root : sliding.roots)
    add(root.amplitude * mass_ * root.frequency, root.frequency, root.index, options, found);
  note(sliding, "motions that slide all the time");
}

CompositeSearch CompositeBalance::find(const CompositeSearchOptions& options) {
  check(options);
  if (loop_->measured.empty()) return find_between(options);
  CompositeSearch all;
  CompositeSearchOptions part = options;
  for (const SearchBox& box : within_data(*loop_, {0.0, 0.0, options.frequency_min, options.frequency_max})) {
    part.frequency_min = box.frequency_min;
    part.frequency_max = box.frequency_max;
    CompositeSearch found = find_between(part);
    part.max_steps = std::max(1L, part.max_steps - found.steps);
    std::ranges::move(found.roots, std::back_inserter(all.roots));
    std::ranges::move(found.notes, std::back_inserter(all.notes));
    all.evaluations += found.evaluations;
    all.steps += found.steps;
    const bool worse = found.status == Status::interrupted || found.status == Status::incomplete;
    if (worse || all.status == Status::no_cycle) all.status = found.status;
    if (all.status == Status::interrupted) break;
  }
  return all;
}

CompositeSearch CompositeBalance::find_between(const CompositeSearchOptions& options) {
  CompositeSearch found;
  const long evaluations = evaluations_, steps = element_.steps();
  last_step_ = steps + 2 * options.max_steps / std::max(2, 1 + loop_->elements.back().states());
  fronts_.clear();
  smooth_fronts_.clear();
  bound(options);
  if (biased_) {
    search_biased(options, found);
  } else {
    for (const Window& window : windows(options)) {
      if (!(window.high > window.low * 1.0001)) continue;
      if (!ended_early(options, found)) search_front(window, options, found);
      for (const bool above : {false, true})
        if (!ended_early(options, found)) search_side(window, above, options, found);
    }
  }
  element_.stop_with({});
  if (found.notes.empty() && ended_early(options, found))
    found.notes.push_back("the search: " + ended(Status::interrupted) + ", solutions may be missing");
  if (options.stop && options.stop()) found.status = Status::interrupted;
  std::ranges::sort(found.roots, {}, &CompositeRoot::frequency);
  found.evaluations = evaluations_ - evaluations;
  found.steps = element_.steps() - steps;
  if (found.status == Status::interrupted) return found;
  if (!found.notes.empty())
    found.status = Status::incomplete;
  else if (!found.roots.empty())
    found.status = Status::converged;
  return found;
}

}  // namespace limcycle
