#include "limcycle/analysis/frequency/kernels/linear_kernel_body.hpp"

namespace limcycle {

constinit const LinearKernels avx512_linear_kernels = linear_kernels<Pack<8, Isa::avx512>>();

}  // namespace limcycle
