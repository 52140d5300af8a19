#include "limcycle/analysis/study/experiments/velocity_run.hpp"

#include <cmath>
#include <numbers>

#include "limcycle/analysis/erased_element.hpp"
#include "limcycle/analysis/frequency/periodic_state.hpp"

namespace limcycle {
namespace {

/// Remembers every node of every panel.
class Recording {
 public:
  static constexpr bool wants_nodes = false, wants_samples = false, wants_panels = true;

  Recording(const ErasedElement<double>& law, double frequency, double band)
      : law_(law), frequency_(frequency), band_(band) {}

  void restart() {
    run = {};
    phase_ = 0.0;
  }
  template <class Panel>
  void panel(const Panel& solved, double length, Mode mode) {
    for (std::size_t i = 0; i < solved.stages(); ++i) {
      const Input<double>& in = solved.node(i).in;
      add(phase_ + solved.node_fraction(i) * length, in, law_.output(in, mode, solved.state(i)));
    }
    phase_ += length;
  }
  void switched(const MotionNode& node, double, int, const ElementState&, const ElementState& after) {
    add(phase_, node.in, law_.output(node.in, after.mode, after.z));
  }

  VelocityRun run;

 private:
  void add(double phase, const Input<double>& in, double F) {
    run.t.push_back(phase / frequency_);
    run.x.push_back(in.x);
    run.v.push_back(in.v);
    run.F.push_back(std::abs(in.v) < band_ || !std::isfinite(F) ? NAN : F);
  }

  const ErasedElement<double>& law_;
  double frequency_, band_, phase_ = 0.0;
};

/// A law without state that needs the applied force at low speeds: beyond them its force is a function of v.
VelocityRun by_points(const ErasedElement<double>& law, const PrescribedMotion& motion, const PeriodMesh& mesh,
                      double band) {
  VelocityRun run;
  double length = 0.0;
  for (const auto* part : {&mesh.first, &mesh.second})
    for (const Panel& panel : *part) {
      length += panel.to - panel.from;
      const Input<double> in = motion.at(panel.anchor, panel.to).in;
      const bool inside = std::abs(in.v) <= band;
      run.t.push_back(length / motion.frequency());
      run.x.push_back(in.x);
      run.v.push_back(in.v);
      run.F.push_back(inside ? NAN : law.output(in, law.start(in, {}), {}));
    }
  return run;
}

/// Cost grows with the cube of the number of states; the laws of one or two are drawn and read off more finely.
MeshSettings mesh_for(const ErasedElement<double>& law) {
  return law.states() <= 2 ? MeshSettings{5, 0.06, 0.05, 3} : MeshSettings{5, 0.3, 0.05, 3};
}

}  // namespace

double band_of_applied_force(const Element<double>& law) {
  return std::visit(
      [](const auto& one) {
        if constexpr (requires { one.drive_band(); }) return static_cast<double>(one.drive_band());
        return 0.0;
      },
      law);
}

VelocityRun run_velocity(const Element<double>& law, double mean, double amplitude, double frequency, int periods) {
  const PrescribedMotion motion(amplitude / frequency, frequency, mean, true);
  const ErasedElement<double> erased(law);
  const MeshSettings settings = mesh_for(erased);
  const PeriodMesh mesh = graded_mesh(motion, erased.scales(), settings);
  const double band = band_of_applied_force(law);
  if (band > 0.0 && erased.states() == 0 && std::abs(mean) - amplitude < band)
    return by_points(erased, motion, mesh, band);
  Recording recording(erased, frequency, band);
  {
    ElementMarch<ErasedElement> march(erased, motion, settings.stages);
    PeriodicStateSearch<ErasedElement> search(march, mesh, false, 1e-8);
    const PeriodicState found = search.find(recording, nullptr);
    recording.run.status = found.status;
    // Where the march itself cannot go on, more periods do not help.
    if (found.status != Status::max_iterations && found.status != Status::incomplete) return recording.run;
  }
  ElementMarch<ErasedElement> march(erased, motion, settings.stages);
  ElementState state = march.virgin();
  NoVisitor nothing;
  Status status = march.march(mesh.virgin, state, nothing);
  for (int k = 0; k < periods && status == Status::converged; ++k) {
    recording.restart();
    status = march.march(mesh.first, state, recording);
    if (status == Status::converged) status = march.march(mesh.second, state, recording);
  }
  recording.run.status = status == Status::converged ? Status::incomplete : status;
  return recording.run;
}

VelocityRun run_constant_velocity(const Element<double>& law, double velocity, double duration) {
  const PrescribedMotion motion(0.0, 1.0, velocity, true);  // phase is time
  const ErasedElement<double> erased(law);
  ElementMarch<ErasedElement> march(erased, motion, mesh_for(erased).stages);
  ElementState state = march.virgin();
  std::vector<Panel> panels;
  const Scales scales = erased.scales();
  const double shortest = std::min(1e-3 * duration, 0.05 * scales.displacement / std::abs(velocity));
  for (double from = 0.0, to = std::max(shortest, 1e-9 * duration); from < duration;
       to = std::min(1.3 * to, duration)) {
    panels.push_back({0, from, to});
    from = to;
  }
  Recording recording(erased, 1.0, band_of_applied_force(law));
  recording.run.status = march.march(panels, state, recording);
  return recording.run;
}

double VelocityRun::force_at(double velocity, bool accelerating) const {
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double a = v[i - 1], b = v[i];
    if ((b > a) != accelerating || a == b || t[i] <= t[i - 1]) continue;
    if ((velocity - a) * (velocity - b) > 0.0) continue;
    return F[i - 1] + (F[i] - F[i - 1]) * (velocity - a) / (b - a);
  }
  return NAN;
}

}  // namespace limcycle
