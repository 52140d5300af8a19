#include "limcycle/analysis/frequency/kernels/gms_period.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "limcycle/analysis/illinois.hpp"

namespace limcycle {
namespace {

constexpr double reached = 1e-12;  ///< an excess over the level by this share of it is none

}  // namespace

std::optional<GmsPeriod> GmsPeriod::of(const Element& element) {
  if (!element.odd()) return std::nullopt;
  if (const auto* law = element.as<Gms<double>>()) return GmsPeriod(*law);
  if (const auto* law = element.as<GmsTable<double>>()) return GmsPeriod(*law);
  return std::nullopt;
}

double GmsPeriod::level(double v) const {
  ++evaluations_;
  return std::visit([&](const auto& law) { return law.level(std::abs(v), true); }, law_);
}

/// The way of the first quarter is x itself; that from a reversal is twice the square of the sine of half the phase
/// since then, which keeps all digits.
GmsPeriod::Node GmsPeriod::node_at(const Panel& panel, double t, double side) const {
  const double local = t == 1.0 ? panel.to : panel.from + t * (panel.to - panel.from);
  Node node;
  node.motion = motion_->at(panel.anchor, local);
  node.level = level(node.motion.in.v);
  if (side > 0.0) {
    node.way = node.motion.in.x;
  } else {
    const double sine = std::sin(0.5 * (panel.anchor == 1 ? local : motion_->position(panel.anchor, local)));
    node.way = -2.0 * motion_->amplitude() * sine * sine;
  }
  return node;
}

/// Slip from the part `from` of a panel to its end.
std::vector<GmsPeriod::Node> GmsPeriod::slide(const Panel& panel, double from, double side) const {
  const auto count = static_cast<std::size_t>(table_->stages);
  const double width = (1.0 - from) * (panel.to - panel.from);
  std::vector<Node> nodes;
  nodes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    nodes.push_back(node_at(panel, i + 1 == count ? 1.0 : from + table_->c[i] * (1.0 - from), side));
    nodes.back().weight = table_->b[i] * width;
  }
  with_stages(table_->stages, [&]<int S> {
    solve_linear_panel<S>(
        *table_, width / motion_->frequency(), {},
        [&](std::size_t i) {
          return LinearRate<double>{C_ * side, C_ / nodes[i].level};
        },
        [&](std::size_t i, const LinearPair& pair) { nodes[i].pair = pair; });
  });
  return nodes;
}

void GmsPeriod::prepare(Stretch& stretch, double side) {
  stretch.side = side;
  stretch.nodes.clear();
  for (const Panel& panel : stretch.panels)
    std::ranges::copy(slide(panel, 0.0, side), std::back_inserter(stretch.nodes));
  const std::size_t count = stretch.panels.size(), stages = static_cast<std::size_t>(table_->stages);
  stretch.rest.assign(count + 1, {});
  for (std::size_t j = count; j-- > 0;) {
    const LinearPair &own = stretch.nodes[(j + 1) * stages - 1].pair, &after = stretch.rest[j + 1];
    stretch.rest[j] = {after.from(own.particular), after.homogeneous * own.homogeneous};
  }
}

/// Where an element that begins the stretch with r = start meets the level, stretched in either direction. One that is
/// stretched to the level at a reversal may leave it at once, in a part of the first panel that is as short as the
/// level is steep: there it is looked for at shorter and shorter distances.
std::optional<GmsPeriod::Passage> GmsPeriod::switched(const Stretch& stretch, double start, double stiffness) const {
  constexpr int shortest = 10;  // as a power of ten of the panel
  constexpr double full = 0.999;
  const auto stages = static_cast<std::size_t>(table_->stages);
  const auto beyond = [&](const Node& node) { return node.left(start, stiffness) < -reached * node.level; };
  const Panel& first = stretch.panels.front();
  if (std::abs(start) >= full * Fs_)
    for (int power = shortest; power > 0; --power) {
      const double part = std::pow(10.0, -power);
      if (beyond(node_at(first, part, stretch.side))) return met(stretch, 0, 0.1 * part, part, start, stiffness);
    }
  for (std::size_t n = 0; n < stretch.nodes.size(); ++n)
    if (beyond(stretch.nodes[n])) {
      const std::size_t stage = n % stages;
      return met(stretch, n / stages, stage == 0 ? 0.0 : table_->c[stage - 1], table_->c[stage], start, stiffness);
    }
  return std::nullopt;
}

/// The switch between two parts of a panel; the first of them, if it is beyond the level already.
GmsPeriod::Passage GmsPeriod::met(const Stretch& stretch, std::size_t panel, double from, double to, double start,
                                  double stiffness) const {
  const auto left = [&](double part) -> std::optional<double> {
    return node_at(stretch.panels[panel], part, stretch.side).left(start, stiffness);
  };
  const double before = *left(from), after = *left(to);
  Passage passage;
  passage.panel = panel;
  passage.part = before > 0.0 && after < 0.0 ? falling_zero(left, from, before, to, after, 0.0) : from;
  const Node node = node_at(stretch.panels[panel], passage.part, stretch.side);
  passage.at_switch = std::copysign(node.level, start + stiffness * node.way);
  return passage;
}

GmsPeriod::Passage GmsPeriod::pass(const Stretch& stretch, double start, double stiffness) const {
  auto passage = switched(stretch, start, stiffness);
  if (!passage) return {.end = start + stiffness * stretch.nodes.back().way, .panel = stretch.panels.size()};
  passage->at_next =
      passage->part < 1.0
          ? slide(stretch.panels[passage->panel], passage->part, stretch.side).back().pair.from(passage->at_switch)
          : passage->at_switch;
  passage->end = stretch.rest[passage->panel + 1].from(passage->at_next);
  return *passage;
}

/// r at the reversal of an element of this k_i/alpha_i: r = -(r half a period later). The map from the state that an
/// element without history has there, and secants of it where they help.
std::optional<GmsPeriod::Periodic> GmsPeriod::periodic(double stiffness) const {
  constexpr int most = 100;
  constexpr double wanted = 4e-15, enough = 1e-12;
  double r = pass(virgin_, 0.0, stiffness).end, last_r = 0.0, last_move = infinite;
  for (int k = 0; k < most; ++k) {
    const double image = -pass(half_, r, stiffness).end, move = image - r;
    if (!std::isfinite(move)) return std::nullopt;
    const bool gained = std::abs(move) < 0.5 * std::abs(last_move);
    if (std::abs(move) <= wanted * Fs_ || (std::abs(move) <= enough * Fs_ && !gained))
      return Periodic{r, std::abs(move)};
    const double slope = (move - last_move) / (r - last_r);
    last_move = move;
    const double secant = r - move / slope;
    // The map of a sound law contracts: its slope lies between -1 and 1, that of `move` between -2 and 0.
    const bool sound = k > 0 && slope < 0.0 && slope > -2.0 && std::isfinite(secant) && std::abs(secant) <= highest_;
    last_r = std::exchange(r, sound && k % 4 != 0 ? secant : image);
  }
  return std::nullopt;
}

double GmsPeriod::output(std::size_t i, const Node& node, double r, bool slips) const {
  const double rate = slips ? C_ * alpha_[i] * (half_.side - r / node.level) : k_[i] * node.motion.in.v;
  return alpha_[i] * r + sigma1_[i] / k_[i] * rate;
}

/// Adds one element to the outputs at the nodes; those of the panel of its switch go into the sums at once. Returns the
/// largest |r|.
double GmsPeriod::integrate(std::size_t i, double start, HarmonicSums& sums) {
  const double stiffness = k_[i] / alpha_[i];
  const auto stages = static_cast<std::size_t>(table_->stages);
  const Passage passage = pass(half_, start, stiffness);
  double peak = std::abs(start), r = passage.at_next;
  const auto stick = [&](const Node& node) { return start + stiffness * node.way; };
  for (std::size_t n = 0; n < half_.nodes.size(); ++n) {
    const std::size_t panel = n / stages;
    if (panel == passage.panel) continue;
    const bool slips = panel > passage.panel;
    const double here = slips ? half_.nodes[n].pair.from(r) : stick(half_.nodes[n]);
    outputs_[n] += output(i, half_.nodes[n], here, slips);
    peak = std::max(peak, std::abs(here));
    if (slips && (n + 1) % stages == 0) r = here;
  }
  if (passage.panel == half_.panels.size()) return peak;
  const Panel& panel = half_.panels[passage.panel];
  for (std::size_t s = 0; s < stages && passage.part > 0.0; ++s) {
    const Node node = node_at(panel, passage.part * table_->c[s], half_.side);
    const double weight = table_->b[s] * passage.part * (panel.to - panel.from);
    sums.node(node.motion, weight, output(i, node, stick(node), false));
  }
  if (passage.part < 1.0)
    for (const Node& node : slide(panel, passage.part, half_.side))
      sums.node(node.motion, node.weight, output(i, node, node.pair.from(passage.at_switch), true));
  return std::max(peak, std::abs(passage.at_switch));
}

std::optional<PeriodicState> GmsPeriod::find(const PrescribedMotion& motion, const PeriodMesh& mesh, int stages,
                                             HarmonicSums& sums) {
  evaluations_ = 0;
  motion_ = &motion;
  table_ = &radau_iia(stages);
  virgin_.panels = mesh.virgin;
  half_.panels = mesh.first;
  prepare(virgin_, 1.0);
  prepare(half_, -1.0);
  outputs_.assign(half_.nodes.size(), 0.0);
  PeriodicState found;
  found.symmetric = true;
  double peak = 0.0;
  for (std::size_t i = 0; i < k_.size(); ++i) {
    const auto own = periodic(k_[i] / alpha_[i]);
    if (!own) return std::nullopt;
    const double largest = integrate(i, own->start, sums);
    found.state.z.push_back(alpha_[i] * own->start);
    found.scale.push_back(alpha_[i] * std::min(Fs_, largest));
    found.defect = std::max(found.defect, own->defect / std::min(Fs_, largest) + 1e-15);
    peak = std::max(peak, largest);
  }
  for (std::size_t n = 0; n < half_.nodes.size(); ++n) {
    const Node& node = half_.nodes[n];
    sums.node(node.motion, node.weight, outputs_[n] + sigma2_ * node.motion.in.v);
  }
  return std::isfinite(peak) ? std::optional(std::move(found)) : std::nullopt;
}

}  // namespace limcycle
