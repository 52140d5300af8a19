#include "limcycle/analysis/frequency/kernels/march_kernel_body.hpp"

namespace limcycle {

constinit const MarchKernels avx2_march_kernels = march_kernels<Pack<4, Isa::avx2>>();

}  // namespace limcycle
