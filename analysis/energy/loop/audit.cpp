#include "limcycle/analysis/energy/loop/audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using D = Dual<1>;

/// Gauss's formula on [0, 1] (Abramowitz and Stegun, 25.4.30 and table 25.4).
struct Node {
  double at, weight;
};
constexpr std::array<Node, 5> gauss{{{0.046910077030668004, 0.11846344252809454},
                                     {0.23076534494715845, 0.23931433524968324},
                                     {0.5, 0.28444444444444444},
                                     {0.76923465505284155, 0.23931433524968324},
                                     {0.95308992296933200, 0.11846344252809454}}};

struct Stored {
  double kinetic = 0.0, potential = 0.0, friction = 0.0;
  double all() const { return kinetic + potential + friction; }
};

/// W, all at one instant.
struct Powers {
  double command = 0.0, load = 0.0, drive = 0.0, rubbing = 0.0, viscous = 0.0, storing = 0.0;
};

std::optional<std::size_t> port_named(const Loop& loop, std::string_view path) {
  for (std::size_t i = 0; i < loop.ports.size(); ++i)
    if (loop.ports[i].path == path) return i;
  return std::nullopt;
}

VectorXd zero_if_empty(const VectorXd& origin, Index states) {
  return origin.size() > 0 ? VectorXd(origin.head(states)) : VectorXd(VectorXd::Zero(states));
}

}  // namespace

class EnergyAudit::Count {
 public:
  Count(const LoopParts& parts, const Loop& loop, double rtol)
      : plant_(model_of(parts.plant)),
        energy_(energy_of(parts.plant)),
        weights_(loop_weights(loop, rtol)),
        origin_(zero_if_empty(loop.origin, plant_.A.rows())),
        origin_rate_(zero_if_empty(loop.origin_rate, plant_.A.rows())),
        constant_load_(loop.external_origin(external_force)),
        friction_(port_named(loop, "loop.friction")),
        gravity_(port_named(loop, "loop.plant.gravity")),
        commanded_(uses_error(parts) || actuator_of(parts.controller).friction_compensation > 0.0) {
    balance_.of_plant = energy_.has_value();
    balance_.of_friction = friction_.has_value();
    if (!friction_) return;
    law_ = loop.elements[*friction_].on<D>();
    balance_.of_storage = law_->has_storage();
  }

  void step(LoopField& field, March& march, const std::vector<Mode>& modes) {
    const Step& last = march.last();
    const std::vector<Mode> after = std::exchange(field.modes(), modes);
    if (!begun_) {
      first_ = stored(field, last.x0, last.t0);
      balance_.turnover = std::abs(first_.all());
      begun_ = true;
    }
    if (last.t1 > last.t0) integrate(field, march);
    const Stored before_switch = stored(field, last.x1, last.t1);
    allow(field, last.x1, last.t1);
    field.modes() = after;
    const Stored now = last.switched ? stored(field, march.x(), march.t()) : before_switch;
    balance_.impulses += before_switch.all() - now.all();
    balance_.kinetic = now.kinetic - first_.kinetic;
    balance_.potential = now.potential - first_.potential;
    balance_.in_friction = now.friction - first_.friction;
  }

  const EnergyBalance& balance() const { return balance_; }

 private:
  VectorXd plant_state(const State& x, double t) const {
    return Eigen::Map<const VectorXd>(x.data(), origin_.size()) + origin_ + origin_rate_ * t;
  }

  /// The law's states as dual numbers, with the given derivatives.
  std::span<const D> seeded(const LoopField& field, const State& x, const double* derivatives) {
    const std::size_t first = field.first_state(*friction_);
    z_.resize(static_cast<std::size_t>(law_->states()));
    for (std::size_t k = 0; k < z_.size(); ++k) {
      z_[k] = D(x[first + k]);
      z_[k].d[0] = derivatives[first + k];
    }
    return z_;
  }

  D in_law(const LoopField& field, const State& x, const double* derivatives) {
    if (!balance_.of_storage) return {};
    return law_->storage(field.modes()[*friction_], seeded(field, x, derivatives));
  }

  Stored stored(LoopField& field, const State& x, double t) {
    Stored sum;
    zero_.assign(x.size(), 0.0);
    sum.friction = in_law(field, x, zero_.data()).value;
    if (!energy_) return sum;
    const VectorXd X = plant_state(x, t);
    sum.kinetic = 0.5 * X.dot(energy_->kinetic * X);
    sum.potential = 0.5 * X.dot(energy_->springs * X);
    if (plant_.gravity) sum.potential += weight() * (1.0 - std::cos(angle(X)));
    return sum;
  }

  double weight() const { return plant_.gravity->mass * plant_.gravity->gravity * plant_.gravity->arm; }
  double angle(const VectorXd& X) const { return plant_.C_gravity.dot(X); }

  Powers powers(LoopField& field, const State& x, double t) {
    Powers sum;
    field.rate(x, dx_, t);
    if (friction_) sum.rubbing = field.output(*friction_) * field.input(*friction_).v;
    sum.storing = in_law(field, x, dx_.data()).d[0];
    if (!energy_) return sum;
    const VectorXd X = plant_state(x, t);
    VectorXd acted = Eigen::Map<const VectorXd>(dx_.data(), X.size()) + origin_rate_ - plant_.A * X;
    if (friction_) acted += plant_.B_F * field.output(*friction_);
    if (gravity_) acted += plant_.B_gravity * field.output(*gravity_);
    const double input = plant_.B_u.dot(acted) / plant_.B_u.squaredNorm();
    const double load = constant_load_ + field.external()(external_force);
    const double velocity = plant_.B_u.dot(energy_->kinetic * X);  // the velocity conjugate to the input
    if (commanded_) sum.command = (input - load) * velocity;       // else rounding
    if (energy_->motor.size() > 0) sum.command += X.dot(energy_->motor * X);
    sum.load = load * velocity;
    if (friction_) sum.drive = field.output(*friction_) * plant_.v0;
    sum.viscous = X.dot(energy_->dampers * X);
    return sum;
  }

  void integrate(LoopField& field, March& march) {
    const double t0 = march.last().t0, h = march.last().t1 - t0;
    for (const auto& [at, weight] : gauss) {
      march.within(at, x_);
      const Powers p = powers(field, x_, t0 + at * h);
      const double dt = weight * h;
      balance_.command += dt * p.command;
      balance_.load += dt * p.load;
      balance_.drive += dt * p.drive;
      balance_.rubbing += dt * p.rubbing;
      balance_.viscous += dt * p.viscous;
      balance_.friction += dt * (p.rubbing - p.storing);
      const double work = energy_ ? std::abs(p.command) + std::abs(p.load) + std::abs(p.drive) : std::abs(p.rubbing);
      balance_.turnover += dt * work;
    }
  }

  /// Adds the error that the tolerances permit in the energy at the end of a step; rounding of the sums is added as
  /// that of a random walk.
  void allow(LoopField& field, const State& x, double t) {
    State tolerance(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) tolerance[i] = weights_.atol[i] + weights_.rtol * std::abs(x[i]);
    worst_ += std::abs(in_law(field, x, tolerance.data()).d[0]);
    if (energy_) {
      const VectorXd X = plant_state(x, t);
      VectorXd gradient = energy_->kinetic * X + energy_->springs * X;
      if (plant_.gravity) gradient += plant_.C_gravity.transpose() * weight() * std::sin(angle(X));
      worst_ += gradient.cwiseAbs().dot(Eigen::Map<const VectorXd>(tolerance.data(), X.size()));
    }
    terms_ += gauss.size();
    const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(terms_));
    balance_.allowed = std::min(worst_, 100.0 * weights_.rtol * balance_.turnover) + rounding * balance_.turnover;
  }

  PlantModel plant_;
  std::optional<PlantEnergy> energy_;
  ErrorWeights weights_;
  VectorXd origin_, origin_rate_;
  double constant_load_;
  std::optional<std::size_t> friction_, gravity_;
  bool commanded_;
  std::optional<ElementOn<D>> law_;
  EnergyBalance balance_;
  Stored first_;
  bool begun_ = false;
  double worst_ = 0.0;     ///< sum of the errors that the tolerances permit at the end of each step
  std::size_t terms_ = 0;  ///< of the sums
  State x_, dx_, zero_;
  std::vector<D> z_;
};

EnergyAudit::EnergyAudit(const LoopParts& parts, const Loop& loop, double rtol)
    : count_(std::make_unique<Count>(parts, loop, rtol)) {}
EnergyAudit::~EnergyAudit() = default;
EnergyAudit::EnergyAudit(EnergyAudit&&) noexcept = default;

void EnergyAudit::step(LoopField& field, March& march, const std::vector<Mode>& modes) {
  count_->step(field, march, modes);
}

const EnergyBalance& EnergyAudit::balance() const { return count_->balance(); }

bool has_energy(const LoopParts& parts) {
  return !parts.diagram && !sampling_of(parts.controller).is_on() && (parts.friction || energy_of(parts.plant));
}

}  // namespace limcycle
