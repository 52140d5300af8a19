#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

#include "limcycle/analysis/dense_elimination.hpp"
#include "limcycle/analysis/frequency/composite/composite_force.hpp"
#include "limcycle/analysis/motion/steppers/rodas5p_tableau.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// One step of RODAS5P (see rodas5p_tableau.hpp) for a mass with one friction law under a harmonic force, over phase:
/// m dv/dt = u - F(v, z). Unknowns are v and the law's own states only; position is neutral, and its harmonics come
/// from integrals that are carried along in the same step (they load the linear systems with nothing). D: 1 + number of
/// states, 0 if it is known at run time only. The law gets no absolute position (x = 0).
template <int D>
class CompositeStep {
 public:
  using Vector = std::conditional_t<D == 0, std::vector<double>, std::array<double, std::size_t(D)>>;
  struct State {
    Vector y{};  ///< v, then the states of the law
    Mode mode{};
  };

  CompositeStep(const Element& law, double mass)
      : law_(law), dual_(law.on<DualS>()), mass_(mass), d_(1 + static_cast<std::size_t>(law.states())) {
    for (auto* v : {&y1_, &stage_, &rate0_, &rate_, &error_, &dfdt_, &reach_}) resize(*v);
    for (auto& k : k_) resize(k);
    dual_z_.resize(d_ - 1);
    dual_dz_.resize(d_ - 1);
    seeds_.reserve(d_ + 1);
    jacobian_.resize(d_ * d_);
    lu_.resize(d_ * d_);
    moving_.reserve(d_);
  }

  const Element& law() const { return law_; }
  std::size_t size() const { return d_; }
  long steps() const { return steps_; }

 protected:
  static constexpr std::size_t width = 4;
  using DualS = Dual<4>;

  void prepare(const CompositeForce& force, const CompositeTolerance& tolerance, int orders) {
    force_ = force;
    tolerance_ = tolerance;
    orders_ = static_cast<std::size_t>(orders);
    nq_ = 2 + 2 * orders_;
    q_error_.assign(nq_, 0.0);
    q1_.assign(nq_, 0.0);
    kq_.assign(nq_ * rodas5p::stages, 0.0);
  }

  void resize(Vector& v) const {
    if constexpr (D == 0) v.assign(d_, 0.0);
  }
  bool held(Mode mode) const {
    if constexpr (requires { law_.held(mode); }) return law_.held(mode) != Held::nothing;
    return false;
  }
  std::span<const double> states(const Vector& y) const { return {y.data() + 1, d_ - 1}; }

  /// dy/dphase at a phase with this sine; the friction force is kept.
  void field(const Vector& y, Mode mode, double sine, Vector& dy) {
    const Input<double> in{0.0, y[0], force_.bias + force_.amplitude * sine};
    if (d_ > 1) law_.rate(in, mode, states(y), {dy.data() + 1, d_ - 1});
    if (held(mode)) {
      friction_ = in.drive;
      dy[0] = 0.0;
    } else {
      friction_ = law_.output(in, mode, states(y));
      dy[0] = (in.drive - friction_) / mass_;
    }
    for (auto& rate : dy) rate /= force_.frequency;
  }

  /// The unknowns that something depends on in this mode, and behind them (as number d_) the force if the law needs it.
  void find_seeds(Mode mode, bool stuck) {
    seeds_.assign(1, 0);
    for (std::size_t k = 1; k < d_; ++k)
      if (!law_.unused(mode, static_cast<int>(k) - 1)) seeds_.push_back(k);
    if (!stuck && drive_is_of_rate(law_)) seeds_.push_back(d_);
  }

  /// d(dy/dphase)/dy by dual numbers, several seeds at a time; also dF/dy, and dF/du if the law may need the force.
  void differentiate(const Vector& y, Mode mode, double sine) {
    const double u = force_.bias + force_.amplitude * sine;
    const bool stuck = held(mode);
    find_seeds(mode, stuck);
    friction_gradient_.assign(d_, 0.0);
    friction_by_force_ = stuck ? 1.0 : 0.0;
    std::fill(jacobian_.begin(), jacobian_.end(), 0.0);
    for (std::size_t k = 1; k < d_; ++k) dual_z_[k - 1] = DualS(y[k]);
    for (std::size_t first = 0; first < seeds_.size(); first += width) {
      const std::size_t count = std::min(seeds_.size() - first, width);
      Input<DualS> in{DualS(0.0), DualS(y[0]), DualS(u)};
      const auto seeded = [&](std::size_t k) -> DualS& { return k == 0 ? in.v : k == d_ ? in.drive : dual_z_[k - 1]; };
      for (std::size_t i = 0; i < count; ++i) seeded(seeds_[first + i]).d[i] = 1.0;
      const DualS out = stuck ? DualS(u) : dual_.output(in, mode, dual_z_);
      if (d_ > 1) dual_.rate(in, mode, dual_z_, dual_dz_);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t column = seeds_[first + i];
        seeded(column).d[i] = 0.0;
        if (column == d_) {
          friction_by_force_ = out.d[i];
          continue;
        }
        friction_gradient_[column] = out.d[i];
        jacobian_[column] = stuck ? 0.0 : -out.d[i] / (mass_ * force_.frequency);
        for (std::size_t k = 1; k < d_; ++k) jacobian_[k * d_ + column] = dual_dz_[k - 1].d[i] / force_.frequency;
      }
    }
  }

  /// Calls f(i) for every unknown i that moves in this step. Return points kept for later, and elements that are stuck
  /// or fully stretched, have a rate of zero whatever the state is.
  template <class Function>
  void each_moving(const Function& f) const {
    if constexpr (D == 0)
      for (const std::size_t i : moving_) f(i);
    else
      for (std::size_t i = 0; i < std::size_t(D); ++i) f(i);
  }
  void find_moving() {
    if constexpr (D != 0) return;
    moving_.assign(1, 0);
    for (std::size_t k = 1; k < d_; ++k) {
      const double* row = &jacobian_[k * d_];
      if (rate0_[k] != 0.0 || std::any_of(row, row + d_, [](double slope) { return slope != 0.0; }))
        moving_.push_back(k);
    }
  }

  /// Quantities that do not depend on the length of the step.
  void begin(const State& s) {
    y0_ = &s.y;
    mode_ = s.mode;
    sine0_ = std::sin(phase_);
    cosine0_ = std::cos(phase_);
    field(s.y, mode_, sine0_, rate0_);
    friction0_ = friction_;
    differentiate(s.y, mode_, sine0_);
    find_moving();
    y1_ = s.y;
    std::fill(error_.begin(), error_.end(), 0.0);
    std::fill(dfdt_.begin(), dfdt_.end(), 0.0);
    dfdt_[0] = (1.0 - friction_by_force_) * force_.amplitude * cosine0_ / (mass_ * force_.frequency);
  }

  /// Integrands over phase of displacement, work, and v sin k, v cos k.
  void integrands(double v, double friction, double sine, double cosine, double* g) const {
    const double rate = v / force_.frequency;
    g[0] = rate;
    g[1] = friction * rate;
    double s = sine, c = cosine;
    for (std::size_t k = 0; k < orders_; ++k) {
      g[2 + 2 * k] = rate * s;
      g[3 + 2 * k] = rate * c;
      const double next = s * cosine + c * sine;
      c = c * cosine - s * sine;
      s = next;
    }
  }

  /// The stages of one step of length h; new state in y1_, integrals in q1_, with their error estimates.
  bool attempt(double h) {
    using namespace rodas5p;
    ++steps_;
    if (!factorise(1.0 / (rodas5p::gamma * h))) return false;
    double* const g = g_.data();
    for (std::size_t s = 0; s < stages; ++s) {
      double sine = sine0_, cosine = cosine0_;
      if (s == 0) {
        std::copy(rate0_.begin(), rate0_.end(), rate_.begin());
        std::copy(y0_->begin(), y0_->end(), stage_.begin());
        friction_ = friction0_;
      } else {
        each_moving([&](std::size_t i) {
          double sum = (*y0_)[i];
          for (std::size_t j = 0; j < s; ++j) sum += A[s][j] * k_[j][i];
          stage_[i] = sum;
        });
        if (s < 6) {
          sine_ = std::sin(phase_ + node[s] * h);
          cosine_ = std::cos(phase_ + node[s] * h);
        }
        sine = sine_;
        cosine = cosine_;
        field(stage_, mode_, sine, rate_);
      }
      each_moving([&](std::size_t i) {
        double sum = rate_[i] + h * time_weight[s] * dfdt_[i];
        for (std::size_t j = 0; j < s; ++j) sum += C[s][j] / h * k_[j][i];
        k_[s][i] = sum;
      });
      solve(k_[s]);
      integrands(stage_[0], friction_, sine, cosine, g);
      carry_integrals(s, h, g);
    }
    finish();
    return true;
  }

  /// The same stage for the integrals: their part of the system is triangular.
  void carry_integrals(std::size_t s, double h, const double* g) {
    using namespace rodas5p;
    const double v0 = (*y0_)[0] / force_.frequency, kv = k_[s][0] / force_.frequency;
    double* const own = &kq_[s * nq_];
    for (std::size_t q = 0; q < nq_; ++q) {
      double sum = g[q];
      for (std::size_t j = 0; j < s; ++j) sum += C[s][j] / h * kq_[j * nq_ + q];
      own[q] = sum;
    }
    own[0] += kv;
    own[1] += friction0_ * kv;
    each_moving([&](std::size_t i) { own[1] += v0 * friction_gradient_[i] * k_[s][i]; });
    own[1] += friction_by_force_ * v0 * h * time_weight[s] * force_.amplitude * cosine0_;
    double sk = sine0_, ck = cosine0_;
    for (std::size_t k = 0; k < orders_; ++k) {
      const double turn = static_cast<double>(k + 1) * v0 * h * time_weight[s];
      own[2 + 2 * k] += sk * kv + turn * ck;
      own[3 + 2 * k] += ck * kv - turn * sk;
      const double next = sk * cosine0_ + ck * sine0_;
      ck = ck * cosine0_ - sk * sine0_;
      sk = next;
    }
    for (std::size_t q = 0; q < nq_; ++q) own[q] *= rodas5p::gamma * h;
  }

  void finish() {
    using namespace rodas5p;
    each_moving([&](std::size_t i) {
      y1_[i] = stage_[i] + k_[stages - 1][i];
      error_[i] = k_[stages - 1][i];
    });
    for (std::size_t q = 0; q < nq_; ++q) {
      double sum = 0.0;
      for (std::size_t j = 0; j + 1 < stages; ++j) sum += A[stages - 1][j] * kq_[j * nq_ + q];
      q_error_[q] = kq_[(stages - 1) * nq_ + q];
      q1_[q] = sum + q_error_[q];
    }
  }

  /// LU of shift - J; pivots stay on the diagonal for one and two unknowns unless they vanish.
  bool factorise(double shift) {
    if constexpr (D == 0) {
      const std::size_t n = moving_.size();
      system_.assign(n * (2 * n), 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
          system_[i * 2 * n + j] = (i == j ? shift : 0.0) - jacobian_[moving_[i] * d_ + moving_[j]];
        system_[i * 2 * n + n + i] = 1.0;
      }
      if (!eliminate(system_, n, n)) return false;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) lu_[i * n + j] = system_[i * 2 * n + n + j];
      return true;
    }
    if (d_ == 1) {
      lu_[0] = 1.0 / (shift - jacobian_[0]);
      return std::isfinite(lu_[0]);
    }
    const double a = shift - jacobian_[0], b = -jacobian_[1], c = -jacobian_[2], e = shift - jacobian_[3];
    const double inverse = 1.0 / (a * e - b * c);
    lu_[0] = e * inverse;
    lu_[1] = -b * inverse;
    lu_[2] = -c * inverse;
    lu_[3] = a * inverse;
    return std::isfinite(inverse);
  }

  /// x := (shift - J)^-1 x.
  void solve(Vector& x) {
    std::size_t row = 0;
    each_moving([&](std::size_t i) {
      double sum = 0.0;
      each_moving([&](std::size_t j) { sum += lu_[row++] * x[j]; });
      reach_[i] = sum;
    });
    each_moving([&](std::size_t i) { x[i] = reach_[i]; });
  }

  double error_norm() const {
    double worst = 0.0;
    for (std::size_t i = 0; i < d_; ++i) {
      const double absolute = i == 0 ? tolerance_.velocity : law_.state_scale(static_cast<int>(i) - 1);
      const double allowed = tolerance_.relative *
                             std::max({absolute, i == 0 ? std::abs((*y0_)[i]) : 0.0, i == 0 ? std::abs(y1_[i]) : 0.0});
      const double ratio = std::abs(error_[i]) / allowed;
      if (!std::isfinite(ratio) || !std::isfinite(y1_[i])) return infinite;
      worst = std::max(worst, ratio);
    }
    for (std::size_t q = 0; q < nq_ && q < 4; ++q) {
      if (q == 1) continue;
      worst = std::max(worst, std::abs(q_error_[q]) / (tolerance_.relative * tolerance_.length));
    }
    return worst;
  }

  Element law_;
  ElementOn<DualS> dual_;
  double mass_;
  std::size_t d_, nq_ = 4, orders_ = 1;
  CompositeForce force_;
  CompositeTolerance tolerance_;
  double phase_ = 0.0;
  Mode mode_{};
  long steps_ = 0;
  Vector y1_{}, stage_{}, rate0_{}, rate_{};
  std::vector<double> q1_;

 private:
  double sine0_ = 0.0, cosine0_ = 1.0, sine_ = 0.0, cosine_ = 1.0, friction0_ = 0.0, friction_ = 0.0;
  double friction_by_force_ = 0.0;
  const Vector* y0_ = nullptr;
  Vector error_{}, dfdt_{}, reach_{};
  std::array<Vector, rodas5p::stages> k_{};
  std::array<double, 2 + 2 * 64> g_{};
  std::vector<double> kq_, q_error_, friction_gradient_, jacobian_, lu_, system_;
  std::vector<DualS> dual_z_, dual_dz_;
  std::vector<std::size_t> seeds_, moving_;
};

}  // namespace limcycle
