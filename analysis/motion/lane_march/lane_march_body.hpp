#pragma once
#include "limcycle/analysis/lanes/inverse.hpp"
#include "limcycle/analysis/lanes/pack.hpp"
#include "limcycle/analysis/lanes/slope.hpp"
#include "limcycle/analysis/motion/lane_march/lane_laws.hpp"
#include "limcycle/analysis/motion/lane_march/lane_march.hpp"
#include "limcycle/analysis/motion/steppers/rodas5p_tableau.hpp"

// One function holds a whole step, so that its numbers stay in registers. With sanitizers, which check every access,
// GCC would need twelve minutes for that, but only seconds for the same source out of line.
#ifdef __SANITIZE_ADDRESS__
#define LIMCYCLE_LANE_INLINE
#define LIMCYCLE_LANE_FLATTEN
#else
#define LIMCYCLE_LANE_INLINE [[gnu::always_inline]]
#define LIMCYCLE_LANE_FLATTEN [[gnu::flatten]]
#endif

namespace limcycle {

/// The tableau without library types, whose functions portable sources would share.
struct LaneTableau {
  double A[rodas5p::stages][rodas5p::stages], C[rodas5p::stages][rodas5p::stages], H[3][rodas5p::stages];
};
constexpr LaneTableau lane_tableau() {
  LaneTableau plain{};
  for (std::size_t j = 0; j < rodas5p::stages; ++j) {
    for (std::size_t s = 0; s < rodas5p::stages; ++s) {
      plain.A[s][j] = rodas5p::A[s][j];
      plain.C[s][j] = rodas5p::C[s][j];
    }
    for (std::size_t q = 0; q < 3; ++q) plain.H[q][j] = rodas5p::H[q][j];
  }
  return plain;
}

/// One batch of lanes with n linear states.
template <class P, class Law, int n>
class LaneMarch {
 public:
  explicit LaneMarch(LaneBatch& batch) : batch_(batch), rows_(reinterpret_cast<P*>(batch.rows)) {}

  /// Flattened: the laws are inlined, instead of being copied for every stage.
  LIMCYCLE_LANE_FLATTEN void run() {
    if (batch_.fresh) begin();
    while (!step()) {
    }
  }

 private:
  using Mask = typename P::Mask;
  static constexpr LaneRows at{n};
  static constexpr int N = n + 1, stages = 8;
  static constexpr LaneTableau tableau = lane_tableau();

  P& row(int r) { return rows_[r]; }
  static P one_if(const Mask& mask) { return select(mask, P(1.0), P(0.0)); }

  LIMCYCLE_LANE_INLINE P output(const P* x) {
    P y = row(at.C_y()) * x[0];
#pragma GCC unroll 8
    for (int i = 1; i < n; ++i) y += row(at.C_y() + i) * x[i];
    return y;
  }
  LIMCYCLE_LANE_INLINE P velocity(const P* x) {
    P v = row(LaneRows::speed_outside);
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) v += row(at.C_v() + i) * x[i];
    return v;
  }
  /// Rates of the linear states under the output w.
  LIMCYCLE_LANE_INLINE void linear_rates(const P* x, const P& w, P* dx) {
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) {
      dx[i] = row(at.outside() + i) + row(at.B() + i) * w;
#pragma GCC unroll 8
      for (int j = 0; j < n; ++j) dx[i] += row(at.A(i, j)) * x[j];
    }
  }

  LIMCYCLE_LANE_INLINE void rates(const P* x, P* dx) {
    Input<P> in;
    in.v = velocity(x);
    const auto law = Law::template law<P>(rows_ + LaneRows::law, batch_.curve);
    const LinearRate<P> rate = law.linear_rate(in);
    const LinearOutput<P> out = law.linear_output(in);
    dx[n] = rate.source - rate.decay * x[n];
    linear_rates(x, out.stiffness * x[n] + out.damping * dx[n] + out.rest, dx);
  }

  /// Rates and slopes at the present state.
  LIMCYCLE_LANE_INLINE void linearise() {
    using S = Slope<P>;
    const P* x = rows_ + at.state();
    P* dx = rows_ + at.rate();
    Input<S> in;
    in.v = S(velocity(x), P(1.0));
    const auto law = Law::template law<S>(rows_ + LaneRows::law, batch_.curve);
    const LinearRate<S> rate = law.linear_rate(in);
    const LinearOutput<S> out = law.linear_output(in);
    const P dz = rate.source.value - rate.decay.value * x[n];
    const P dz_v = rate.source.slope - rate.decay.slope * x[n];
    dx[n] = dz;
    linear_rates(x, out.stiffness.value * x[n] + out.damping.value * dz + out.rest.value, dx);
    row(LaneRows::slopes) = dz_v;
    row(LaneRows::slopes + 1) = rate.decay.value;
    row(LaneRows::slopes + 2) =
        out.stiffness.slope * x[n] + out.damping.slope * dz + out.damping.value * dz_v + out.rest.slope;
    row(LaneRows::slopes + 3) = out.stiffness.value - out.damping.value * rate.decay.value;
  }

  /// Rates of new loops and their first step: one that changes the state by a hundredth of itself (Hairer, Norsett,
  /// Wanner I (1993), section II.4), as in March.
  [[gnu::noinline]] void begin() {
    linearise();
    batch_.fresh = false;
    const P *x = rows_ + at.state(), *dx = rows_ + at.rate();
    P size(0.0), speed(0.0);
    for (int i = 0; i < N; ++i) {
      const P scale = row(at.atol() + i) + row(LaneRows::rtol) * abs(x[i]);
      size = max(size, abs(x[i]) / scale);
      speed = max(speed, abs(dx[i]) / scale);
    }
    const P h = select((size > 1e-5) & (speed > 1e-5), 0.01 * size / speed, P(1e-6));
    P& chosen = row(LaneRows::step);
    chosen = select(chosen > 0.0, chosen, max(1e-12 * (1.0 + abs(row(LaneRows::time))), min(P(1.0), h)));
  }

  /// Numbers of the present attempt.
  struct Attempt {
    P h, inverse_h;
    P x[N];  ///< of the last stage, in the end the new state
    P k[stages][N];
    P inverse[n][n];              ///< of the remaining matrix for X after elimination of z
    P z_inverse, z_by_v, w_by_z;  ///< z: (r + z_by_v C_v.k) z_inverse
  };

  /// (I/(gamma h) - J) k = r. The diagonal entry of z, 1/(gamma h) + decay, is positive for any state, so that z can be
  /// eliminated first; the matrix of the n remaining linear states is inverted with row pivoting.
  LIMCYCLE_LANE_INLINE void factorise(Attempt& a) {
    const P diagonal = a.inverse_h * (1.0 / rodas5p::gamma);
    a.z_inverse = 1.0 / (diagonal + row(LaneRows::slopes + 1));
    a.z_by_v = row(LaneRows::slopes);
    a.w_by_z = row(LaneRows::slopes + 3) * a.z_inverse;
    const P w_by_v = row(LaneRows::slopes + 2) + a.w_by_z * a.z_by_v;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) {
      const P factor = row(at.B() + i) * w_by_v;
#pragma GCC unroll 8
      for (int j = 0; j < n; ++j) a.inverse[i][j] = -row(at.A(i, j)) - factor * row(at.C_v() + j);
      a.inverse[i][i] += diagonal;
    }
    invert<P, n>(a.inverse);
  }

  LIMCYCLE_LANE_INLINE void solve(const Attempt& a, const P (&right)[N], P (&k)[N]) {
    P reduced[n];
    const P from_z = a.w_by_z * right[n];
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) reduced[i] = right[i] + row(at.B() + i) * from_z;
    P speed(0.0);
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) {
      k[i] = a.inverse[i][0] * reduced[0];
#pragma GCC unroll 8
      for (int j = 1; j < n; ++j) k[i] += a.inverse[i][j] * reduced[j];
      speed += row(at.C_v() + i) * k[i];
    }
    k[n] = (right[n] + a.z_by_v * speed) * a.z_inverse;
  }

  template <int s>
  LIMCYCLE_LANE_INLINE void stage(Attempt& a) {
    const P* x0 = rows_ + at.state();
    P rate[N];
    if constexpr (s == 0) {
#pragma GCC unroll 8
      for (int i = 0; i < N; ++i) rate[i] = row(at.rate() + i);
    } else {
#pragma GCC unroll 8
      for (int i = 0; i < N; ++i) {
        if constexpr (s + 2 < stages) {
          a.x[i] = x0[i];
#pragma GCC unroll 8
          for (int j = 0; j < s; ++j) a.x[i] += tableau.A[s][j] * a.k[j][i];
        } else {  // the last stages only add the previous one
          a.x[i] += a.k[s - 1][i];
        }
      }
      rates(a.x, rate);
#pragma GCC unroll 8
      for (int i = 0; i < N; ++i) {
        P sum = tableau.C[s][0] * a.k[0][i];
#pragma GCC unroll 8
        for (int j = 1; j < s; ++j) sum += tableau.C[s][j] * a.k[j][i];
        rate[i] += sum * a.inverse_h;
      }
    }
    solve(a, rate, a.k[s]);
  }

  /// Largest weighted error; infinite if any number is not finite.
  LIMCYCLE_LANE_INLINE P error(const Attempt& a) {
    P worst(0.0), sum(0.0);
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i) {
      const P reach = max(abs(row(at.state() + i)), abs(a.x[i]));
      const P ratio = abs(a.k[stages - 1][i]) / (row(at.atol() + i) + row(LaneRows::rtol) * reach);
      worst = max(worst, ratio);
      sum += ratio + (a.x[i] - a.x[i]);  // NaN if either is no number
    }
    return select(sum < __builtin_inf(), worst, P(__builtin_inf()));
  }

  /// The next step, as in StepSizeControl: powers of the errors by their logarithms.
  LIMCYCLE_LANE_INLINE void choose_step(const P& h, const P& error, const Mask& good) {
    constexpr double least_log_error = -4.605170185988091;  // ln 0.01
    const P log_error = log(error), bounded = max(log_error, P(least_log_error));
    P &old_h = row(LaneRows::old_step), &old_error = row(LaneRows::old_error), &rejected = row(LaneRows::rejected);
    const P factor = 0.9 * exp(-0.2 * log_error);
    const P trend = 0.9 * (h / old_h) * exp(0.2 * (old_error - 2.0 * bounded));
    const P predicted = select(old_h > 0.0, min(factor, trend), factor);
    const P longer = max(P(0.2), min(select(rejected > 0.0, P(1.0), P(6.0)), predicted));
    const P shorter = max(P(0.2), min(P(0.9), factor));
    const Mask active = row(LaneRows::active) > 0.0;
    row(LaneRows::step) = select(active, h * select(good, longer, shorter), row(LaneRows::step));
    old_h = select(good, h, old_h);
    old_error = select(good, bounded, old_error);
    rejected = select(good, P(0.0), P(1.0));
    row(LaneRows::accepted) += one_if(good);
    row(LaneRows::refused) += one_if(active & !good);
  }

  /// One attempt in every lane; true if there was an event.
  LIMCYCLE_LANE_INLINE bool step() {
    Attempt a;
    ++batch_.attempts;
    const P t = row(LaneRows::time), wanted = row(LaneRows::step), left = row(LaneRows::end) - t;
    const Mask last = wanted >= left;
    a.h = select(last, left, wanted);
    a.inverse_h = 1.0 / a.h;
    factorise(a);
    stage<0>(a);
    stage<1>(a);
    stage<2>(a);
    stage<3>(a);
    stage<4>(a);
    stage<5>(a);
    stage<6>(a);
    stage<7>(a);
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i) a.x[i] += a.k[stages - 1][i];
    const P t1 = select(last, row(LaneRows::end), t + a.h), weighted = error(a);
    const Mask good = (row(LaneRows::active) > 0.0) & (weighted <= 1.0) & (t1 > t);
    choose_step(a.h, weighted, good);
    return move(a, t1, weighted, good);
  }

  /// Moves to the end of the step in lanes where it is good, and detects events.
  LIMCYCLE_LANE_INLINE bool move(const Attempt& a, const P& t1, const P& weighted, const Mask& good) {
    const P t = row(LaneRows::time);
    const P y0 = output(rows_ + at.state()), y1 = output(a.x), speed0 = output(rows_ + at.rate());
    row(LaneRows::time) = select(good, t1, t);
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i) {
      P& x = row(at.state() + i);
      x = select(good, a.x[i], x);
    }
    linearise();
    const P speed1 = output(rows_ + at.rate()), level = row(LaneRows::level);
    const Mask turned = ((speed0 < 0.0) & (speed1 >= 0.0)) | ((speed0 >= 0.0) & (speed1 < 0.0));
    const P of_y =
        select(turned, P(lane_turned), P(0.0)) + select((y0 < level) & (y1 >= level), P(lane_crossed), P(0.0));
    const P of_run = select(t1 >= row(LaneRows::look), P(lane_look), P(0.0)) +
                     select(t1 >= row(LaneRows::end), P(lane_ended), P(0.0)) +
                     select(abs(y1) > row(LaneRows::ceiling), P(lane_left), P(0.0)) +
                     select(row(LaneRows::accepted) >= row(LaneRows::most_steps), P(lane_budget), P(0.0));
    const Mask short_of_it = !(row(LaneRows::step) > 1e-15 * max(abs(t), P(1e-12)));
    const P why = select(weighted < __builtin_inf(), P(lane_stalled), P(lane_not_finite));
    const Mask active = row(LaneRows::active) > 0.0;
    const P event = select(good, of_y + of_run, select(short_of_it & active, why, P(0.0)));
    if (!(event > 0.0).any()) return false;
    row(LaneRows::event) = event;
    row(LaneRows::step_start) = t;
    row(LaneRows::y_start) = y0;
    row(LaneRows::y_end) = y1;
    if ((of_y > 0.0).any()) bend(a);
    return true;
  }

  /// Interpolant of y.
  void bend(const Attempt& a) {
    P y[stages];
    for (int j = 0; j < stages; ++j) y[j] = output(a.k[j]);
    for (int q = 0; q < 3; ++q) {
      P sum(0.0);
      for (int j = 0; j < stages; ++j) sum += tableau.H[q][j] * y[j];
      row(LaneRows::y_bend + q) = sum;
    }
  }

  LaneBatch& batch_;
  P* rows_;
};

template <class P, class Law, int n>
void lane_march(LaneBatch& batch) {
  LaneMarch<P, Law, n>(batch).run();
}

template <class P, int n>
constexpr void add_kernels(LaneKernels& kernels) {
  kernels.usual_lugre[n] = lane_march<P, LaneLuGre<P, true>, n>;
  kernels.lugre[n] = lane_march<P, LaneLuGre<P, false>, n>;
  kernels.dahl[n] = lane_march<P, LaneDahl<P>, n>;
  if constexpr (n < LaneKernels::most_states) add_kernels<P, n + 1>(kernels);
}

template <class P>
constexpr LaneKernels lane_kernels() {
  LaneKernels kernels;
  kernels.lanes = P::lanes;
  add_kernels<P, LaneKernels::fewest_states>(kernels);
  return kernels;
}

}  // namespace limcycle

#undef LIMCYCLE_LANE_INLINE
#undef LIMCYCLE_LANE_FLATTEN
