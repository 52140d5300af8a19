#pragma once

namespace limcycle {

/// @file
/// Half period, phi in [0, pi] of x = -A cos(phi), of one state that is not linear, or that switches between modes:
/// marched by Radau IIA collocation. Every lane has its own panels, which end where its mode does. All numbers are
/// dimensionless. The state is u, in units of its largest level; g is the Stribeck level over its value at rest, as a
/// function of speed sin(phi).
///
///   elasto-plastic  du/dphi = reach sin(phi) (1 - a(u) u/g), a as in the law
///   capped          du/dphi = reach sin(phi) while |u + drag sin(phi)| < b, else du/dphi = tempo (+-b - u);
///                   db/dphi = lag (g - b)                                                       (an element of Xiong)
///   dahl            du/dphi = reach sin(phi) (1 - u)^exponent, exponent >= 1
///   bouc-wen        du/dphi = reach sin(phi) (1 - |u|^exponent), u > 0; (1 - curvature |u|^exponent), u < 0
///
/// Raw arrays only: the same source is compiled for each instruction set (see Pack).

enum class MarchLaw { elasto_plastic, capped, dahl, bouc_wen };
inline constexpr int march_laws = 4;

/// Parameters of the equations above that all lanes share.
struct MarchNumbers {
  double ratio = 1.0;  ///< level of fast sliding over that at rest
  double delta = 2.0;  ///< Stribeck exponent
  int curve = 0;       ///< as in StribeckCurve
  double share = 0.0;  ///< elasto-plastic: elastic share of g
  double fixed = 0.0;  ///< or, > 0: elastic range that does not depend on the speed
  double exponent = 1.0, curvature = 0.0;
};

/// The collocation: nodes 0, c_1 .. c_S and the quantities derived from them.
struct MarchCollocation {
  double nodes[9];        ///< the first is 0
  double weights[9];      ///< of the integral; the first is 0
  double inverse[64];     ///< of the matrix, row-major
  double row_sum[8];      ///< of that
  double start_slope[9];  ///< derivative at 0 of the polynomial through the nodes; the first is not used
  double end_slope[9];    ///< the same at 1; the last is not used
  double apart[9][9];     ///< [i][j]: 1/(nodes[i] - nodes[j])
};

/// Fineness of a march.
struct MarchMesh {
  int stages = 5;
  double width = 0.7;     ///< of a panel in q, where tan(phi/2) = after sinh(q) up to pi/2, and likewise from pi
  double cap = 0.5;       ///< of `after` and `before`, in units of the layers there
  double ignored = 0.0;   ///< share of a layer, deep within a wider one, that need not be resolved
  double newton = 1e-4;   ///< last step of Newton on a panel, whose error is of the order of its square
  double located = 1e-9;  ///< largest distance of u from its edge at a switch
  double layer = 1e-3;    ///< size of a relaxation after a switch that need not be resolved
};

/// Points that are marched, one array each; inputs, then answers.
struct MarchTask {
  const MarchCollocation* collocation = nullptr;
  const MarchMesh* mesh = nullptr;
  int count = 0;
  int orders = 1;  ///< odd orders 1, 3, .., 2 orders - 1
  const double *reach = nullptr, *speed = nullptr, *tempo = nullptr, *drag = nullptr, *lag = nullptr;
  const double *after = nullptr, *before = nullptr;       ///< scales of the panels at both ends
  const double *start = nullptr, *start_level = nullptr;  ///< u and b at phi = 0

  double *end = nullptr, *slope = nullptr;              ///< u(pi) and its derivative by u(0)
  double *end_level = nullptr, *level_slope = nullptr;  ///< the same of b
  double* sums = nullptr;  ///< [point][order][u, du/du(0)][sine, cosine]: integrals over the half period
  int* panels = nullptr;   ///< tried; 0 if the march did not reach the end; negative if a switch may have been missed

  static constexpr int sums_of(int orders) { return 4 * orders; }
};

using MarchKernel = void (*)(const MarchNumbers& law, const MarchTask& task);

/// The kernels of one instruction set, by law and stages (5 and 8; else null).
struct MarchKernels {
  MarchKernel of[march_laws][9] = {};
};

extern const MarchKernels scalar_march_kernels;
extern const MarchKernels avx2_march_kernels;
extern const MarchKernels avx512_march_kernels;

}  // namespace limcycle
