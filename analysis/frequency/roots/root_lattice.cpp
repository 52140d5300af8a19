#include "limcycle/analysis/frequency/roots/root_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace limcycle {
namespace {

using Complex = std::complex<double>;

constexpr double edge_margin = 1e-9;  // relative; roots on the edge of the box are inside

const Complex undefined_value(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN());

void require_range(const char* name, double from, double to) {
  if (!(from > 0.0) || !std::isfinite(to) || !(std::log(to) - std::log(from) > 1e-6)) {
    std::ostringstream message;
    message << "root search: range of " << name << " must be positive, finite and increasing, not [" << from << ", "
            << to << "]";
    throw std::invalid_argument(message.str());
  }
}

}  // namespace

RootLattice::RootLattice(const LoopEquation& f, const SearchBox& box, const RootSearchOptions& options)
    : f_(f),
      box_(box),
      max_evaluations_(options.max_evaluations),
      stop_(options.stop),
      accuracies_{options.coarse_accuracy, std::sqrt(options.coarse_accuracy * options.fine_accuracy),
                  options.fine_accuracy},
      unit_(std::int64_t{2} << options.max_depth) {
  require_range("amplitude", box.amplitude_min, box.amplitude_max);
  require_range("frequency", box.frequency_min, box.frequency_max);
  p_lines_ = lines(box.amplitude_min, box.amplitude_max, options.initial_cells_amplitude, options.amplitude_hints);
  q_lines_ = lines(box.frequency_min, box.frequency_max, options.initial_cells_frequency, options.frequency_hints);
}

std::vector<RootLattice::Line> RootLattice::lines(double from, double to, int cells, const std::vector<double>& hints) {
  const int blocks = (cells + 1) / 2;
  const double first = std::log(from) - edge_margin, last = std::log(to) + edge_margin, step = (last - first) / blocks;
  std::vector<Line> fixed = {{first, from * (1.0 - edge_margin)}, {last, to * (1.0 + edge_margin)}};
  for (const double hint : hints) {
    if (!(hint > from && hint < to)) continue;
    const double x = std::log(hint);
    const auto near = [&](const Line& line) { return std::abs(line.coordinate - x) < 1e-6; };
    if (std::none_of(fixed.begin(), fixed.end(), near)) fixed.push_back({x, hint});
  }
  std::vector<Line> all = fixed;
  for (int k = 1; k < blocks; ++k) {
    const double x = first + k * step;
    // a hint close to a regular line takes its place
    const auto near = [&](const Line& line) { return std::abs(line.coordinate - x) < 0.35 * step; };
    if (std::none_of(fixed.begin(), fixed.end(), near)) all.push_back({x, std::exp(x)});
  }
  std::sort(all.begin(), all.end(), [](const Line& a, const Line& b) { return a.coordinate < b.coordinate; });
  return all;
}

double RootLattice::coordinate(const std::vector<Line>& lines, std::int64_t i) const {
  const auto k = static_cast<std::size_t>(i / unit_);
  const double part = static_cast<double>(i % unit_) / static_cast<double>(unit_);
  const double start = lines[k].coordinate;
  return part == 0.0 ? start : start + part * (lines[k + 1].coordinate - start);
}

double RootLattice::amplitude(double p) const {
  for (const Line& line : p_lines_) {
    if (line.coordinate == p) return line.value;
  }
  return std::exp(p);
}

double RootLattice::frequency(double q) const {
  for (const Line& line : q_lines_) {
    if (line.coordinate == q) return line.value;
  }
  return std::exp(q);
}

bool RootLattice::inside(double p, double q) const {
  return p >= p_lines_.front().coordinate && p <= p_lines_.back().coordinate && q >= q_lines_.front().coordinate &&
         q <= q_lines_.back().coordinate;
}

Complex RootLattice::equation(double p, double q, double accuracy) {
  const auto call = [&](double amplitude, double frequency) {
    if (evaluations_ >= max_evaluations_) throw RootBudgetExhausted{};
    if (stop_ && stop_()) throw RootSearchInterrupted{};
    ++evaluations_;
    const Complex value = f_(amplitude, frequency, accuracy);
    return std::isfinite(value.real()) && std::isfinite(value.imag()) ? value : undefined_value;
  };
  const double a = amplitude(p), w = frequency(q);
  const Complex value = call(a, w);
  // the margin was added by the lattice: where f ends exactly at the edge of the box, take the edge
  const double a_inside = std::clamp(a, box_.amplitude_min, box_.amplitude_max);
  const double w_inside = std::clamp(w, box_.frequency_min, box_.frequency_max);
  const bool in_margin = (a != a_inside || w != w_inside) && inside(p, q);
  return std::isnan(value.real()) && in_margin ? call(a_inside, w_inside) : value;
}

Complex RootLattice::at(double p, double q, double accuracy) {
  const Complex f = equation(p, q, accuracy);
  return f / std::hypot(1.0, std::abs(f - 1.0));
}

Complex RootLattice::sample(std::int64_t i, std::int64_t j, double accuracy) {
  const auto [entry, is_new] = known_.try_emplace({i, j}, Known{undefined_value, 0.0});
  Known& known = entry->second;
  // where f is undefined it stays undefined at any accuracy
  const bool usable = !is_new && (std::isnan(known.value.real()) || known.accuracy <= accuracy);
  if (!usable) known = {at(p(i), q(j), accuracy), accuracy};
  return known.value;
}

std::size_t RootLattice::NodeHash::operator()(const std::pair<std::int64_t, std::int64_t>& node) const {
  const auto mix = [](std::uint64_t x) {  // splitmix64 (Vigna, 2015): neighbours go to distant buckets
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
  };
  return static_cast<std::size_t>(
      mix(static_cast<std::uint64_t>(node.first) + mix(static_cast<std::uint64_t>(node.second))));
}

std::vector<double> existence_borders(RootLattice& lattice, const SearchBox& box, int cells) {
  const double q = 0.5 * (std::log(box.frequency_min) + std::log(box.frequency_max));
  const double first = std::log(box.amplitude_min), step = (std::log(box.amplitude_max) - first) / cells;
  const double accuracy = lattice.accuracies().front();
  const auto exists = [&](double p) { return !std::isnan(lattice.at(p, q, accuracy).real()); };
  std::vector<double> borders;
  double before = first;
  bool existed = exists(before);
  for (int k = 1; k <= cells; ++k) {
    const double now = first + k * step;
    const bool exists_now = exists(now);
    if (exists_now != existed) {
      double inside = exists_now ? now : before, outside = exists_now ? before : now;
      for (double middle = 0.5 * (inside + outside); middle != inside && middle != outside;
           middle = 0.5 * (inside + outside)) {
        (exists(middle) ? inside : outside) = middle;
      }
      borders.push_back(std::exp(inside));
    }
    before = now;
    existed = exists_now;
  }
  return borders;
}

}  // namespace limcycle
