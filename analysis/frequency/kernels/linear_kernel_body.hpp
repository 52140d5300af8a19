#pragma once
#include <cstddef>

#include "limcycle/analysis/frequency/kernels/linear_kernel.hpp"
#include "limcycle/analysis/lanes/elimination.hpp"
#include "limcycle/analysis/lanes/pack.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// LuGre on packs, every lane with the same parameters, in the kernel's units: velocities in vs, so that a state in
/// metres is `unit` times that of `law`. `usual`: the most common kind of curve, whose constants the compiler can then
/// use.
template <class P, bool usual>
struct LuGreLanes {
  double unit;
  LuGre<P> law;

  explicit LuGreLanes(const LuGre<double>& from) : unit(from.vs) {
    law.Fs = from.Fs;
    law.Fc = from.Fc;
    law.Fs_minus = from.Fs_minus;
    law.Fc_minus = from.Fc_minus;
    law.delta = from.delta;
    law.curve.index = from.curve.index;
    law.sigma0 = from.sigma0 * unit;
    law.sigma1 = from.sigma1;  // multiplied by `unit` later on, as part of the output, as dz/dt is
    law.vd = from.vd / unit;
    law.vs = 1.0;
  }
  static bool is_usual(const LuGre<double>& law) { return law.curve.index == 0 && law.delta == 2.0; }

  LinearRate<P> linear_rate(const Input<P>& in) const {
    LuGre<P> known = law;
    known.vs = 1.0;
    if constexpr (usual) {
      known.curve.index = 0;
      known.delta = 2.0;
      known.Fs_minus = law.Fs;
      known.Fc_minus = law.Fc;
    }
    return known.linear_rate(in);
  }
  LinearOutput<P> linear_output(const Input<P>& in) const { return law.linear_output(in); }
};

template <class P>
struct DahlLanes {
  double unit = 1.0;
  Dahl<P> law;

  explicit DahlLanes(const Dahl<double>& from) {
    law.Fc = from.Fc;
    law.sigma0 = from.sigma0;
    law.exponent = from.exponent;
  }
  LinearRate<P> linear_rate(const Input<P>& in) const { return law.linear_rate(in); }
  LinearOutput<P> linear_output(const Input<P>& in) const { return law.linear_output(in); }
};

/// One task of as many points as P has lanes.
template <class P, int S, class Law>
class LinearPass {
 public:
  LinearPass(const Law& law, const LinearTask& task)
      : frequency_(P::load(task.frequency)),
        peak_(P::load(task.amplitude) * frequency_ / law.unit),
        period_(1.0 / frequency_),
        law_(law),
        task_(task),
        numbers_(*task.collocation),
        z_(reinterpret_cast<P*>(task.scratch)),
        homogeneous_(z_ + S * task.panel_count) {}

  void run() {
    march();
    combine();
    for (int order = 0; order < task_.orders; ++order) sum(order, z_, task_.state_sums);
    if (task_.damping_sums == nullptr) return;
    damp();
    for (int order = 0; order < task_.orders; ++order) sum(order, homogeneous_, task_.damping_sums);
  }

 private:
  static constexpr int lanes = P::lanes;

  const double* sines(int p) const { return task_.panels[p]; }
  const double* steps(int p) const { return sines(p) + S; }

  Input<P> input(double sine) const {
    Input<P> in;
    in.v = peak_ * sine;
    return in;
  }

  /// Both solutions through all panels; the homogeneous one until it has decayed.
  void march() {
    P particular(0.0), homogeneous(1.0);
    int p = 0;
    for (; p < task_.remembered; ++p) {
      P x[S], y[S];
      solve<true>(p, x, y);
      for (int i = 0; i < S; ++i) {
        z_[p * S + i] = x[i] + particular * y[i];
        homogeneous_[p * S + i] = homogeneous * y[i];
      }
      particular = z_[p * S + S - 1];
      homogeneous = homogeneous_[p * S + S - 1];
    }
    for (; p < task_.panel_count; ++p) {
      P x[S], y[S];
      for (int i = 0; i < S; ++i) y[i] = particular * numbers_.row_sum[i];
      solve<false>(p, x, y);
      for (int i = 0; i < S; ++i) z_[p * S + i] = x[i];
      particular = x[S - 1];
    }
    if (task_.remembered < task_.panel_count) homogeneous = P(0.0);
    start_ = -particular / (1.0 + homogeneous);
  }

  /// Collocation on one panel: x for the source, y for the state 1 at the beginning; without `Both` x for the source
  /// and the right-hand side given in y.
  template <bool Both>
  [[gnu::always_inline]] void solve(int p, P (&x)[S], P (&y)[S]) const {
    const double *sine = sines(p), *step = steps(p);
    P m[S][S];
#pragma GCC unroll 8
    for (int i = 0; i < S; ++i) {
      const LinearRate<P> rate = law_.linear_rate(input(sine[i]));
      const P scale = period_ * step[i];
      x[i] = rate.source * scale;
      if constexpr (Both)
        y[i] = P(numbers_.row_sum[i]);
      else
        x[i] += y[i];
#pragma GCC unroll 8
      for (int j = 0; j < S; ++j) m[i][j] = P(numbers_.inverse[i * S + j]);
      m[i][i] += rate.decay * scale;
    }
    if constexpr (Both)
      eliminate(m, x, y);
    else
      eliminate(m, x);
  }

  /// The periodic state at all nodes.
  void combine() {
    for (int p = 0; p < task_.remembered; ++p)
      for (int i = 0; i < S; ++i) z_[p * S + i] += start_ * homogeneous_[p * S + i];
  }

  /// Damping times dz/dt at the nodes, in the place of the homogeneous solution.
  void damp() {
    for (int p = 0; p < task_.panel_count; ++p)
      for (int i = 0; i < S; ++i) {
        const Input<P> in = input(sines(p)[i]);
        const LinearRate<P> rate = law_.linear_rate(in);
        homogeneous_[p * S + i] = law_.linear_output(in).damping * (rate.source - rate.decay * z_[p * S + i]);
      }
  }

  /// The integrals of one order.
  void sum(int order, const P* values, double* sums) const {
    P sine[S], cosine[S];
    for (int i = 0; i < S; ++i) sine[i] = cosine[i] = P(0.0);
    for (int p = 0; p < task_.panel_count; ++p) {
      const double* weights = steps(p) + S + 2 * S * order;
#pragma GCC unroll 8
      for (int i = 0; i < S; ++i) {
        const P value = values[p * S + i];
        sine[i] += value * weights[i];
        cosine[i] += value * weights[S + i];
      }
    }
    for (int i = 1; i < S; ++i) {
      sine[0] += sine[i];
      cosine[0] += cosine[i];
    }
    double* const at = sums + std::ptrdiff_t{2} * lanes * order;
    (sine[0] * law_.unit).store(at);
    (cosine[0] * law_.unit).store(at + lanes);
  }

  P frequency_, peak_, period_, start_;
  const Law& law_;
  const LinearTask& task_;
  const CollocationNumbers& numbers_;
  P *z_, *homogeneous_;
};

template <class P, int S>
void lugre_kernel(const LuGre<double>& law, const LinearTask& task) {
  if (LuGreLanes<P, true>::is_usual(law)) {
    const LuGreLanes<P, true> lanes(law);
    LinearPass<P, S, LuGreLanes<P, true>>(lanes, task).run();
  } else {
    const LuGreLanes<P, false> lanes(law);
    LinearPass<P, S, LuGreLanes<P, false>>(lanes, task).run();
  }
}

template <class P, int S>
void dahl_kernel(const Dahl<double>& law, const LinearTask& task) {
  const DahlLanes<P> lanes(law);
  LinearPass<P, S, DahlLanes<P>>(lanes, task).run();
}

template <class P>
constexpr LinearKernels linear_kernels() {
  LinearKernels kernels;
  kernels.lugre[4] = lugre_kernel<P, 4>;
  kernels.dahl[4] = dahl_kernel<P, 4>;
  kernels.lugre[5] = lugre_kernel<P, 5>;
  kernels.dahl[5] = dahl_kernel<P, 5>;
  kernels.lugre[6] = lugre_kernel<P, 6>;
  kernels.dahl[6] = dahl_kernel<P, 6>;
  kernels.lugre[8] = lugre_kernel<P, 8>;
  kernels.dahl[8] = dahl_kernel<P, 8>;
  return kernels;
}

}  // namespace limcycle
