#include "limcycle/analysis/energy/passivity/reference_march.hpp"

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limcycle {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::vector<double>;  // the law's state over its scales, then the energy supplied over its scale

/// A part of the input in which v is linear and keeps its sign; time counts from its beginning, so that a short piece
/// late in a long period loses no digits.
struct Piece {
  double duration, v, slope, drive;
};

std::vector<Piece> odeint_pieces(const VelocityCycle& input) {
  if (input.time.size() < 2 || input.time.size() != input.velocity.size() || !(input.period() > 0.0))
    throw std::invalid_argument("a velocity cycle needs two points or more and a positive period");
  std::vector<Piece> pieces;
  const auto add = [&](double duration, double v, double slope) {
    if (duration > 0.0) pieces.push_back({duration, v, slope, 0.0});
  };
  for (std::size_t i = 0; i + 1 < input.time.size(); ++i) {
    const double T = input.time[i + 1] - input.time[i], v = input.velocity[i], w = input.velocity[i + 1];
    if (!(T >= 0.0)) throw std::invalid_argument("the times of a velocity cycle must not fall");
    const double slope = T > 0.0 ? (w - v) / T : 0.0;
    if (v * w < 0.0) {
      const double part = T * (v / (v - w));
      add(part, v, slope);
      add(T - part, 0.0, slope);
    } else {
      add(T, v, slope);
    }
  }
  // The sign of dv/dt; at constant v that of v; at rest that of the following motion.
  double coming = 1.0;
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = pieces.size(); i-- > 0;) {
      Piece& piece = pieces[i];
      const double sense = piece.slope != 0.0 ? piece.slope : piece.v;
      if (sense != 0.0) coming = sense;
      piece.drive = std::copysign(infinite, coming);
    }
  return pieces;
}

class Run {
 public:
  Run(const Element& law, const ReferenceMarchOptions& options, State z, Mode mode)
      : law_(law), options_(options), z_(std::move(z)) {
    const auto n = static_cast<std::size_t>(law.states());
    if (z_.size() != n) throw std::invalid_argument("the state has " + std::to_string(z_.size()) + " numbers");
    for (std::size_t i = 0; i < n; ++i) scale_.push_back(law.state_scale(static_cast<int>(i)));
    const double way = law.scales().displacement;
    energy_scale_ = law.scales().output * (std::isfinite(way) ? way : 1.0);
    y_.assign(n + 1, 0.0);
    for (std::size_t i = 0; i < n; ++i) y_[i] = z_[i] / scale_[i];
    result_.mode = mode;
    dz_.assign(n, 0.0);
  }

  ReferenceMarch through(const std::vector<Piece>& pieces, int cycles) {
    for (int cycle = 0; cycle < cycles && result_.status == Status::converged; ++cycle) {
      for (const Piece& piece : pieces)
        if (result_.status == Status::converged) result_.status = through(piece);
      if (result_.status == Status::converged) result_.taken.push_back(-y_.back() * energy_scale_);
    }
    unscale(y_);
    result_.z = z_;
    result_.supplied = y_.back() * energy_scale_;
    return std::move(result_);
  }

 private:
  using Plain = odeint::runge_kutta_fehlberg78<State>;

  void unscale(const State& y) {
    for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = y[i] * scale_[i];
  }
  Input<double> at(const Piece& piece, double t) const {
    return {x_ + t * (piece.v + 0.5 * piece.slope * t), piece.v + piece.slope * t, piece.drive};
  }
  auto field(const Piece& piece) {
    return [this, &piece](const State& y, State& dy, double t) {
      unscale(y);
      const Input<double> in = at(piece, t);
      law_.rate(in, result_.mode, z_, dz_);
      for (std::size_t i = 0; i < z_.size(); ++i) dy[i] = dz_[i] / scale_[i];
      dy.back() = law_.output(in, result_.mode, z_) * in.v / energy_scale_;
    };
  }
  void show(const Piece& piece, double t) {
    if (!options_.watch) return;
    unscale(y_);
    options_.watch(at(piece, t), result_.mode, z_);
  }
  /// The first negative guard, or -1.
  int fired(const Piece& piece, double t, const State& y) {
    guards_.assign(static_cast<std::size_t>(law_.guards(result_.mode)), 0.0);
    if (guards_.empty()) return -1;
    unscale(y);
    law_.guard(at(piece, t), result_.mode, z_, guards_);
    for (std::size_t k = 0; k < guards_.size(); ++k)
      if (guards_[k] < 0.0) return static_cast<int>(k);
    return -1;
  }
  void switch_mode(const Piece& piece, double t, int guard) {
    unscale(y_);
    result_.mode = law_.next(at(piece, t), result_.mode, z_, guard);
    for (std::size_t i = 0; i < z_.size(); ++i) y_[i] = z_[i] / scale_[i];
  }
  /// Switches until no guard is negative.
  bool settle(const Piece& piece, double t) {
    for (int k = 0; k < 200; ++k) {
      const int guard = fired(piece, t, y_);
      if (guard < 0) return true;
      switch_mode(piece, t, guard);
    }
    return false;
  }

  /// A jump of the velocity passes v = 0 in its own direction, whatever the slope of the piece that follows.
  bool begin(const Piece& piece) {
    const double jump = begun_ ? piece.v - v_ : 0.0;
    begun_ = true;
    v_ = at(piece, piece.duration).v;
    if (jump != 0.0) {
      Piece jumping = piece;
      jumping.drive = std::copysign(infinite, jump);
      if (!settle(jumping, 0.0)) return false;
    }
    return settle(piece, 0.0);
  }

  Status through(const Piece& piece) {
    auto stepper = odeint::make_controlled(1e-2 * options_.tolerance, options_.tolerance, Plain());
    double t = 0.0, h = 1e-3 * piece.duration;
    if (!begin(piece)) return Status::chattering;
    show(piece, 0.0);
    int at_one_time = 0;
    while (t < piece.duration) {
      if (++result_.steps > options_.max_steps) return Status::max_iterations;
      if (result_.steps % 256 == 0 && options_.stop && options_.stop()) return Status::interrupted;
      const bool last = h >= piece.duration - t;
      if (last) h = piece.duration - t;
      const State before = y_;
      const double from = t;
      if (stepper.try_step(field(piece), y_, t, h) == odeint::fail) {
        if (!(h > 1e-15 * piece.duration)) return Status::stalled;
        continue;
      }
      if (last) t = piece.duration;
      for (double value : y_)
        if (!std::isfinite(value)) return Status::not_finite;
      if (fired(piece, t, y_) < 0) {
        at_one_time = 0;
        show(piece, t);
        continue;
      }
      const double reached = up_to_switch(piece, before, from, t);
      at_one_time = reached > from + 1e-13 * piece.duration ? 0 : at_one_time + 1;
      if (at_one_time > 500 || !settle(piece, reached)) return Status::chattering;
      t = reached;
      show(piece, t);
      h = std::max(h, 1e-6 * piece.duration);
    }
    x_ = at(piece, piece.duration).x;
    return Status::converged;
  }

  /// Goes back to the first time at which a guard is negative.
  double up_to_switch(const Piece& piece, const State& before, double from, double to) {
    double low = 0.0, high = to - from;
    Plain plain;
    State y = before;
    for (int k = 0; k < 100 && high - low > 1e-15 * (to - from); ++k) {
      const double middle = 0.5 * (low + high);
      y = before;
      plain.do_step(field(piece), y, from, middle);
      (fired(piece, from + middle, y) >= 0 ? high : low) = middle;
    }
    y_ = before;
    if (high > 0.0) plain.do_step(field(piece), y_, from, high);
    return from + high;
  }

  const Element& law_;
  const ReferenceMarchOptions& options_;
  ReferenceMarch result_;
  State y_, z_, dz_, scale_, guards_;
  double energy_scale_ = 1.0, x_ = 0.0, v_ = 0.0;
  bool begun_ = false;
};

}  // namespace

ReferenceMarch reference_march(const Element& law, const VelocityCycle& input, std::vector<double> z, Mode mode,
                               int cycles, const ReferenceMarchOptions& options) {
  const auto pieces = odeint_pieces(input);
  return Run(law, options, std::move(z), mode).through(pieces, cycles);
}

ReferenceMarch reference_march_virgin(const Element& law, const VelocityCycle& input, int cycles,
                                      const ReferenceMarchOptions& options) {
  const auto pieces = odeint_pieces(input);
  std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
  const Mode mode = law.start({0.0, pieces.front().v, pieces.front().drive}, z);
  return Run(law, options, std::move(z), mode).through(pieces, cycles);
}

}  // namespace limcycle
