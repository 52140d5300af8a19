#include "limcycle/analysis/frequency/kernels/linear_kernel_body.hpp"

namespace limcycle {

constinit const LinearKernels scalar_linear_kernels = linear_kernels<Pack<2, Isa::scalar>>();

}  // namespace limcycle
