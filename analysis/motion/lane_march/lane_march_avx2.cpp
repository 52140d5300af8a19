#include "limcycle/analysis/motion/lane_march/lane_march_body.hpp"

namespace limcycle {

constinit const LaneKernels avx2_lane_kernels = lane_kernels<Pack<4, Isa::avx2, Products::rounded>>();

}  // namespace limcycle
