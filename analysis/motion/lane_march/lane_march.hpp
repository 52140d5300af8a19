#pragma once
#include "limcycle/analysis/lanes/isa.hpp"

/// @file
/// Many loops marched at once, one in each lane of a register: dX/dt = A X + B w + E, v = C_v X + v_outside, with one
/// friction law w that is linear in its single state z. Every lane has its own numbers, time, step size and tolerances,
/// and is replaced by the next loop when it ends. RODAS5P, with the step size control of StepSizeControl.
///
/// Raw arrays only: the same source is compiled for each instruction set (see Pack).

namespace limcycle {

/// Rows of the numbers of a lane, for n linear states: number r of lane l is rows[r * lanes + l].
struct LaneRows {
  // The run.
  static constexpr int time = 0;
  static constexpr int step = 1;       ///< length of the next step; 0: to be chosen (a new loop)
  static constexpr int end = 2;        ///< no step goes beyond it; infinite: no limit
  static constexpr int old_step = 3;   ///< 0: none
  static constexpr int old_error = 4;  ///< its logarithm
  static constexpr int rejected = 5;   ///< 1 after a rejection
  static constexpr int active = 6;     ///< 0: nothing is marched here
  static constexpr int accepted = 7;   ///< number of steps
  static constexpr int refused = 8;
  static constexpr int rtol = 9;
  static constexpr int speed_outside = 10;  ///< of the rubbing velocity, in units of the law's
  // Events to detect.
  static constexpr int look = 11;     ///< the first step that ends at or after this time is an event
  static constexpr int level = 12;    ///< so is one that y crosses upwards; infinite: none
  static constexpr int ceiling = 13;  ///< so is |y| beyond this
  static constexpr int most_steps = 14;
  static constexpr int event = 15;  ///< sum of LaneEvent
  // The last accepted step, if there was an event: from step_start to time, with y as in DenseSegment.
  static constexpr int step_start = 16;
  static constexpr int y_start = 17;
  static constexpr int y_end = 18;
  static constexpr int y_bend = 19;  ///< 3 numbers
  // The linear part of the law at the present state, for the Jacobian.
  static constexpr int slopes = 22;  ///< dz'/dv, -dz'/dz, dw/dv, dw/dz
  static constexpr int law = 26;     ///< up to 10 numbers
  static constexpr int first = 36;

  int n;
  constexpr int A(int i, int j) const { return first + n * i + j; }
  constexpr int B() const { return first + n * n; }
  constexpr int C_v() const { return B() + n; }  ///< in units of the law's velocity
  constexpr int C_y() const { return C_v() + n; }
  constexpr int outside() const { return C_y() + n; }
  constexpr int atol() const { return outside() + n; }    ///< n + 1
  constexpr int state() const { return atol() + n + 1; }  ///< X, then z in the law's units
  constexpr int rate() const { return state() + n + 1; }  ///< of the state
  constexpr int count() const { return rate() + n + 1; }
};

/// Events that end a call of the kernel.
enum LaneEvent : int {
  lane_turned = 1,        ///< the rate of y changed sign within the step
  lane_crossed = 2,       ///< y rose through the level
  lane_look = 4,          ///< the time to look was reached
  lane_ended = 8,         ///< the end was reached
  lane_left = 16,         ///< |y| is beyond the ceiling
  lane_budget = 32,       ///< the step limit is reached
  lane_stalled = 64,      ///< no step is good enough, however short
  lane_not_finite = 128,  ///< the same, and the last one tried gave no numbers
};

/// As many loops as the instruction set has lanes.
struct LaneBatch {
  double* rows = nullptr;  ///< LaneRows::count() rows, aligned to 64 bytes
  int curve = 0;           ///< of the law, the same in all lanes, as is its exponent
  bool fresh = false;      ///< a lane has a new loop: its rates are not known yet
  long attempts = 0;       ///< steps tried in all lanes together
};

/// Steps until some lane has an event.
using LaneKernel = void (*)(LaneBatch& batch);

/// The kernels of one instruction set, by the number of linear states.
struct LaneKernels {
  static constexpr int fewest_states = 2, most_states = 5;
  int lanes = 1;
  /// Laws: LuGre, symmetric with the curve exp(-(v/vs)^2) and constant damping; any LuGre; Dahl with exponent 1. Law
  /// numbers of LuGre: Fs, Fc, Fs_minus, Fc_minus, sigma0 vs, sigma1 vs, sigma2 vs, vd/vs, delta, with velocities in vs
  /// and z in m/vs; of Dahl: Fc, sigma0.
  LaneKernel usual_lugre[most_states + 1] = {};
  LaneKernel lugre[most_states + 1] = {};
  LaneKernel dahl[most_states + 1] = {};
};

extern const LaneKernels scalar_lane_kernels;
extern const LaneKernels avx2_lane_kernels;
extern const LaneKernels avx512_lane_kernels;

}  // namespace limcycle
