#include "limcycle/analysis/motion/lane_march/lane_march_body.hpp"

namespace limcycle {

constinit const LaneKernels scalar_lane_kernels = lane_kernels<Pack<2, Isa::scalar, Products::rounded>>();

}  // namespace limcycle
