#include "limcycle/analysis/frequency/kernels/linear_kernel_body.hpp"

namespace limcycle {

constinit const LinearKernels avx2_linear_kernels = linear_kernels<Pack<4, Isa::avx2>>();

}  // namespace limcycle
