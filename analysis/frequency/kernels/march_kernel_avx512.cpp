#include "limcycle/analysis/frequency/kernels/march_kernel_body.hpp"

namespace limcycle {

constinit const MarchKernels avx512_march_kernels = march_kernels<Pack<8, Isa::avx512>>();

}  // namespace limcycle
