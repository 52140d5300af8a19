#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"

#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/march/periodic_state.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {
namespace {

/// Records every node of every panel.
class Recording {
 public:
  static constexpr bool wants_nodes = false, wants_samples = false, wants_panels = true;

  Recording(const Element& law, double frequency, double band) : law_(law), frequency_(frequency), band_(band) {}

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

  const Element& law_;
  double frequency_, band_, phase_ = 0.0;
};

/// A law without state that needs the applied force at low speeds: beyond them its force is a function of v.
VelocityRun by_points(const Element& law, const PrescribedMotion& motion, const PeriodMesh& mesh, double band) {
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

/// Cost grows with the cube of the number of states; laws of one or two get a finer mesh.
MeshSettings mesh_for(const Element& law) {
  return law.states() <= 2 ? MeshSettings{5, 0.06, 0.05, 3} : MeshSettings{5, 0.3, 0.05, 3};
}

}  // namespace

VelocityRun run_velocity(const Element& law, double mean, double amplitude, double frequency, int periods) {
  const PrescribedMotion motion(amplitude / frequency, frequency, mean, true);
  const MeshSettings settings = mesh_for(law);
  const PeriodMesh mesh = graded_mesh(motion, law.scales(), settings);
  const double band = law.drive_band();
  if (band > 0.0 && law.states() == 0 && std::abs(mean) - amplitude < band) return by_points(law, motion, mesh, band);
  Recording recording(law, frequency, band);
  {
    ElementMarch<> march(law, motion, settings.stages);
    PeriodicStateSearch<> search(march, mesh, false, 1e-8);
    const PeriodicState found = search.find(recording, nullptr);
    recording.run.status = found.status;
    // If the march itself cannot continue, more periods do not help.
    if (found.status != Status::max_iterations && found.status != Status::incomplete) return recording.run;
  }
  ElementMarch<> march(law, motion, settings.stages);
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

VelocityRun run_constant_velocity(const Element& law, double velocity, double duration) {
  const PrescribedMotion motion(0.0, 1.0, velocity, true);  // phase is time
  ElementMarch<> march(law, motion, mesh_for(law).stages);
  ElementState state = march.virgin();
  std::vector<Panel> panels;
  const Scales scales = law.scales();
  const double shortest = std::min(1e-3 * duration, 0.05 * scales.displacement / std::abs(velocity));
  for (double from = 0.0, to = std::max(shortest, 1e-9 * duration); from < duration;
       to = std::min(1.3 * to, duration)) {
    panels.push_back({0, from, to});
    from = to;
  }
  Recording recording(law, 1.0, law.drive_band());
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
