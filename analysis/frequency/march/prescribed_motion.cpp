#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limcycle {

namespace {

using std::numbers::pi;

/// Ends of panels on [0, length], graded towards 0 with the first at `cap`.
std::vector<double> graded_ends(double length, double cap, double growth, double widest) {
  std::vector<double> ends{0.0};
  const double factor = std::exp(growth);
  double at = std::min({cap, widest, length});
  while (at < length) {
    ends.push_back(at);
    at = std::min(at * factor, at + widest);
  }
  // A sliver does not deserve its own panel.
  if (ends.size() > 1 && length - ends.back() < 0.3 * (ends.back() - ends[ends.size() - 2])) ends.pop_back();
  ends.push_back(length);
  return ends;
}

/// Uniform panels over one stretch that begins at `begin` (from the origin of the period).
void append_uniform(std::vector<Panel>& panels, int left, int right, double begin, double length, int samples) {
  const double step = 2.0 * pi / samples, tiny = 1e-9 * step;
  double from = begin;
  auto next = static_cast<long>(std::floor((begin + tiny) / step)) + 1;
  const double end = begin + length;
  while (from < end - tiny) {
    const double sample = static_cast<double>(next) * step;
    const bool at_sample = sample <= end + tiny;
    const double to = std::abs(sample - end) <= tiny || !at_sample ? end : sample;
    const bool early = 0.5 * (from + to) - begin < 0.5 * length;
    const double shift = early ? begin : end;
    panels.push_back({early ? left : right, from - shift, to - shift, at_sample});
    if (at_sample) ++next;
    from = to;
  }
}

}  // namespace

PrescribedMotion::PrescribedMotion(double amplitude, double frequency, double bias, bool bias_is_rate)
    : amplitude_(amplitude),
      frequency_(frequency),
      offset_(bias_is_rate ? 0.0 : bias),
      drift_(bias_is_rate ? bias : 0.0) {
  const double peak = amplitude * frequency, ratio = drift_ / peak;
  reverses_ = std::abs(ratio) < 1.0;
  anchors_[0] = {0.0, 0.0, 1.0, drift_ + peak};
  if (reverses_) {
    const double sine = std::sqrt((1.0 - ratio) * (1.0 + ratio)), phase = std::acos(-ratio);
    first_length_ = 2.0 * std::acos(ratio);
    second_length_ = 2.0 * phase;
    anchors_[1] = {phase, sine, -ratio, 0.0};
    anchors_[2] = {2.0 * pi - phase, -sine, -ratio, 0.0};
  } else {
    first_length_ = 2.0 * pi;
    second_length_ = 0.0;
    const double side =
        ratio > 0.0 ? 1.0 : -1.0;  // least speed at phase pi for a forward drift, at 0 for a backward one
    anchors_[1] = {ratio > 0.0 ? pi : 0.0, 0.0, -side, drift_ - side * peak};
    anchors_[2] = anchors_[1];
  }
  anchors_[3] = anchors_[1];
  anchors_[3].phase += 2.0 * pi;
}

MotionNode PrescribedMotion::at(int anchor, double local) const {
  const Anchor& a = anchors_[index(anchor)];
  const double half_sine = std::sin(0.5 * local), half_cosine = std::cos(0.5 * local);
  const double sine = 2.0 * half_sine * half_cosine, versine = 2.0 * half_sine * half_sine;
  MotionNode node;
  node.sine = a.sine - a.sine * versine + a.cosine * sine;
  node.cosine = a.cosine - a.cosine * versine - a.sine * sine;
  node.in.v = a.rate - 2.0 * amplitude_ * frequency_ * half_sine * (a.sine * half_cosine + a.cosine * half_sine);
  node.in.x = offset_ + amplitude_ * node.sine + (drift_ == 0.0 ? 0.0 : drift_ * (a.phase + local) / frequency_);
  node.in.drive = std::copysign(infinite, node.in.v);
  node.slope = -amplitude_ * frequency_ * node.sine;
  return node;
}

std::vector<double> PrescribedMotion::positions_of_rate(double rate) const {
  const double cosine = (rate - drift_) / (amplitude_ * frequency_);
  if (!(std::abs(cosine) < 1.0)) return {};
  std::vector<double> positions;
  for (const double phase : {std::acos(cosine), -std::acos(cosine)})
    positions.push_back(phase - origin() - 2.0 * pi * std::floor((phase - origin()) / (2.0 * pi)));
  return positions;
}

double PrescribedMotion::layer(int anchor, const Scales& scales) const {
  const Anchor& a = anchors_[index(anchor)];
  const double peak = amplitude_ * frequency_, slope = std::abs(a.sine);
  double width = std::min({scales.velocity / (peak * slope), std::sqrt(2.0 * scales.velocity / peak),
                           std::sqrt(2.0 * scales.displacement / (amplitude_ * slope)),
                           std::cbrt(6.0 * scales.displacement / amplitude_)});
  if (a.rate != 0.0) width = std::min(width, scales.displacement * frequency_ / std::abs(a.rate));
  return std::max(width, 1e-14);
}

void append_graded(std::vector<Panel>& panels, int left, int right, double length, double cap_left, double cap_right,
                   const MeshSettings& settings) {
  const double widest = settings.growth * std::min(1.0, 3.0 / settings.harmonics);
  const auto rising = graded_ends(0.5 * length, cap_left, settings.growth, widest);
  const auto falling = graded_ends(0.5 * length, cap_right, settings.growth, widest);
  for (std::size_t i = 1; i < rising.size(); ++i) panels.push_back({left, rising[i - 1], rising[i]});
  for (std::size_t i = falling.size() - 1; i >= 1; --i) panels.push_back({right, -falling[i], -falling[i - 1]});
}

PeriodMesh graded_mesh(const PrescribedMotion& motion, const Scales& scales, const MeshSettings& settings) {
  PeriodMesh mesh;
  const double cap1 = settings.cap * motion.layer(1, scales), cap2 = settings.cap * motion.layer(2, scales);
  if (motion.origin() > 0.0) append_graded(mesh.virgin, 0, 1, motion.origin(), infinite, cap1, settings);
  append_graded(mesh.first, 1, motion.reverses() ? 2 : 3, motion.first_length(), cap1, cap2, settings);
  if (motion.reverses()) append_graded(mesh.second, 2, 3, motion.second_length(), cap2, cap1, settings);
  return mesh;
}

void split_at_speeds(PeriodMesh& mesh, const PrescribedMotion& motion, const std::vector<double>& speeds) {
  std::vector<double> positions;
  for (const double speed : speeds)
    for (const double rate : {speed, -speed})
      for (const double position : motion.positions_of_rate(rate)) {
        positions.push_back(position);
        positions.push_back(position - 2.0 * pi);  // on the way to the period from phase 0
      }
  std::ranges::sort(positions);
  for (auto* panels : {&mesh.virgin, &mesh.first, &mesh.second}) {
    std::vector<Panel> split;
    for (Panel panel : *panels) {
      const double sliver = 1e-6 * (panel.to - panel.from), begin = motion.position(panel.anchor, panel.from);
      const double shift = panel.from - begin;
      const double end = panel.to - shift;
      for (auto at = std::ranges::upper_bound(positions, begin + sliver); at != positions.end() && *at < end - sliver;
           ++at) {
        if (*at + shift - panel.from <= sliver) continue;
        split.push_back({panel.anchor, panel.from, *at + shift});
        panel.from = *at + shift;
      }
      split.push_back(panel);
    }
    *panels = std::move(split);
  }
}

PeriodMesh uniform_mesh(const PrescribedMotion& motion, int samples) {
  PeriodMesh mesh;
  append_uniform(mesh.virgin, 0, 1, 0.0, motion.origin(), samples);
  for (Panel& panel : mesh.virgin) panel.sample_at_end = false;
  append_uniform(mesh.first, 1, motion.reverses() ? 2 : 3, 0.0, motion.first_length(), samples);
  if (motion.reverses()) append_uniform(mesh.second, 2, 3, motion.first_length(), motion.second_length(), samples);
  return mesh;
}

}  // namespace limcycle
