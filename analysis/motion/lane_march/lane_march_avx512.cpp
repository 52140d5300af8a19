#include "limcycle/analysis/lanes/twin.hpp"
#include "limcycle/analysis/motion/lane_march/lane_march_body.hpp"

namespace limcycle {

constinit const LaneKernels avx512_lane_kernels = lane_kernels<Twin<Pack<8, Isa::avx512, Products::rounded>>>();

}  // namespace limcycle
