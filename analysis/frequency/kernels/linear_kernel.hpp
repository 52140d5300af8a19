#pragma once
#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// @file
/// Periodic state of a law that is linear in its state, under x = -A cos(phi) for phi in [0, pi], the half period of
/// forward motion: dz/dphi = (source - decay z)/w, z(pi) = -z(0). The half period is cut into panels of Radau IIA
/// collocation, which follows a fast relaxation as well as a slow spring. One pass carries a particular solution that
/// begins with 0 and the homogeneous one that begins with 1; the periodic state is a combination of both. Points are
/// computed lane by lane, on one mesh.
///
/// Raw arrays only: the same source is compiled for each instruction set (see Pack).

/// One panel, as numbers in a row: for S stages
///   sine[S] of phi at the nodes, step[S] = width of the panel times dphi/dtau there, then for each odd order k =
///   1, 3, .. sine_weight[S], cosine_weight[S], with which values of z at the nodes give the integrals of z sin(k phi)
///   and z cos(k phi) over the panel;
struct PanelGeometry {
  static constexpr int size(int stages, int orders) { return 2 * stages + 2 * stages * orders; }
};

/// The collocation as the kernel uses it: inverse of its matrix (row-major) and the row sums of that inverse.
struct CollocationNumbers {
  double inverse[64];
  double row_sum[8];
};

/// Input and output of the kernel: as many points as the instruction set has lanes.
struct LinearTask {
  const CollocationNumbers* collocation = nullptr;
  const double* const* panels = nullptr;
  int panel_count = 0;
  int orders = 0;      ///< odd orders 1, 3, .., 2 orders - 1
  int remembered = 0;  ///< panels after which nothing is left of the initial state
  const double* amplitude = nullptr;
  const double* frequency = nullptr;
  double* scratch = nullptr;  ///< aligned to 64 bytes; see scratch_size

  // Results: for each order the integrals over the half period of sin(k phi) and cos(k phi) times z, and times damping
  // dz/dt if the damping is not constant.
  double* state_sums = nullptr;    ///< [order][sine, cosine][lane]
  double* damping_sums = nullptr;  ///< the same; null: not wanted

  static constexpr int scratch_size(int stages, int panels, int lanes) { return 2 * stages * panels * lanes; }
};

/// The kernel for one law, instruction set and number of stages.
template <class Law>
using LinearKernel = void (*)(const Law& law, const LinearTask& task);

/// The kernels of one instruction set; stages 4, 5, 6 and 8, else null.
struct LinearKernels {
  LinearKernel<LuGre<double>> lugre[9] = {};
  LinearKernel<Dahl<double>> dahl[9] = {};
};

extern const LinearKernels scalar_linear_kernels;
extern const LinearKernels avx2_linear_kernels;
extern const LinearKernels avx512_linear_kernels;

}  // namespace limcycle
